"""
A pylon under an oblique load line
==================================

The built-in case ``pylon``: a tube with a pyramid adapter from a STEP file, clamped in a foot. Its load, 1,000 N along
a line from above the knee to the ball of the foot, is a template to be replaced (all is assumed); nothing here is the
test of a standard. The line enters the pyramid over a rigid lever: sockets and soft parts are not modelled.
"""

import math

import numpy as np

import alula

report = alula.check("pylon", fidelity="beam")
report.plot_linkage("stance")

# %%
# The drawing has the line dashed, and the lever over which it enters. At the clamp the force along the line is a normal
# force, two shear forces and its moments about the clamp: two that bend, and a torsion, since the line passes beside
# the pylon. No model of the pylon is needed for them.
start, end = np.array([0.0, 400.0, 20.0]), np.array([50.0, -80.0, -20.0])  # mm, of points on the line
force = 1000.0 * (end - start) / np.linalg.norm(end - start)
bend, twist, turn = np.cross(start, force)
print(f"N = {force[1]:.0f} N, bendings {bend / 1e3:.1f} and {turn / 1e3:.1f} N·m, torsion {twist / 1e3:.1f} N·m")
wrench = report.result.load_cases["stance"].reactions.joints["O"].wrench
np.testing.assert_allclose(wrench[3:], (-bend, -twist, -turn), rtol=1e-9)

# %%
# The stress of a tube of 30 by 25 mm under them, against hand calculation at its mouth.
second = math.pi / 4.0 * (15.0**4 - 12.5**4)
along = abs(force[1]) / (math.pi * (15.0**2 - 12.5**2)) + math.hypot(bend, turn) * 15.0 / second
stress = math.hypot(along, math.sqrt(3.0) * twist * 15.0 / (2.0 * second))
told = report.result.load_cases["stance"].links["pylon"].von_mises_max.value
print(f"equivalent stress {stress:.1f} MPa, told {told:.1f} MPa")
assert abs(told / stress - 1.0) < 0.005
report.plot_internal_forces("pylon")
