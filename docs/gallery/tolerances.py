"""
A toleranced linkage
====================

How likely is it that all checks pass, if pins are a little off, and the load is not quite what it should be?
"""
# slow: solids of three links, some 30 s

import numpy as np

import alula

case = alula.read_case("four-bar", {"load_cases.lift.own_weight": False})
load = "load_cases.lift.forces.0"
found = alula.tolerance(case, {"pins": "0.2 mm", load: "10 %"}, samples=20_000, accuracy="10 %")
found

# %%
# The probability comes with its confidence, since samples are finite.
passes = found.passes
print(f"all checks pass with {passes.value:.2%} ({passes.low:.2%} to {passes.high:.2%})")
assert passes.low <= passes.value <= passes.high
assert passes.low < 1.0

# %%
# With the load alone, the drive torque is in proportion to it: uniform between 0.9 and 1.1 times its nominal value,
# so that 98 % of the samples lie within 0.98 times that width. This is exact but for the finite number of samples.
alone = alula.tolerance(case, {load: "10 %"}, samples=20_000, accuracy="10 %")
[name] = [name for name in alone.numbers if "torque" in name]
torque = alone.numbers[name]
low, high = torque.percentiles(1.0, 99.0) / torque.nominal[0]
print(f"torque from {low:.4f} to {high:.4f} times its nominal value, 0.9020 to 1.0980 expected")
np.testing.assert_allclose(sorted((low, high)), (0.902, 1.098), atol=2e-3)

# %%
# How the torque spreads with both: places of pins add to what the load does.
assert found.numbers[name].values.std() > torque.values.std()
found.plot_spread(name)
