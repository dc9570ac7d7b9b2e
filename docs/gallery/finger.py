"""
A prosthetic finger
===================

The built-in case ``finger``: a crossed four-bar couples both phalanges, so that one motor curls them.
"""

import numpy as np

import alula

moved = alula.motion("finger")
moved.plot_linkage()

# %%
# The distal phalanx turns more than the proximal one, by the coupler from the back of the palm to its front.
proximal, distal = (np.radians(moved.link_angles[link]) for link in ("proximal", "distal"))
print(f"at {np.degrees(proximal[15]):.0f} deg the distal phalanx stands at {np.degrees(distal[15]):.0f} deg")

# %%
# The motor's torque by virtual work: the grip, 10 N square to the distal phalanx at T, does the work that the motor
# takes. Only the places of P and T are needed.
P = 45.0 * np.exp(1j * proximal)
T = P + (42.0 - 2.0j) * np.exp(1j * distal)
grip = 10.0j * np.exp(1j * distal)
speed = np.gradient(T, proximal, edge_order=2)  # of T, for one radian a second
by_work = -(grip.real * speed.real + grip.imag * speed.imag)
torque = moved.drive_efforts["grip"]
np.testing.assert_allclose(by_work[1:-1], torque[1:-1], rtol=2e-3)
print(f"torque from {torque.max():.0f} to {torque.min():.0f} N·mm")
moved.plot_drive()

# %%
# The links lie in layers, so that joint forces bend them out of the plane as well. The coupler is pulled, and cannot
# buckle.
report = alula.check("finger", fidelity="beam")
assert not any(check["quantity"] == "buckling factor" and check["link"] == "coupler" for check in report.table())
report.plot_assembly()
