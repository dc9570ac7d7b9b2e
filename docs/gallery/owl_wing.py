"""
The owl's wing
==============

A prosthesis for a barn owl's wing: six bars of PVC tube, held in its shoulder, with 0.25 N at its tip. The built-in
case ``owl-wing-static`` states it as its source does. Stress is not what it fails by.
"""

import numpy as np

import alula

report = alula.check("owl-wing-static", fidelity="beam")
report

# %%
# The linkage in its pose, with the forces of its joints. The drive holds link AE at A.
report.plot_linkage()

# %%
# It fails, although no link is stressed up to its limit in the undeformed pose: it gives way at a fifth of its load,
# since the wing sags towards a dead point.
assert report.verdict == "fail"
assert all(factor.value > 2.9 for factor in report.safety_factors.values())
print(report.headline)

# %%
# The drive torque again, without any joint force: by virtual work. While AE turns by a small angle, the tip H,
# reached by A-E-D-H, rises by dy. The load and the torque do no work in sum.
moved = alula.motion("owl-wing-static")
AE, ED, CH = (np.radians(moved.link_angles[link]) for link in ("AE", "ED", "CH"))
tip = 190.0 * np.sin(AE) + 88.0 * np.sin(ED) + (124.0 - 77.0) * np.sin(CH)  # height above A [mm]
by_work = 0.25 * np.gradient(tip, AE, edge_order=2)  # N·mm
torque = moved.drive_efforts["weight"]
print(f"drive torque {torque[0]:.2f} N·mm, by virtual work {by_work[0]:.2f} N·mm")
away = moved.coordinates < 195.0  # the dead point lies at 213.5 deg, between the stated pose and these
np.testing.assert_allclose(by_work[away][:-1], torque[away][:-1], rtol=2e-3)
assert abs(by_work[0] / report.drive_torques["weight"] - 1.0) < 2e-3

# %%
# Over the motion: torque of the drive, which grows without limit where the linkage comes to a dead point.
moved.plot_drive()
