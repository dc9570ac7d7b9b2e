"""A checked case that needs no mesher: the owl wing, one of its links as a solid bar, the others as beams."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest
from solid_meshes import bar

from fea.band import Band
from fea.beam import check_beam, uniform_cantilever
from fea.cut_free import beam_loads, link_loads
from fea.result import CheckResult, LinkResult, LoadCaseResult, SectionComparison, VariantPeak
from fea.solid import solve_solid
from fea.stress import stress_field
from fea.verdict import CheckOutcome, at_least, at_most, overall
from loads.actions import actions
from loads.case import LoadCase
from loads.case_file import read_case, read_companion, validate
from loads.published import audit
from loads.statics import solve_statics

NAME = "owl-wing-static"
SOLID_LINK = "GF"


def bar_mesh():
    """Link GF as a flat bar, 50 mm between its pins."""
    mesh = bar(length=50.0, half_width=2.5, height=3.0, hole=0.75, around=8, radial=2, along=6, layers=1)

    def renamed(surfaces):
        return {name.replace(":A", ":G").replace(":B", ":F"): value for name, value in surfaces.items()}

    return replace(mesh, surfaces=renamed(mesh.surfaces), areas=renamed(mesh.areas))


def beam_result(link, beam, displacement=0.0):
    stress = Band.exact(beam.worst.equivalent, "beam theory without stress concentration")
    return LinkResult(
        link=link,
        fidelity="beam",
        von_mises_max=stress,
        principal_max=stress,
        safety_factor=stress.inverse(beam.strength),
        displacement_max=Band.exact(displacement, "beam theory without stress concentration"),
        location=np.array([beam.worst_x, 0.0, 0.0]),
        elements=None,
        unknowns=None,
        beam=beam,
        solid=None,
        variants=(),
        governing=None,
        solid_case=None,
        stress=None,
        comparisons=(),
        notes=("beam theory alone: stress concentration at eyes and holes is not in these numbers",),
    )


def solid_result(beam, material, loads):
    solution = solve_solid(
        bar_mesh(),
        E=material.youngs_modulus,
        nu=material.poissons_ratio,
        density=material.density,
        loads=[loads],
        line=("bore:G", "bore:F"),
    )
    fields = [stress_field(solution.space, c.displacement, E=solution.E, nu=solution.nu) for c in solution.cases]
    peaks = tuple(
        VariantPeak(
            span=c.span,
            transfer=c.transfer,
            von_mises=f.peak.value,
            principal=float(f.principal.max()),
            displacement=c.displacement_max,
        )
        for c, f in zip(solution.cases, fields, strict=True)
    )
    governing = max(range(len(peaks)), key=lambda i: peaks[i].von_mises)

    def banded(quantity):
        values = [getattr(p, quantity) for p in peaks]
        return Band.around(values[governing], tuple(values), "pin pressure over 180° and over 90°")

    stress = fields[governing]
    return LinkResult(
        link=SOLID_LINK,
        fidelity="solid",
        von_mises_max=banded("von_mises"),
        principal_max=Band.exact(peaks[governing].principal, "nothing"),
        safety_factor=banded("von_mises").inverse(material.allowable),
        displacement_max=Band.exact(peaks[governing].displacement, "nothing"),
        location=stress.peak.location,
        elements=len(solution.space.cells),
        unknowns=solution.space.unknowns,
        beam=beam,
        solid=solution,
        variants=peaks,
        governing=peaks[governing],
        solid_case=solution.cases[governing],
        stress=stress,
        comparisons=(
            SectionComparison(x=15.0, kind="axial", hand=-0.051, solid=-0.0505, difference=0.0098),
            SectionComparison(x=35.0, kind="axial", hand=-0.051, solid=-0.0474, difference=0.0706),
        ),
        notes=("2 elements were straightened",),
    )


def checks_of(title, links):
    found = []
    for name, link in links.items():
        for check, quantity, unit, value, limit, decide in (
            ("strength", "safety factor", "", link.safety_factor, 3.0, at_least),
            ("stiffness", "displacement", "mm", link.displacement_max, 2.0, at_most),
        ):
            found.append(
                CheckOutcome(
                    name=check,
                    link=name,
                    load_case=title,
                    quantity=quantity,
                    unit=unit,
                    value=value,
                    limit=limit,
                    verdict=decide(value, limit),
                    reason="as the band says",
                )
            )
    return tuple(found)


def with_checks(result, change):
    """The same result with every check passed through ``change``, and the verdict that follows."""
    cases = {
        name: replace(case, checks=tuple(change(check) for check in case.checks))
        for name, case in result.load_cases.items()
    }
    verdict = overall(check.verdict for case in cases.values() for check in case.checks)
    return replace(result, load_cases=cases, verdict=verdict)


@pytest.fixture(scope="session")
def result():
    """Two load cases: the wing's weight, and a case with no load at all (so that stresses are zero)."""
    case = read_case(NAME)
    pose = case.solve_pose()
    loads = actions(case, case.load_cases["weight"], pose, {})
    load_cases = {}
    for title, acting in (("weight", loads), ("idle", ())):
        reactions = solve_statics(pose, case.pinned_drive, acting)
        links = {}
        for link in case.checked_links:
            body, material = case.body(link), case.material_of(link)
            cut = link_loads(title, link, body, reactions, acting)
            beam = check_beam(beam_loads(cut, body, material.density, None), body.part.section, material.allowable)
            solid = link == SOLID_LINK and title == "weight"
            links[link] = solid_result(beam, material, cut) if solid else beam_result(link, beam)
        load_cases[title] = LoadCaseResult(name=title, reactions=reactions, links=links, checks=checks_of(title, links))
    tube, material = case.parts["tube"], case.all_materials["pvc-paredes-2018"]
    published = case.published_statics
    return CheckResult(
        name=NAME,
        case=case.model_copy(update={"load_cases": case.load_cases | {"idle": LoadCase(title="no load")}}),
        pose=pose,
        load_cases=load_cases,
        hand={"whole-wing": uniform_cantilever(0.25, 270.0, tube.section, material.allowable)},
        audit=audit(
            published, read_companion(NAME, published.exact), read_companion(NAME, published.printed), pose, loads
        ),
        verdict=overall(check.verdict for found in load_cases.values() for check in found.checks),
        timings={"pose and statics": 0.01, "solid models": 1.5},
        warnings=("the pose is close to a dead point",),
    )


