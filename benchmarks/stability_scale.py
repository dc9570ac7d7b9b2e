"""Rows on scale and rounding: whole checks through case files."""

import tomllib
from typing import Any

import numpy as np

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.links.solid_result import link_task
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field, von_mises
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import AlulaError
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.loads.case.case_file import validate
from alula.loads.records.bearing import WIDE
from alula.loads.statics.statics import Reactions
from benchmarks.stability_report import Row, figure, table, timed

CASE = """
schema_version = 1
title = "Arm on a strut, in any size"
large_displacement = "off"
[links.frame]
ground = true
points.O = ["0 mm", "0 mm"]
points.P = ["{p} mm", "{q} mm"]
[links.arm]
part = "arm"
end_patch = "{patch} mm"
points.O = ["0 mm", "0 mm"]
points.B = ["{p} mm", "0 mm"]
points.H = ["{tip} mm", "0 mm"]
[links.strut]
points.P = ["0 mm", "0 mm"]
points.B = ["{strut} mm", "0 mm"]
[joints]
O = {{ links = ["frame", "arm"], pin_diameter = "{pin} mm" }}
B = {{ links = ["arm", "strut"], pin_diameter = "{pin} mm" }}
P = {{ links = ["frame", "strut"], pin_diameter = "{pin} mm" }}
[pose.near]
arm = "0 deg"
strut = "100 deg"
[parts.arm]
shape = "bar"
material = "own"
width = "{width} mm"
thickness = "{thickness} mm"
eye_diameter = "{eye} mm"
eye_thickness = "{thickness} mm"
fillet_radius = "{fillet} mm"
[materials.own]
title = "A material"
density = "1e-9 tonne/mm^3"
youngs_modulus = "{young} MPa"
poissons_ratio = 0.38
yield_strength = "{strength} MPa"
strength = "yield"
sources = {{ density = "made up", youngs_modulus = "made up", poissons_ratio = "made up", yield_strength = "made up" }}
status = {{ density = "assumed", youngs_modulus = "assumed", poissons_ratio = "assumed", yield_strength = "assumed" }}
[load_cases.tip]
forces = [{{ link = "arm", at = "H", force = ["0 N", "{force} N"] }}]
[checks.strength]
type = "safety-factor"
minimum = 3.0
"""
LENGTHS = {
    "p": 15.0, "q": -10.0, "tip": 30.0, "strut": 10.2, "pin": 2.0, "width": 4.0, "thickness": 3.0, "eye": 8.0,
    "fillet": 1.0, "patch": 5.0,
}  # fmt: skip


COARSE = MeshSettings(size=1.0, bore_elements=8, turn_elements=6, fillet_size=1.5, growth=1.0)


def answers(scale: float, force: float, young: float, threads: int = 1) -> tuple[np.ndarray, Reactions, str]:
    """Peak stress, displacement, joint force and stress by hand of the arm, without dimensions; statics; solver.

    The arm is ``scale`` times 30 mm long, under a force [N], of a modulus [MPa]. The case file is checked by hand
    calculation; its solid is solved on one mesh.
    """
    sizes = {name: repr(value * scale) for name, value in LENGTHS.items()}
    text = CASE.format(**sizes, force=repr(-force), young=repr(young), strength=repr(50.0 * force / scale**2))
    case = validate(tomllib.loads(text))
    found = check_case(case, fidelity="beam").load_cases["tip"]
    statics = solve_case_statics(case)
    loads = link_loads("tip", "arm", case.body("arm"), found.forces.reactions, statics.loads["tip"])
    task = link_task(case, "arm", [loads])
    solid = solve_solid(
        mesh_body(task.body, COARSE), E=task.E, nu=task.nu, density=task.density, loads=task.loads, line=task.line,
        laws=(WIDE,), threads=threads,
    )  # fmt: skip
    own = solid.cases[0]
    peak = von_mises(stress_field(solid.space, own.displacement, E=task.E, nu=task.nu).nodal).max()
    return (
        np.array(
            [
                peak * scale**2 / force,
                own.displacement_max * young * scale / force,
                float(np.linalg.norm(found.forces.reactions.joints["B"].force)) / force,
                found.links["arm"].beam.worst.equivalent * scale**2 / force,
            ]
        ),
        found.forces.reactions,
        solid.solver,
    )


