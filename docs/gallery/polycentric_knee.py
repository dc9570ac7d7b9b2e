"""
A polycentric knee
==================

The built-in case ``knee``: two pairs of plates join thigh and shank, as long as US patent 5,746,774 states them
(Kramer, Srinivasan and Swanson, 1998, claim 6). Its loads are a template to be replaced (all are assumed); nothing here
is the test of a standard. Sockets and soft parts are not modelled: the load enters the thigh over a rigid lever.
"""

import cmath
import math

import alula

report = alula.check("knee", fidelity="beam")
report.plot_linkage("heel-strike")

# %%
# With the leg straight the thigh turns about the point where the lines of both links meet, above and behind the knee.
# The patent takes its height from the angles of both against the shin; the motion has it from velocities.
motion = alula.motion("knee")
centre = motion.instant_centre.path
shin, rear, front = 63.5, 97.852455, 123.726657  # mm, deg: both angles as alula statics knee tells them
steep, flat = math.tan(math.radians(rear)), math.tan(math.radians(front))
height = shin * steep * flat / (flat - steep)
print(f"instant centre at x = {centre[0].real:.1f} mm, y = {centre[0].imag:.1f} mm; by the angles y = {height:.1f} mm")
assert abs(centre[0].imag / height - 1.0) < 1e-6

# %%
# Its path as the knee bends by 90 degrees. At heel strike the load line runs ahead of it, so that the stop bears; in
# late stance behind it, so that the knee would bend without the brake.
motion.plot_instant_centre()

# %%
# The load's moment about the centre, over the ratio of angular speeds, is what holds thigh against rear plates: the
# stop at heel strike, the brake (the drive) in late stance. No joint force is needed for it.
upper = -31.75 + 90.805 * cmath.exp(1j * math.radians(rear))
turns = 1.0 - ((upper - centre[0]) / (upper + 31.75)).real  # thigh against rear plates, for one turn of the thigh
for name, line in motion.instant_centre.lines.items():
    held = 940.0 * line.ahead[0] / turns
    standing = report.result.load_cases[name].standing
    told = standing.contact if standing.stop else report.drive_torques[name]
    print(f"{name}: line {line.ahead[0]:.1f} mm ahead, {told:.0f} N·mm, by the centre {held:.0f} N·mm")
    assert abs(told / held - 1.0) < 1e-5

# %%
# As the knee bends, the centre moves forward past both lines, which stay where a straight leg has them: only the trend
# counts.
late = motion.instant_centre.lines["late-stance"].ahead
print(f"late stance: {late[0]:.1f} mm ahead, {late[-1]:.1f} mm with the knee bent by 90 deg")
assert late.min() < 5.0 * late[0] < 0.0
motion.plot_drive()
