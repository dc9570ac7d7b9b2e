"""
A prosthetic finger on its tendon
=================================

The built-in case ``finger``: phalanges, tendon and return spring of the Aero Hand Open (TetherIA), whose makers state
some 12 N at each fingertip. The other sizes are assumed. A gauge holds the tip by a cord, and tells the grip.
"""

import numpy as np

import alula

moved = alula.motion("finger")
moved.plot_linkage()

# %%
# The crossed coupler makes both joints bend alike, by the same angle at 30 deg.
middle, distal = (np.radians(moved.link_angles[link]) for link in ("middle", "distal"))
print(f"at {np.degrees(middle[-1]):.0f} deg the distal phalanx stands at {np.degrees(distal[-1]):.0f} deg")

# %%
# By virtual work: the tendon's pull times its arm, about both joints together, balances the return spring and what the
# gauge holds. Only the places of both points on the distal phalanx are needed.
D = 22.0 * np.exp(1j * middle)
H, T = (D + place * np.exp(1j * distal) for place in (3.0 - 8.6j, 23.0 - 3.0j))
path, cord = abs(H - (-9.7 - 1.04j)), abs(T - (80.0 - 2.4j))
arm = np.gradient(path, middle, edge_order=2)  # of the tendon: what it shortens by, for one radian
print(f"arm of the tendon: {arm[0]:.1f} mm with the finger straight, {arm[-1]:.1f} mm at 30 deg")
assert abs(arm[-1] / (7.32 + 9.00) - 1.0) < 0.05  # the makers' arms, of a cord about its pulleys
gauge = 10.0 * np.maximum(cord - 58.8, 0.0) * np.gradient(cord, middle, edge_order=2)
spring = 36.0 * (np.radians(-25.0) - middle) + 182.0
torque = moved.drive_efforts["grip"]  # what would have to hold the finger at every angle
np.testing.assert_allclose((61.6 * arm + gauge - spring)[1:-1], torque[1:-1], rtol=0.02)
moved.plot_drive()

# %%
# Let go, the finger bends until all is in balance. The grip is then the force of the gauge's cord.
report = alula.check("finger", fidelity="beam")
grip = next(spring for spring in report.result.load_cases["grip"].standing.springs if spring.name == "gauge").effort
print(f"grip: {grip:.2f} N")
assert abs(grip - 12.0) < 0.05
report.plot_assembly()
