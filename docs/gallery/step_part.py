"""
A part from a STEP file
=======================

The built-in case ``step``: a bell crank drawn in a CAD program is a link between a servo and a load.
"""
# slow: a solid with its meshes, some 20 s

import math
from importlib.resources import files

import alula

# %%
# What the file holds. Its bores become the points of the link; the entries of a case file can be pasted.
part = alula.inspect(str(files("alula.loads.cases") / "bell-crank.step"), material="aluminium-6061-t6")
print(part.table(), part.entries, sep="\n\n")
part.plot_part()

# %%
# Its volume in closed form: each arm is the hull of two circles, hub and eye; both arms share the hub and the square
# in their corner, which a fillet of 6 mm fills a little more; three bores are cut out.
hub, eye, thickness = 8.0, 5.5, 5.0  # mm, radii and thickness
area = 0.0
for length in (40.0, 30.0):
    lean = math.asin((hub - eye) / length)  # of the sides against the axis
    area += (hub + eye) * length * math.cos(lean) + hub**2 * (math.pi / 2.0 + lean) + eye**2 * (math.pi / 2.0 - lean)
bores = math.pi * (2.5**2 + 2.0**2 + 2.0**2)
without_overlap = (area - bores) * thickness
print(f"volume {part.volume:.0f} mm³; both arms without what they share {without_overlap:.0f} mm³")
shared = (without_overlap - part.volume) / thickness
assert 0.75 * math.pi * hub**2 < shared < math.pi * hub**2 + hub**2  # the hub, up to corners and fillet
assert abs(part.mass - part.volume * 2.7e-3) < 1e-9

# %%
# Checked in its linkage, as a solid. Moments about O and O4 alone give the pull of the rod and the servo's torque.
report = alula.check(alula.read_case("step", {"load_cases.pull.own_weight": False}), fidelity="solid")
assert report.verdict == "pass"
servo = 80.0 + 40.0 * complex(math.cos(math.radians(80.0)), math.sin(math.radians(80.0)))  # B
apart, way = abs(servo), math.atan2(servo.imag, servo.real)
corner = math.acos((30.0**2 + apart**2 - 85.0**2) / (2.0 * 30.0 * apart))
upper = 30.0 * complex(math.cos(way + corner), math.sin(way + corner))  # A
rod = (servo - upper) / 85.0
load = upper / 30.0 * 40.0j  # C, at a right angle to A
pull = 30.0 * load.real / (upper.conjugate() * rod).imag  # the rod's, against 30 N down at C
arm = ((servo - 80.0).conjugate() * rod).imag
print(f"rod {pull:.2f} N, servo {pull * arm:.1f} N·mm")
assert abs(report.drive_torques["pull"] / (pull * arm) - 1.0) < 1e-6

# %%
# It is stressed most at the bore of the rod's pin, far less in the corner between both arms.
report.plot_stress("bell-crank")
