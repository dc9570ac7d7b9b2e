"""Fork ends: volume and cheeks of the solid, the pin in double shear, and what does not fit; by closed forms."""

import math

import numpy as np
import pytest
from imported_case import imported_case

from alula.fea.beam.details import details
from alula.fea.check.run import check_case
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.outcomes.pins import fork_pin_stress, pin_stress, stress_of
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.features import Ring
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.bearing import NARROW
from alula.loads.states.clearance import clearance
from alula.loads.states.masses import part_mass

GAP, CHEEK, WIDTH, DEPTH, PIN = 3.0, 2.5, 10.0, 20.0, 4.0
CUBE = {"material": "aluminium-6061-t6", "fillet_radius": "1 mm"}
BAR = CUBE | {"shape": "bar", "width": f"{WIDTH} mm", "thickness": f"{GAP + 2 * CHEEK} mm"}
THIN = CUBE | {"shape": "bar", "width": "8 mm", "thickness": "2 mm"}


def mm(x, y=0.0):
    return [f"{x} mm", f"{y} mm"]


def entries(*, part=BAR, other=THIN, joint=(), **fork):
    """A bar of 60 mm on the ground with a fork at B, in which a thin one hangs, pulled by 100 N."""
    eye = {"fork": f"{GAP} mm"} | fork
    return {
        "schema_version": 1,
        "title": "a clevis",
        "links": {
            "base": {"ground": True, "points": {"A": mm(0), "far": mm(1)}},
            "arm": {
                "part": "arm",
                "points": {"A": mm(0), "B": mm(60)},
                "eyes": {"B": {key: size for key, size in eye.items() if size is not None}},
            },
            "tip": ({"part": "tip"} if other else {}) | {"points": {"B": mm(0), "P": mm(40)}},
        },
        "joints": {
            "A": {"links": ["base", "arm"], "pin_diameter": f"{PIN} mm"},
            "B": {"links": ["arm", "tip"], "pin_diameter": f"{PIN} mm", "bonded": True, "angle": "0 deg"} | dict(joint),
        },
        "pose": {"coordinate": "arm", "angle": "0 deg"},
        "drive": {"link": "arm", "joint": "A"},
        "parts": {"arm": part} | ({"tip": other} if other else {}),
        "load_cases": {"pull": {"forces": [{"link": "tip", "at": "P", "force": ["100 N", "0 N"]}]}},
        "large_displacement": "off",
        "checks": {"pins": {"type": "pins", "minimum": 1.0}},
    }


def clevis(**changes):
    return validate(entries(**changes))


def wall(*gap, height=GAP + 2 * CHEEK):
    return Ring(diameter=0.0, low=-height / 2.0, high=height / 2.0, gaps=(gap,) if gap else ())


FORK = wall(-GAP / 2.0, GAP / 2.0)


def test_the_gap_is_a_cylinder_about_the_pin():
    """Volume of the bar less that of the cylinder's part within it, by the area of circle and bar on a fine grid."""
    case = clevis(part=BAR | {"eye_diameter": f"{WIDTH} mm"}, fork_depth="12 mm")
    step = 0.005
    x, y = np.meshgrid(*(np.arange(low + step / 2, high, step) for low, high in ((45.0, 66.0), (-5.0, 5.0))))
    away = np.hypot(x - 60.0, y)
    cut = float((((x <= 60.0) | (away <= WIDTH / 2.0)) & (away > PIN / 2.0) & (away <= 12.0)).sum()) * step**2
    whole = WIDTH * 60.0 + math.pi * WIDTH**2 / 4.0 - 2.0 * math.pi * PIN**2 / 4.0
    volume = part_mass(case, "arm").mass / case.material_of("arm").density
    assert volume == pytest.approx(whole * (GAP + 2 * CHEEK) - GAP * cut, rel=1e-4)


