"""
An ornithopter's drive
======================

The built-in case ``ornithopter``: a crank lifts a slider between two levers, the wings, by pins in slots. At 3000 rpm
inertia is all that counts.
"""

import numpy as np

import alula

moved = alula.motion("ornithopter")
moved.plot_linkage()

# %%
# The angle of the right wing in closed form. The slider's pin stands at y = r sin φ + sqrt(l² - r² cos² φ) above the
# crank's pivot; the lever turns about a pivot aside, 10 mm high, and its slot takes the pin.
crank, rod, high, wing_angle = 3.0, 10.0, 10.0, 23.0  # mm, degrees
aside = crank / np.tan(np.radians(wing_angle))
turn = np.radians(moved.coordinates)
pin = crank * np.sin(turn) + np.sqrt(rod**2 - (crank * np.cos(turn)) ** 2)
wing = np.degrees(np.arctan2(high - pin, aside))
np.testing.assert_allclose(moved.link_angles["lever-right"], wing, atol=1e-6)
print(f"the wing swings from {wing.min():.1f} to {wing.max():.1f} deg")

# %%
# Torque is that of the weight, which does not depend on speed, and that of inertia, which grows with its square.
# Three speeds show both: the differences of their torques stand to each other as those of the squares.
speeds = (150.0, 1500.0, 3000.0)
case = alula.read_case("ornithopter").with_values({"motion.poses": 73})
slow, middle, fast = (
    alula.motion(case.with_values({"load_cases.fast.speed": f"{speed} rpm"})).drive_efforts["fast"] for speed in speeds
)
growth = (speeds[2] ** 2 - speeds[1] ** 2) / (speeds[1] ** 2 - speeds[0] ** 2)
np.testing.assert_allclose(fast - middle, growth * (middle - slow), atol=1e-9 * np.abs(fast).max())
print(f"largest torque: {np.abs(slow).max():.3f} N·mm at 150 rpm, {np.abs(fast).max():.3f} N·mm at 3000 rpm")
moved.plot_drive()

# %%
# Over a turn the drive does no work without air, since no load takes any: what it gives in one half of a stroke comes
# back in the other. Air on the wings takes what it is given.
for name, values in moved.drive_efforts.items():
    halves = np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(turn))
    assert halves > 0.1 if name.endswith("-air") else abs(halves) < 1e-3 * np.abs(values).max()
