"""
A flapping wing
===============

The built-in case ``flapping-wing-chosen``: one crank drives two mirrored four-bars, and each rocker is an inner wing.
A published design of 0.7 m span, at three beats a second.
"""

import math

import numpy as np

import alula

moved = alula.motion(alula.read_case("flapping-wing-chosen").with_values({"motion.poses": 61}))
moved.plot_linkage()

# %%
# The stroke of the inner wing, in closed form: it turns back where crank and coupler lie in one line, stretched or
# folded. The law of cosines gives both positions of the rocker.
crank, coupler, rocker, aside, above = 15.0, 105.0, 45.0, 49.0, 102.5  # mm
ground = math.hypot(aside, above)


def at(reach: float) -> float:
    """Angle between rocker and ground line, with the rocker's end so far from the crank's pivot [degrees]."""
    return math.degrees(math.acos((rocker**2 + ground**2 - reach**2) / (2.0 * rocker * ground)))


stroke = at(coupler + crank) - at(coupler - crank)
inner = moved.link_angles["inner-right"]
print(f"stroke {np.ptp(inner):.2f} deg in the motion's poses, {stroke:.2f} deg in closed form")
assert abs(np.ptp(inner) - stroke) < 0.1  # the poses stand six degrees apart

# %%
# A parallelogram carries the outer wing, which keeps its angle to the coupler: 80 deg.
kept = moved.link_angles["coupler-right"] - moved.link_angles["outer-right"]
np.testing.assert_allclose(kept, 80.0, atol=1e-6)

# %%
# The drive torque over one turn, held still, at speed, and at speed in air. Weight and inertia take no work over a
# whole turn; air does.
turn = np.radians(moved.coordinates)
for name, torque in moved.drive_efforts.items():
    work = np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(turn))
    print(f"{name}: torque up to {np.abs(torque).max():.1f} N·mm, work of a turn {work:.4f} N·mm")
    assert work > 5.0 if name == "flapping-air" else abs(work) < 1e-3 * np.abs(torque).max()
moved.plot_drive()