def test_cheeks_share_the_force_and_a_couple_by_a_linear_pressure():
    """Mean stress in each cheek: half of the force, and of a couple M what a pressure linear along the walls gives it.

    That is M S/I with S the first and I the second moment of the walls' length: for thin cheeks M over their distance.
    """
    case = clevis(part=BAR | {"eye_diameter": f"{WIDTH} mm"}, fork_depth=f"{DEPTH} mm")
    body, force, couple = case.body("arm"), 100.0, 90.0
    mesh = mesh_body(body, MeshSettings(size=2.5))

    def pins(*at_b):
        wrench = np.array(at_b)
        return tuple(
            PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=PIN, wrench=sign * wrench)
            for name, x, sign in (("A", 0.0, -1.0), ("B", 60.0, 1.0))
        )

    loads = [
        LinkLoads(name="even", pins=pins(force, 0.0, 0.0, 0.0, 0.0, 0.0)),
        LinkLoads(name="aside", pins=pins(force, 0.0, 0.0, 0.0, couple, 0.0)),
    ]
    solved = solve_solid(
        mesh, E=69e3, nu=0.33, density=2.7e-9, loads=loads, line=("bore:A", "bore:B"), laws=(NARROW,), threads=1
    )
    assert max(one.reaction for one in solved.cases) < 1e-6
    found = {}
    for one in solved.cases:
        field = stress_field(solved.space, one.displacement, E=69e3, nu=0.33)
        x, z = field.points[..., 0], field.points[..., 2]
        for side in (1.0, -1.0):
            cheek = (x > 60.0 - DEPTH + 2.0) & (x < 60.0 - WIDTH / 2.0 - 1.0) & (side * z > 0.0)
            found[one.load, side] = float(np.average(field.at_points[cheek][:, 0], weights=field.weights[cheek]))
    area, middle = WIDTH * CHEEK, (GAP + CHEEK) / 2.0
    assert [found["even", side] for side in (1.0, -1.0)] == pytest.approx([force / 2.0 / area] * 2, rel=0.01)
    second = 2.0 * (CHEEK**3 / 12.0 + CHEEK * middle**2)
    share = couple * CHEEK * middle / second
    assert couple / (2.0 * middle) * 0.9 < share < couple / (2.0 * middle)  # the lever law, for cheeks of no thickness
    for side in (1.0, -1.0):
        assert found["aside", side] == pytest.approx((force / 2.0 + side * share) / area, rel=0.02)


def test_the_eye_in_the_gap_stays_clear_of_its_root():
    """In one layer the two links pass through each other, but for the gap, whose root is 2 mm from the eye."""
    layered = entries()
    layered["joints"]["A"] |= {"bonded": True, "angle": "0 deg"}
    del layered["joints"]["B"]["bonded"], layered["joints"]["B"]["angle"]
    layered |= {"layer_spacing": "10 mm", "pose": {"coordinate": "tip"}, "drive": {"link": "tip", "joint": "B"}}
    for link, layer in {"base": 0, "arm": 1, "tip": 1}.items():
        layered["links"][link]["layer"] = layer
    [gap] = [one for one in clearance(validate(layered)).gaps if set(one.names) == {"link arm", "link tip"}]
    assert gap.value == pytest.approx(1.05 * 8.0 - 6.4, abs=0.01)
    assert gap.low <= 1.05 * 8.0 - 6.4
    layered["pose"]["angle"] = "150 deg"
    with pytest.raises(CaseError, match="arm"):
        clearance(validate(layered))


def test_the_first_mesh_is_fine_where_the_gap_has_its_root():
    body = clevis(fork_radius="0.8 mm").body("arm")
    assert not body.may_be_sharp
    assert clevis().body("arm").may_be_sharp
    fork = body.pin("B").fork
    assert fork.depth == pytest.approx(1.05 * 8.0 + 0.8)  # of its own eye, the larger one, and the fillet
    points = mesh_body(body, MeshSettings()).points
    away = np.hypot(points[:, 0] - 60.0, points[:, 1]) - (fork.depth - 0.8)
    at_root = np.abs(np.hypot(away, np.abs(points[:, 2]) - (GAP / 2.0 - 0.8)) - 0.8) < 1e-3
    assert (at_root & (away > 0.0)).sum() > 60


