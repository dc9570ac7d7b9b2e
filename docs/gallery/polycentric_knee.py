"""
A polycentric knee
==================

The built-in case ``knee``: two pairs of plates join thigh and shank. Its loads are a template to be replaced (all are
assumed); nothing here is the test of a standard.
"""

import numpy as np

import alula

report = alula.check("knee", fidelity="beam")
report.plot_linkage("heel-strike")

# %%
# With the leg straight the thigh turns about the point where the lines of both links meet. It lies high above the
# pins, so that the load line needs to run only a little ahead of it to keep the knee straight.
A, B, C, D = np.array([25.0, 0.0]), np.array([-25.0, 0.0]), np.array([-20.0, 35.0]), np.array([15.0, 45.0])
along = np.linalg.solve(np.column_stack([C - B, A - D]), A - B)
centre = B + along[0] * (C - B)
print(f"instantaneous centre at x = {centre[0]:.1f} mm, y = {centre[1]:.1f} mm")

# %%
# The load's moment about that centre, over the ratio of angular speeds, is what holds the rear plates: the stop at
# heel strike, the brake (the drive) in late stance. No joint force is needed for it.
ratio = np.linalg.norm(C - centre) / np.linalg.norm(C - B)
for name, line in (("heel-strike", 20.0), ("late-stance", -15.0)):
    held = -940.0 * (line - centre[0]) / ratio
    standing = report.result.load_cases[name].standing
    told = standing.contact if standing.stop else report.drive_torques[name]
    print(f"{name}: {'stop' if standing.stop else 'brake'} {told:.0f} N·mm, by the centre {held:.0f} N·mm")
    assert abs(told / held - 1.0) < 1e-6

# %%
# As the knee bends, the centre comes down and the brake has to hold much more: the template's lines are those of a
# straight leg, so that only the trend counts.
moved = alula.motion("knee")
brake = moved.drive_efforts["late-stance"]
assert brake[-1] > 10.0 * brake[0] > 0.0
moved.plot_linkage()
