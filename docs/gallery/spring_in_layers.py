"""
A spring-loaded pedal in layers
===============================

The built-in case ``spring-pedal``: a pedal that is let go stands where foot, spring and piston balance, unless a stop
is reached before. Its links lie in layers.
"""

import numpy as np
from scipy.optimize import brentq

import alula

case = alula.read_case("spring-pedal").with_values({"load_cases.foot.own_weight": False})
report = alula.check(case, fidelity="beam")
report.plot_linkage()

# %%
# The balance again, from the energy alone: of the spring, of the foot's constant force and of that on the piston. The
# derivative of its sum by the pedal's angle vanishes.
spring, foot = np.array([-70.0, 75.0]), 40.0  # place of its eye [mm], N


def energy(angle: float) -> float:
    """Energy [N·mm] with the pedal at an angle [rad]."""
    way = np.array([np.cos(angle), np.sin(angle)])
    stretch = np.linalg.norm(80.0 * way - spring) - 45.0
    pin = 40.0 * way
    piston = pin[0] + np.sqrt(70.0**2 - (40.0 - pin[1]) ** 2)
    return 0.5 * 0.8 * stretch**2 - foot * 150.0 * way[0] + 100.0 * piston


def slope(angle: float) -> float:
    return (energy(angle + 1e-5) - energy(angle - 1e-5)) / 2e-5


balance = np.degrees(brentq(slope, np.radians(66.0), np.radians(99.0)))
pose = report.result.load_cases["foot"].standing.pose
found = np.degrees(pose.angles["pedal"])
print(f"the pedal stands at {found:.4f} deg, by its energy at {balance:.4f} deg")
assert abs(found - balance) < 1e-4

# %%
# With 40 N on the piston in place of 100 N the pedal comes to its lower stop, which bears.
weak = case.with_values({"load_cases.foot.forces.1.force": ["-40 N", "0 N"]})
stopped = alula.check(weak, fidelity="beam").result.load_cases["foot"].standing
print(f"stop {stopped.stop} bears {stopped.contact:.0f} N·mm")
assert stopped.stop == "down"

# %%
# The links in their layers, from above and from the side.
report.plot_assembly()