SLIDER = """
schema_version = 1
title = "Slider-crank under a piston force"
[links]
frame = { ground = true, points = { O = ["0 mm", "0 mm"], S = ["0 mm", "0 mm"] } }
crank = { points = { O = ["0 mm", "0 mm"], P = ["30 mm", "0 mm"] } }
rod = { points = { P = ["0 mm", "0 mm"], Q = ["80 mm", "0 mm"] } }
piston = { points = { Q = ["0 mm", "0 mm"], S = ["10 mm", "0 mm"] } }
[joints]
O = { links = ["frame", "crank"] }
P = { links = ["crank", "rod"] }
Q = { links = ["rod", "piston"] }
S = { links = ["frame", "piston"], type = "slider" }
[pose]
coordinate = "crank"
angle = "60 deg"
near = { rod = "-20 deg", piston = "0 deg" }
[drive]
link = "crank"
joint = "O"
[load_cases.push]
forces = [{ link = "piston", at = "Q", force = ["-20 N", "5 N"] }]
"""


@pytest.fixture
def slider():
    """A slider-crank, its pose and its reactions."""
    case = validate(tomllib.loads(SLIDER))
    pose = case.solve_pose()
    return case, pose, solve_statics(pose, case.pinned_drive, actions(case, case.load_cases["push"], pose, {}))


@pytest.fixture
def changed(result):
    """Builds the same result with every check passed through a function."""
    return lambda change: with_checks(result, change)
