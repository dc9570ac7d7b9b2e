"""
A case composed in Python
=========================

``alula.Case`` takes links, joints, parts and load cases one by one, as a case file has them. Here a servo turns a horn,
which presses a jaw by way of a rod. The case is composed, checked, swept and plotted.
"""

import tempfile
import tomllib

import numpy as np
import pandas

import alula

horn, rod, jaw, tip = 40.0, 60.0, 50.0, 90.0  # mm
case = alula.Case("Gripper: a servo presses a jaw by way of a rod")
case = case.with_link("base", ground=True, points={"O2": np.array([0.0, 0.0]), "O4": np.array([60.0, 0.0])})
case = case.with_link("horn", part="bar", points={"O2": ("0 mm", "0 mm"), "A": (f"{horn} mm", "0 mm")})
case = case.with_link("rod", part="bar", points={"A": ("0 mm", "0 mm"), "B": (f"{rod} mm", "0 mm")})
jaw_points = {"O4": np.array([0.0, 0.0]), "B": np.array([jaw, 0.0]), "T": np.array([tip, 0.0])}
case = case.with_link("jaw", part="bar", points=jaw_points, end_patch="8 mm")
for joint, links in {"O2": ("base", "horn"), "A": ("horn", "rod"), "B": ("rod", "jaw"), "O4": ("base", "jaw")}.items():
    case = case.with_joint(joint, links=links, pin_diameter="3 mm")
case = case.with_part(
    "bar", shape="bar", material="aluminium-6061-t6", width="8 mm", thickness="4 mm", fillet_radius="2 mm"
)
case = case.with_pose(coordinate="horn", angle="80 deg", near={"rod": "5 deg", "jaw": "80 deg"})
case = case.with_drive(link="horn", joint="O2")
case = case.with_check("strength", type="safety-factor")  # does it stay elastic?
case = case.with_check("eyes", type="eye", minimum=2.4)  # does it break?

# %%
# A load case for every row of a table, which ``pandas.read_csv`` reads from a file as well.
grips = pandas.DataFrame({"name": ["soft", "firm", "slanted"], "x": [5.0, 15.0, 12.0], "y": [0.0, 0.0, -9.0]})  # N
for row in grips.itertuples():
    case = case.with_load_case(row.name, forces=[{"link": "jaw", "at": "T", "force": (f"{row.x} N", f"{row.y} N")}])
case

# %%
# The check by hand calculation, as a frame of pandas.
report = alula.check(case, fidelity="beam")
links = report.frame("links")
worst = links.groupby("link")["safety factor"].idxmin()
print(links.loc[worst, ["link", "load case", "safety factor", "safety factor low"]])
assert report.verdict == "pass"
report.plot_linkage("slanted")

# %%
# An independent check: the rod is a two-force member, so that the moments on jaw and horn give the servo's torque.
A = horn * np.exp(1j * np.radians(80.0))
reach = abs(60.0 - A)
turn = np.angle(60.0 - A) + np.arccos((rod**2 + reach**2 - jaw**2) / (2.0 * rod * reach))
B = A + rod * np.exp(1j * turn)
along, arm = np.exp(1j * turn), (B - 60.0)
T = 60.0 + arm * tip / jaw


def moment(arm: complex, force: complex) -> float:
    """Return the moment of a force about the start of its arm [N·mm]."""
    return float((np.conj(arm) * force).imag)


for row in grips.itertuples():
    pressed = -moment(T - 60.0, complex(row.x, row.y)) / moment(arm, along)
    np.testing.assert_allclose(report.drive_torques[row.name], moment(A, along) * pressed, rtol=1e-9)
print({name: f"{torque:.0f} N·mm" for name, torque in report.drive_torques.items()})

# %%
# A sweep: what thickness costs and brings. The study keeps its numbers in a folder, and draws them.
with tempfile.TemporaryDirectory() as folder:
    study = alula.study(case, {"parts.bar.thickness": "4 mm..8 mm/5"}, folder, fidelity="beam", threads=1)
    found, pictures = study.frame(), study.pictures
print(found[["parts.bar.thickness", "verdict", "margin"]])
assert found["margin"].is_monotonic_increasing
next(iter(pictures.values()))

# %%
# The file that states the case, for ``alula check gripper.toml`` and for those who do not write Python.
text = case.to_toml()
assert alula.Case.from_dict(tomllib.loads(text)) == case
print(text[: text.index("[links.horn]")])
