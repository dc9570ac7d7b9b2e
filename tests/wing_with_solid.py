"""A checked case that needs no mesher: the owl wing, one of its links as a solid bar, the others as beams."""

from dataclasses import replace

from edited_cases import PLANAR
from mesh_states import state
from solid_meshes import bar

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.source import PIN_PRESSURE
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict, overall
from alula.fea.outcomes.result import SectionComparison, SolidResult, VariantPeak
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.loads.case.case_file import read_case
from alula.loads.records.check_spec import DisplacementCheck, SafetyFactorCheck
from alula.loads.records.load_case import LoadCase
from alula.loads.states.actions import acting_loads

NAME = "owl-wing-static"
SOLID_LINK = "GF"


def bar_mesh():
    """Link GF as a flat bar, 50 mm between its pins."""
    mesh = bar(length=50.0, half_width=2.5, height=3.0, hole=0.75, around=8, radial=2, along=6, layers=1)

    def renamed(surfaces):
        return {name.replace(":A", ":G").replace(":B", ":F"): value for name, value in surfaces.items()}

    return replace(mesh, surfaces=renamed(mesh.surfaces), areas=renamed(mesh.areas))


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
        return Band.around(values[governing], tuple(values), PIN_PRESSURE)

    stress = fields[governing]
    return SolidResult(
        link=SOLID_LINK,
        von_mises_max=banded("von_mises"),
        principal_max=Band.exact(peaks[governing].principal, "nothing"),
        safety_factor=banded("von_mises").inverse(material.allowable),
        displacement_max=Band.exact(peaks[governing].displacement, "nothing"),
        location=stress.peak.location,
        beam=beam,
        solution=solution,
        variants=peaks,
        governing=peaks[governing],
        governing_case=solution.cases[governing],
        stress=stress,
        comparisons=(
            SectionComparison(x=15.0, kind="axial", hand=-0.051, solid=-0.0505, difference=0.0098),
            SectionComparison(x=35.0, kind="axial", hand=-0.051, solid=-0.0474, difference=0.0706),
        ),
        notes=("2 elements were straightened",),
        brittle=material.brittle,
        decided_by="solid",
        why="a solid was asked for",
        discretisation=state("far"),
    )


def checks_of(title, links):
    found = []
    for name, link in links.items():
        for check, quantity, value, limit in (
            ("strength", Quantity.SAFETY_FACTOR, link.safety_factor, 3.0),
            ("stiffness", Quantity.DISPLACEMENT, link.displacement_max, 10.0),
        ):
            subject = Subject.link(name)
            found.append(CheckOutcome.of(check, subject, title, quantity, value, limit, "as the band says"))
    return tuple(found)


def with_checks(result, change):
    """The same result with every check passed through ``change``, and the verdict that follows."""
    cases = {
        name: replace(case, checks=tuple(change(check) for check in case.checks))
        for name, case in result.load_cases.items()
    }
    verdict = overall(check.verdict for case in cases.values() for check in case.checks)
    return replace(result, load_cases=cases, verdict=verdict)


def result():
    """Two load cases: the wing's weight, and a case with no load at all (so that stresses are zero)."""
    case = read_case(NAME, [PLANAR])
    # Two checks of every link are set by hand below, whatever the built-in case asks for.
    case = case.model_copy(update={"load_cases": case.load_cases | {"idle": LoadCase(title="no load")}, "checks": {}})
    checked = check_case(case, name=NAME, fidelity="beam")
    weight = checked.load_cases["weight"]
    body, material = case.body(SOLID_LINK), case.material_of(SOLID_LINK)
    loads = acting_loads(case, case.load_cases["weight"], checked.pose.placement, {})
    cut = link_loads("weight", SOLID_LINK, body, weight.reactions, loads)
    solid = solid_result(weight.links[SOLID_LINK].beam, material, cut)
    load_cases = {}
    for title, found in checked.load_cases.items():
        # By beam theory alone, with no band: what these tests read is what the report says of given numbers.
        links = {
            name: replace(link, safety_factor=Band.exact(link.beam.safety_factor, "nothing"))
            for name, link in found.links.items()
        }
        if title == "weight":
            links[SOLID_LINK] = solid
        load_cases[title] = replace(found, links=links, checks=checks_of(title, links))
    asked = {
        "strength": SafetyFactorCheck(type="safety-factor"),
        "stiffness": DisplacementCheck(type="displacement", maximum="10 mm"),
    }
    return replace(
        checked,
        case=case.model_copy(update={"checks": asked}),
        load_cases=load_cases,
        verdict=Verdict.PASS,
        timings={"pose and statics": 0.01, "solid models": 1.5},
        warnings=("the pose is close to a dead point",),
    )