def test_the_pin_in_a_fork_bends_by_half_the_force():
    """M = F/2 (t1/2 + g + h/4), after Melcon & Hoblit; shear F/2; least M = F g/4; a couple is linear on the walls."""
    eye = wall(height=2.0)
    found = fork_pin_stress(100.0, 4.0, FORK, eye, poisson=0.3)
    assert found.moment.high == pytest.approx(50.0 * (1.25 + 0.5 + 0.5))
    assert found.moment.low == pytest.approx(100.0 * 0.5 / 4.0)
    assert found.lever == pytest.approx(2.25)
    assert found.shear == pytest.approx(50.0 * 3.6 / 2.6 / (math.pi * 4.0))
    # Simply supported at the middles of the cheeks under a uniform load on the middle h: F L/4 - F h/8.
    span = GAP + CHEEK
    assert found.moment.high == pytest.approx(100.0 * span / 4.0 - 100.0 * 2.0 / 8.0)
    assert found.moment.high < 0.5 * pin_stress(100.0, 4.0, (wall(height=5.0), eye), 0.5).moment.high
    turned = fork_pin_stress(100.0, 4.0, FORK, eye, moment=30.0, poisson=0.3)
    assert found.moment.high < turned.moment.high < found.moment.high + 30.0
    second = 2.0 * (CHEEK**3 / 12.0 + CHEEK * (span / 2.0) ** 2)
    by_cheek = 30.0 * CHEEK * span / 2.0 / second
    assert turned.shear >= (50.0 + by_cheek) / 50.0 * found.shear * (1.0 - 1e-9)


