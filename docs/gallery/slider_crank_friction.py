"""
Friction in a slider-crank
==========================

The built-in case ``slider-crank``: pins and guide rub, so that the drive needs more torque in one direction than it
gets back in the other.
"""
# slow: the rod's solid under both directions, some 10 s

import numpy as np

import alula

case = alula.read_case("slider-crank").with_values({"motion.poses": 37})
moved = alula.motion(case)
moved.plot_drive()

# %%
# Without friction the torque is the slope of the slider's place over the crank's angle, times the force on the
# slider. It lies between the torques of both directions.
crank, rod, force = 40.0, 140.0, 40.0  # mm, mm, N
turn = np.radians(moved.coordinates)
sine, cosine = np.sin(turn), np.cos(turn)
slope = -crank * sine - crank**2 * sine * cosine / np.sqrt(rod**2 - (crank * sine) ** 2)
smooth = force * slope  # drive torque [N·mm]
forward, backward = moved.drive_efforts["push forward"], moved.drive_efforts["push backward"]
assert (backward < smooth).all()
assert (smooth < forward).all()
rubless = {f"joints.{joint}.friction": 0.0 for joint in ("O2", "A", "B", "guide")}
plain = alula.motion(case.with_values(rubless))
np.testing.assert_allclose(plain.drive_efforts["push"], smooth, rtol=1e-9, atol=1e-9)

# %%
# Both directions make a loop of torque over angle, whose area is the energy that a turn to and fro rubs away. A
# constant force gives back over a whole turn what it took, so that each direction pays for its friction alone.
work = np.sum(0.5 * (forward[1:] + forward[:-1]) * np.diff(turn))
back = -np.sum(0.5 * (backward[1:] + backward[:-1]) * np.diff(turn))
print(f"rubbed in a turn: {work:.1f} N·mm forward, {back:.1f} N·mm backward")
assert work > 0.0
assert abs(work / back - 1.0) < 1e-6  # the linkage is symmetric about its axis

# %%
# A check has both directions as load cases of their own; the worse one decides. In the stated pose the 40 N drive the
# crank. Hand calculation tells that all links stay elastic; how much more the rod bears takes its solid.
report = alula.check(case)
assert report.verdict == "pass"
assert abs(report.drive_torques["push backward"]) > abs(report.drive_torques["push forward"])
report.plot_linkage("push backward")