SCALES = {"1 µm": 1e-3 / 30.0, "1 mm": 1.0 / 30.0, "30 mm": 1.0, "1 m": 1e3 / 30.0, "1 km": 1e6 / 30.0}


def scale() -> Row:
    """The same arm from 1 µm to 1 km, under 1e-12 to 1e9 N, of 1 kPa to 1 TPa."""
    base, _, _ = answers(1.0, 1.0, 2900.0)
    runs: list[tuple[str, str, float, float, float]] = []
    runs += [("length", name, size, 1.0, 2900.0) for name, size in SCALES.items() if size != 1.0]
    runs += [("force", f"{force:g} N", 1.0, force, 2900.0) for force in (1e-12, 1e-6, 1e3, 1e9)]
    runs += [("modulus", name, 1.0, 1.0, young) for name, young in (("1 kPa", 1e-3), ("1 MPa", 1.0), ("1 TPa", 1e6))]
    runs += [
        ("all", "all least", SCALES["1 µm"], 1e-12, 1e-3),
        ("all", "all largest", SCALES["1 km"], 1e9, 1e6),
    ]
    rows: list[tuple[Any, ...]] = []
    for kind, name, size, force, young in runs:
        try:
            (found, _, solver), seconds = timed(lambda a=size, b=force, c=young: answers(a, b, c))
        except AlulaError as error:
            rows.append((kind, name, "refused", str(error)[:90], "", "", "", ""))
            continue
        off = np.abs(found / base - 1.0)
        rows.append((kind, name, *map(float, off), solver, seconds))
    made, (axes,) = figure(1)
    x = [row[1] for row in rows if row[2] != "refused"]
    for column, label in ((2, "peak stress"), (3, "displacement"), (4, "joint force"), (5, "hand calculation")):
        axes.semilogy(x, [max(row[column], 1e-17) for row in rows if row[2] != "refused"], "o", label=label)
    axes.axhline(1e-9, color="r", ls="--", lw=1)
    axes.set(ylabel="difference, dimensionless,\nfrom 30 mm, 1 N, 2.9 GPa", ylim=(5e-18, 1e-7))
    axes.tick_params(axis="x", rotation=60)
    axes.legend(fontsize=8)
    head = ("axis", "value", "peak stress", "displacement", "joint force", "hand calculation", "solver", "time [s]")
    return Row(table=table(head, rows), figure=made)


def rounding() -> Row:
    """The same check again, with one thread and with two."""
    first, *others = [answers(1.0, 1.0, 2900.0, threads=n)[0] for n in (1, 1, 2, 2)]
    rows = [
        (threads, "identical" if np.array_equal(first, again) else "differs", *map(float, np.abs(again / first - 1.0)))
        for threads, again in zip((1, 2, 2), others, strict=True)
    ]
    residuals = []
    for size in SCALES.values():
        for force in (1e-12, 1.0, 1e9):
            found = answers(size, force, 2900.0)[1]
            residuals.append((size * 30.0, force, found.residual, found.system.condition))
    made, (axes,) = figure(1)
    for force, marker in ((1e-12, "o"), (1.0, "x"), (1e9, "s")):
        own = [r for r in residuals if r[1] == force]
        axes.loglog([r[0] for r in own], [max(r[2], 1e-18) for r in own], marker, label=f"{force:g} N")
    axes.axhline(2.2e-16, color="k", ls=":", lw=1)
    axes.set(
        xlabel="length of the arm [mm]", ylabel="equilibrium residual / load (dotted: rounding)", ylim=(5e-19, 1e-14)
    )
    axes.legend(fontsize=8)
    text = table(
        (
            "threads",
            "to the first run with one thread",
            "peak stress",
            "displacement",
            "joint force",
            "hand calculation",
        ),
        rows,
    )
    worst = max(r[2] for r in residuals)
    said = f"Equilibrium residual of statics over all sizes and forces: at most {worst:.2g} of the load"
    return Row(table=f"{text}\n\n{said}; condition number {residuals[0][3]:.3g}.", figure=made)