@pytest.mark.parametrize("stiffness", [1e-4, 1e-1, 10.0, 1e3])
def test_a_pin_on_elastic_foundations_lies_in_its_band(stiffness):
    """Half of the pin as beam elements (EI = 1) on springs to cheek and eye; its middle keeps its direction."""
    x = np.linspace(0.0, GAP / 2.0 + CHEEK, 401)
    n, h, eye = len(x), x[1], 1.0
    b = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                  [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]]) / h**3  # fmt: skip
    k = np.zeros((2 * n + 1, 2 * n + 1))  # the last: displacement of the eye
    for i in range(n - 1):
        k[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += b
        at = (x[i] + x[i + 1]) / 2.0
        for node in (i, i + 1) if at < eye or at > GAP / 2.0 else ():
            k[2 * node, 2 * node] += stiffness * h / 2.0
            if at < eye:
                k[-1, -1] += stiffness * h / 2.0
                k[-1, 2 * node] -= stiffness * h / 2.0
                k[2 * node, -1] -= stiffness * h / 2.0
    free = np.delete(np.arange(2 * n + 1), 1)
    moved = np.zeros(2 * n + 1)
    moved[free] = np.linalg.solve(k[np.ix_(free, free)], np.eye(len(free))[-1] / 2.0)
    moment = max(float(np.abs(b @ moved[2 * i : 2 * i + 4])[[1, 3]].max()) for i in range(n - 1))
    found = fork_pin_stress(1.0, 1.0, FORK, wall(height=2.0 * eye))
    assert found.moment.low * 0.999 <= moment <= found.moment.high * 1.001
    if stiffness == 1e-4:
        assert moment == pytest.approx(found.moment.high, rel=5e-3)


def test_checks_know_the_fork():
    """Bearing on both cheeks, the pin in double shear, and cheeks by hand as bars from the root."""
    case = clevis(fork_depth=f"{DEPTH} mm")
    result = check_case(case, fidelity="beam").load_cases["pull"]
    assert result.pins["B"].lever == pytest.approx(CHEEK / 2.0 + 0.5 + 0.5)
    assert stress_of(case, "B", 100.0).moment == result.pins["B"].moment
    body, beam = case.body("arm"), result.links["arm"].beam
    assert body.ring(body.pin("B")).thickness == 2.0 * CHEEK

    def of_cheek(*wrench):
        at_b = PinLoad(name="B", centre=np.array([60.0, 0.0, 0.0]), diameter=PIN, wrench=np.array(wrench))
        [fork] = details(body, LinkLoads(name="by hand", pins=(at_b,)), beam.forces)
        return fork.stress

    assert of_cheek(100.0, 0, 0, 0, 0, 0).axial == pytest.approx(50.0 / (WIDTH * CHEEK))
    assert of_cheek(0, -7.0, 0, 0, 0, 0).bending == pytest.approx(3.5 * DEPTH * 6.0 / (CHEEK * WIDTH**2))
    assert of_cheek(0, 0, 2.0, 0, 0, 0).bending == pytest.approx(2.0 * DEPTH * 6.0 / (WIDTH * CHEEK**2))
    assert of_cheek(0, 0, 0, 0, 0, 8.0).bending == pytest.approx(4.0 * 6.0 / (CHEEK * WIDTH**2))


def test_a_link_without_part_fills_the_gap_but_for_pin_gap():
    case = clevis(other=None, joint={"pin_gap": "0.5 mm"}, fork_depth="12 mm")
    assert stress_of(case, "B", 100.0).moment.high == pytest.approx(50.0 * (CHEEK / 2.0 + 0.5 + 0.5))


@pytest.mark.parametrize(("thickness", "pin_gap", "half"), [(2.0, 0.0, 1.0), (1.0, 0.5, 0.5), (2.8, 0.5, 1.0)])
def test_a_link_without_part_fills_no_more_of_the_gap_than_its_thickness(thickness, pin_gap, half):
    data = entries(other=None, joint={"pin_gap": f"{pin_gap} mm"}, fork_depth="12 mm")
    data["links"]["tip"]["thickness"] = f"{thickness} mm"
    expected = 50.0 * (CHEEK / 2.0 + GAP / 2.0 - half + half / 2.0)
    assert stress_of(validate(data), "B", 100.0).moment.high == pytest.approx(expected)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"other": THIN | {"thickness": "3.2 mm"}}, r"gap of 3 mm is less than the 3.2 mm of the eye of link 'tip'"),
        ({"joint": {"pin_gap": "1 mm"}}, "fork and eye leave 0.5 mm on either side"),
        ({"other": None, "joint": {"pin_gap": "1.5 mm"}}, "leave nothing of the fork's gap"),
        ({"fork": "7.9 mm"}, "whose cheeks would be too thin: set fork to at most 7.2 mm"),
        ({"fork_radius": "1.6 mm"}, "fork_radius of 1.6 mm, but it must be at most 1.47 mm"),
        ({"fork_depth": "7 mm"}, "less than the radius of its eye"),
        ({"fork_depth": "55 mm"}, "reaches the eye at A"),
        ({"fork": None, "fork_radius": "1 mm"}, "need a fork"),
        (
            {"part": CUBE | {"shape": "tube", "outer_diameter": "8 mm", "inner_diameter": "6 mm"}},
            "a part of shape tube takes no forks",
        ),
    ],
)
def test_forks_that_do_not_fit_are_refused(changes, said):
    with pytest.raises(CaseError, match=said):
        clevis(**changes)


def test_an_imported_fork_is_one_where_the_case_says_so(tmp_path):
    """Cheeks of 4 mm, 8 mm apart, with a link without part that leaves 1 mm free on either side: 2 + 1 + 6/4 mm."""
    path = imported_case(tmp_path, file="fork.step", points='{ O4 = ["0 mm", "0 mm"], B = ["40 mm", "0 mm"] }')
    text = path.read_text().replace('pin_diameter = "5 mm"', 'pin_diameter = "5 mm", pin_gap = "1 mm"')

    def stress(fork):
        path.write_text(
            text.replace('part = "own"', f'part = "own", eyes.O4 = {{ {fork} }}' if fork else 'part = "own"')
        )
        return stress_of(read_case(str(path)), "O4", 100.0)

    assert stress('fork = "8 mm"').moment.high == pytest.approx(50.0 * (2.0 + 1.0 + 1.5))
    assert stress("").moment.high > 2.0 * stress('fork = "8 mm"').moment.high
    for fork, said in {
        'fork = "7 mm"': r"eyes\.O4\.fork: it is 7 mm, but the bore of the file has gaps of 8 mm",
        'diameter = "9 mm"': "takes no eyes of their own, only what its file has",
    }.items():
        with pytest.raises(CaseError, match=said):
            stress(fork)
