"""
A printed part and its direction
================================

A part that is printed in layers parts between them first. In which direction should a rocker be built?
"""
# slow: a solid for each of two directions, some 30 s

import numpy as np

import alula

flat, upright = (
    alula.check(
        alula.read_case("four-bar", {"parts.bar.build_direction": way, "load_cases.lift.own_weight": False}),
        fidelity="solid",
        accuracy="10 %",
    )
    for way in ([0, 0, 1], [1, 0, 0])
)
flat.table("links")

# %%
# Built flat, the layers lie in the plane of the linkage, as all its loads. They bear little, and the strength in
# their plane decides. Built upright, with layers across the link, the same bending pulls them apart. Both have one
# strength across the layers, 12 to 45 MPa, which is most of either band: at the same strength the values compare.
rocker = {
    way: report.result.load_cases["lift"].links["rocker"] for way, report in (("flat", flat), ("upright", upright))
}
layers = {way: found.layers.safety_factor for way, found in rocker.items()}
print({way: f"{factor.value:.1f} ({factor.low:.1f} to {factor.high:.1f})" for way, factor in layers.items()})
assert layers["upright"].value < layers["flat"].value / 2.0
assert layers["upright"].low < layers["flat"].low / 2.0

# %%
# An independent bound: no plane bears more normal stress than the largest principal stress. The part holds its layers
# at least up to the strength across them over that stress as long as tension decides, and upright it comes near to
# it.
strength = 12.0  # MPa, across the layers of printed PLA
stress = rocker["upright"].decisive
print(f"largest principal stress {stress.value:.2f} MPa: bound {strength / stress.value:.2f}")
assert layers["upright"].high > 0.9 * strength / stress.high

# %%
# The safety factor of the layers for every direction in which the rocker may be built. The pins are in the middle of
# the map.
upright.plot_build_directions("rocker")

# %%
# Stress in the rocker, which is the same in both: the model is isotropic, and only the strength is not.
first, second = (rocker[way].decisive for way in ("flat", "upright"))
assert np.isclose(first.value, second.value, rtol=0.05)
flat.plot_stress("rocker")
