"""
From three positions to stress
==============================

Three-point synthesis gives a four-bar whose coupler and rocker stand where they are wanted; a case made of its
lengths tells what it bears.
"""

import math

import numpy as np

import alula

# %%
# Wanted: coupler and rocker at these three pairs of directions, over a ground link of 100 mm.
wanted = [("26 deg", "60 deg"), ("19 deg", "71 deg"), ("20 deg", "92 deg")]
found = alula.synthesise(wanted, "100 mm")
print(found, *found.findings, sep="\n")
found.plot_linkage()

# %%
# The lengths go into the built-in four-bar; the crank starts at the first position.
lengths = {name: f"{length:.6f} mm" for name, length in found.lengths.items()}
phi = [row["phi, of a [deg]"] for row in found.table()]
case = alula.read_case("four-bar").with_values(
    {
        "links.crank.points.A.0": lengths["a"],
        "links.coupler.points.B.0": lengths["b"],
        "links.rocker.points.B.0": lengths["c"],
        "links.rocker.points.P.0": f"{found.lengths['c'] + 40.0:.6f} mm",
        "pose.angle": f"{phi[0]:.9f} deg",
        "pose.near": {"coupler": wanted[0][0], "rocker": wanted[0][1]},
        "motion.turn": False,
        "motion.range": [f"{angle:.9f} deg" for angle in (phi[0], phi[2])],
    }
)

# %%
# An independent check: Freudenstein's equation, K1 cos ψ - K2 cos θ + K3 = cos(θ - ψ), with K of these lengths holds
# at every pose of the motion, and the motion passes all three pairs.
a, b, c, d = (found.lengths[name] for name in "abcd")
moved = alula.motion(case)
theta, psi = (np.radians(moved.link_angles[link]) for link in ("coupler", "rocker"))
K1, K2, K3 = d / b, d / c, (b**2 + c**2 + d**2 - a**2) / (2.0 * b * c)
np.testing.assert_allclose(K1 * np.cos(psi) - K2 * np.cos(theta) + K3, np.cos(theta - psi), atol=1e-7)
for pair, angle in zip(wanted, phi, strict=True):
    pose = int(np.argmin(np.abs(moved.coordinates - angle)))
    for link, direction in zip(("coupler", "rocker"), pair, strict=True):
        assert abs(moved.link_angles[link][pose] - float(direction.split()[0])) < 0.5
moved.plot_linkage()

# %%
# Its stress, by hand calculation, under 5 N at the rocker's end in the first position.
report = alula.check(case, fidelity="beam")
assert all(math.isfinite(factor.value) for factor in report.safety_factors.values())
report
