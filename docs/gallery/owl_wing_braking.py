"""
The owl's wing in braking
=========================

The built-in case ``owl-wing-braking``: the same wing at 22 m/s with its drag, which bends all links out of the plane
of the linkage. Its three load cases are what the source published, and what it leaves out: the lift.
"""
# slow: three load cases in layers, some 15 s

import alula

case = alula.read_case("owl-wing-braking")
report = alula.check(case, fidelity="beam")
report

# %%
# The lift that the source leaves out, 4.51 N in its table of coefficients, is 4.7 times its drag, and stresses the
# wing most.
assert report.verdict == "fail"
print(report.headline)
report.table("links")

# %%
# Weight hangs in the plane of the linkage, and drag acts across it. The drive therefore bears what it bears at rest,
# with or without the drag: its torque under the published load is that of the static case.
static = alula.check("owl-wing-static", fidelity="beam")
torque = report.drive_torques["as-published"]
assert abs(torque - static.drive_torques["weight"]) < 1e-6 * abs(torque)

# %%
# The published drag by the formula of every textbook, F = c ρ v²/2 A. Its coefficient is far below the 1.2 or so
# of a flat plate across the stream (Hoerner, Fluid-Dynamic Drag, 1965).
speed, density, area = 22.0, 1.225, 0.0512  # m/s, kg/m³, m²
pressure = density * speed**2 / 2.0
print(f"dynamic pressure {pressure:.1f} Pa, coefficient of drag {0.95 / (pressure * area):.3f}")
[air] = case.load_cases["as-published"].air
assert abs(air.drag - 0.95) < 1e-12
assert 0.06 < air.drag / (pressure * area) < 0.07

# %%
# Joint forces under the load case with lift: they no longer lie in the plane of the picture alone.
report.plot_linkage("complete")
