"""Natural frequencies of linkages against rigid-body mechanics: pendulums, and drives that give.

Links of a material so stiff that they bend by nothing swing as f = √(k/I)/(2π). The reduced inertia I comes from poses
on both sides by differences (kinetic energy), the stiffness k from the drive's own and from how the drive torque of
statics changes with the pose (virtual work): neither knows of the frame.
"""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from materials import stiff
from scipy.linalg import eigh
from vibrating_frames import DENSITY, LENGTH, POISSON, YOUNG, eigenvalues, rectangle, straight

from alula.fea.common.source import SourceKind
from alula.fea.frame.build import build_frame
from alula.fea.frame.displacement_band import Zone
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import ALL_DOFS, PIN_DOFS, FrameElement, FrameModel, Support, Tie
from alula.fea.nonlinear.corotational import subdivide
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.stability import stiffness_parts
from alula.fea.standing.case_statics import solve_case_statics
from alula.fea.vibration import flexibility_doubt
from alula.fea.vibration.linkage_modes import divide, frame_modes
from alula.fea.vibration.mass_matrix import MassMatrix, beam_mass, body_mass, mass_matrix
from alula.fea.vibration.over_motion import FINE, case_frequencies
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_case, validate
from alula.loads.states.masses import laden_masses, part_masses
from alula.reports.sentences import told

STOUT, SLIM = rectangle(4.0, 3.0), rectangle(0.5, 0.5)
STIFF = f"""
[parts.bar]
shape = "bar"
material = "stiff"
width = "8 mm"
thickness = "6 mm"
fillet_radius = "1 mm"
{stiff(density="4 g/cm^3", young="90000 GPa", strength="90 GPa")}
"""
LEVER = """
schema_version = 1
title = "A lever"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], Z = ["9 mm", "0 mm"] } }
links.lever = { part = "bar", points = { O = ["0 mm", "0 mm"], P = ["90 mm", "0 mm"] } }
joints.O = { links = ["base", "lever"], pin_diameter = "3 mm" }
carried = [{ link = "lever", at = "P", mass = "30 g", centroid = ["70 mm", "40 mm"], radius_of_gyration = "12 mm" }]
"""
FOUR_BAR = """
schema_version = 1
title = "A four-bar with springs and weights"
links.base.ground = true
links.base.points = { A = ["0 mm", "0 mm"], D = ["90 mm", "0 mm"], S = ["30 mm", "80 mm"], E = ["60 mm", "-20 mm"] }
links.crank = { part = "bar", points = { A = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"] } }
links.coupler = { part = "bar", points = { B = ["0 mm", "0 mm"], P = ["40 mm", "0 mm"], C = ["80 mm", "0 mm"] } }
links.rocker = { part = "bar", points = { D = ["0 mm", "0 mm"], Q = ["40 mm", "0 mm"], C = ["60 mm", "0 mm"] } }
joints.A = { links = ["base", "crank"], pin_diameter = "3 mm", pin_material = "stiff" }
joints.B = { links = ["crank", "coupler"], pin_diameter = "3 mm", pin_material = "stiff" }
joints.C = { links = ["coupler", "rocker"], pin_diameter = "3 mm", pin_material = "stiff" }
joints.D = { links = ["base", "rocker"], pin_diameter = "3 mm", pin_material = "stiff" }
pose = { coordinate = "crank", angle = "60 deg", near = { coupler = "20 deg", rocker = "90 deg" } }
drive = { link = "crank", joint = "A", stiffness = "3 N*m/rad" }
springs.hinge = { joint = "C", stiffness = "1500 N*mm/rad", free_angle = "60 deg" }
tendons.pull = { through = [{ link = "base", at = "S" }, { link = "rocker", at = "C" }], tension = "25 N" }
[springs.line]
between = [{ link = "coupler", at = "P" }, { link = "base", at = "S" }]
stiffness = "3 N/mm"
free_length = "5 mm"
[[carried]]
link = "coupler"
at = "P"
mass = "40 g"
centroid = ["45 mm", "30 mm"]
radius_of_gyration = "15 mm"
[[carried]]
link = "rocker"
start = "D"
end = "C"
mass = "25 g"
[load_cases.heavy]
own_weight = true
gravity = "2000 m/s^2"
forces = [{ link = "rocker", at = "Q", force = ["30 N", "10 N"] }]
"""
PRESS = """
schema_version = 1
title = "A slider that is pushed against its spring of a drive"
links.base = { ground = true, points = { O = ["0 mm", "0 mm"], G = ["0 mm", "0 mm"] } }
links.upper = { part = "bar", points = { O = ["0 mm", "0 mm"], A = ["80 mm", "0 mm"] } }
links.lower = { part = "bar", points = { A = ["0 mm", "0 mm"], B = ["70 mm", "0 mm"] } }
links.ram = { points = { B = ["0 mm", "0 mm"], T = ["20 mm", "0 mm"] } }
joints.O = { links = ["base", "upper"], pin_diameter = "5 mm" }
joints.A = { links = ["upper", "lower"], pin_diameter = "5 mm" }
joints.B = { links = ["lower", "ram"], pin_diameter = "5 mm" }
joints.guide = { type = "slider", links = ["base", "ram"], points = ["G", "B"] }
pose = { coordinate = "guide", travel = "120 mm", near = { upper = "30 deg", lower = "-35 deg", ram = "0 deg" } }
drive = { link = "ram", joint = "guide", stiffness = "300 N/mm" }
load_cases.heavy = { own_weight = false, forces = [{ link = "upper", at = "A", force = ["0 N", "-200 N"] }] }
carried = [{ link = "ram", at = "T", mass = "50 g" }]
"""


def case_of(text, **tables):
    return validate({**tomllib.loads(text + STIFF), **tables})


def at(case, **pose):
    """The case in another pose near its own, with its springs as they are."""
    return case.model_copy(update={"pose": case.pose.model_copy(update=pose)})


def reduced(case, entry, value, step):
    """Inertia and change of the drive's effort, per unit of the coordinate, by differences."""
    masses = laden_masses(case, part_masses(case))
    near = [at(case, **{entry: value + s * step}) for s in (-1.0, 1.0)]
    poses = [one.solve_pose() for one in near]
    inertia = 0.0
    for link, mass in masses.items():
        places = [p.origins[link] + p.rotation(link) @ mass.centroid for p in poses]
        speed = (places[1] - places[0]) / (2.0 * step)
        spin = (poses[1].angles[link] - poses[0].angles[link]) / (2.0 * step)
        inertia += mass.mass * float(speed @ speed) + mass.inertia * spin**2
    efforts = []
    for one in near:
        [found] = solve_case_statics(one).reactions.values()
        efforts.append(float(found.drive_torque + found.drive_force))
    return inertia, (efforts[1] - efforts[0]) / (2.0 * step)


def first(case, in_plane=True):
    """Lowest mode in the plane."""
    [history] = case_frequencies(case).histories.values()
    return next(mode for mode in history.lowest.modes if (mode.in_plane > 0.5) is in_plane)


LAYERS = {"base": 0, "crank": 1, "coupler": 2, "rocker": 1}


@pytest.mark.parametrize("layers", [{}, LAYERS])
def test_a_four_bar_swings_on_its_drive_springs_and_weights(layers):
    tables = tomllib.loads(FOUR_BAR + STIFF)
    for name, layer in layers.items():
        tables["links"][name]["layer"] = layer
    case = validate({**tables, **({"layer_spacing": "7 mm"} if layers else {})})
    inertia, more = reduced(case, "angle", case.pose.angle, 1e-4)
    drive = case.drive.stiffness.value
    assert abs(more) > 0.1 * drive  # springs and weights count
    assert first(case).frequency.value == pytest.approx(math.sqrt((drive + more) / inertia) / (2 * math.pi), rel=1e-4)


def test_a_slider_swings_on_its_drive():
    case = case_of(PRESS)
    inertia, more = reduced(case, "travel", case.pose.travel, 1e-3)
    expected = math.sqrt((case.drive.stiffness.value + more) / inertia) / (2 * math.pi)
    assert first(case).frequency.value == pytest.approx(expected, rel=1e-4)


def hanging(**load):
    """A lever that is let go, and swings below its pin."""
    tables = {
        "pose": {"coordinate": "lever", "angle": "-80 deg", "equilibrium": True},
        "load_cases": {"hang": {"own_weight": True, **load}},
    }
    return case_of(LEVER, **tables)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_slider_swings_in_a_range_where_its_load_scatters(sense):
    """The load takes from its frequency or adds to it, with the guide and the drive that gives."""

    def swung(force, **more):
        force = [{"link": "upper", "at": "A", "force": ["0 N", f"{force} N"]}]
        case = case_of(PRESS, load_cases={"heavy": {"own_weight": False, "forces": force, **more}})
        [history] = case_frequencies(case).histories.values()
        return [mode.frequency for mode in history.lowest.modes]

    own, ends = swung(sense * 2000.0, scatter="30 %"), [swung(s * sense * 2000.0) for s in (0.7, 1.3)]
    assert ends[0][0].value != pytest.approx(ends[1][0].value, rel=0.02)
    for band, *others in zip(own, *ends, strict=True):
        assert band.low <= min(one.value for one in others)
        assert band.high >= max(one.value for one in others)
    assert own[0].low == pytest.approx(min(one[0].low for one in ends), rel=0.02)
    assert own[0].high == pytest.approx(max(one[0].high for one in ends), rel=0.02)


@pytest.mark.parametrize("gravity", ["9.81 m/s^2", "40 m/s^2"])
def test_a_compound_pendulum_that_nothing_but_its_weight_holds(gravity):
    """f = √(m g c/I_O)/(2π), with mass, centroid and inertia of bar and body by the kernel and by hand."""
    case = hanging(gravity=gravity)
    mass = laden_masses(case, part_masses(case))["lever"]
    arm = float(np.linalg.norm(mass.centroid))
    pull = float(gravity.split()[0]) * 1000.0
    expected = math.sqrt(mass.mass * pull * arm / (mass.inertia + mass.mass * arm**2)) / (2 * math.pi)
    found = first(case)
    assert found.frequency.value == pytest.approx(expected, rel=1e-5)
    assert found.frequency.low == pytest.approx(expected, rel=1e-4)  # no flexibility is in doubt that counts


def test_two_pendulums_in_a_row():
    """|K - ω² M| = 0 with M of two rods, K = g diag(m1 c1 + m2 L1, m2 c2): the double pendulum, linearised."""
    pull, line, lengths = 9810.0, DENSITY * SLIM.area, (60.0, 100.0)
    weight = np.array([0.0, -pull * line, 0.0])
    nodes = np.array([[0.0, 0, 0], [0, -60, 0], [0, -60, 0], [0, -160, 0]])
    bars = tuple(
        FrameElement(nodes=ends, section=SLIM, young=1e6 * YOUNG, poisson=POISSON, load_first=weight, load_last=weight)
        for ends in ((0, 1), (2, 3))
    )
    fixed = FrameModel(
        nodes=nodes, elements=bars, supports=(Support(node=0),), ties=(Tie(nodes=(1, 2), dofs=ALL_DOFS),)
    )
    swinging = replace(fixed, supports=(Support(node=0, dofs=PIN_DOFS),), ties=(Tie(nodes=(1, 2)),))
    held, path = solve_frame(subdivide(fixed, 6)), EquilibriumPath(subdivide(swinging, 6))
    K, G = stiffness_parts(path, held.end_forces, held.guide_forces)
    mass = MassMatrix(model=path.model, beams=np.array([beam_mass(path.model, i, np.full(4, line)) for i in range(12)]))
    found = frame_modes(path, K + G, mass, 2).values
    (one, two), (a, b) = (line * length for length in lengths), lengths
    M = np.array([[one * a**2 / 3.0 + two * a**2, two * a * b / 2.0], [two * a * b / 2.0, two * b**2 / 3.0]])
    expected = eigh(pull * np.diag([one * a / 2.0 + two * a, two * b / 2.0]), M, eigvals_only=True)
    assert found == pytest.approx(expected, rel=1e-3)


def test_a_weight_above_a_soft_drive_falls_over_and_is_told():
    """Above its pin: K = k - m g c < 0; it departs as exp(√(|K|/I) t)."""
    tables = {
        "pose": {"coordinate": "lever", "angle": "90 deg"},
        "drive": {"link": "lever", "joint": "O", "stiffness": "5 N*mm/rad"},
        "load_cases": {"stand": {"own_weight": True}},
        "carried": [{"link": "lever", "at": "P", "mass": "30 g"}],
    }
    case = case_of(LEVER, **tables)
    mass = laden_masses(case, part_masses(case))["lever"]
    fall = mass.mass * 9810.0 * mass.centroid[0] - 5.0
    rate = math.sqrt(fall / (mass.inertia + mass.mass * mass.centroid[0] ** 2))
    [history] = case_frequencies(case).histories.values()
    assert history.frequencies[0, 0] == history.low[0, 0] == 0.0
    assert f"every {1.0 / rate:.3g} s" in " ".join(map(told, history.lowest.notes))
    stiff = case_of(LEVER, **{**tables, "drive": {**tables["drive"], "stiffness": "500 N*mm/rad"}})
    expected = math.sqrt(500.0 - 5.0 - fall) / math.sqrt(fall) * rate / (2 * math.pi)
    assert first(stiff).frequency.value == pytest.approx(expected, rel=1e-4)


def test_a_turn_of_the_whole_changes_nothing():
    tables, turn = tomllib.loads(FOUR_BAR + STIFF), math.radians(37.0)
    plain = validate({**tables, "materials": {"stiff": {**tables["materials"]["stiff"], "youngs_modulus": "3 GPa"}}})
    points = {
        name: (math.cos(turn) * x - math.sin(turn) * y, math.sin(turn) * x + math.cos(turn) * y)
        for name, (x, y) in plain.links["base"].points.items()
    }
    base = plain.links["base"].model_copy(update={"points": points})
    pose = plain.pose.model_copy(
        update={"angle": plain.pose.angle + turn, "near": {k: v + turn for k, v in plain.pose.near.items()}}
    )
    [load_case] = plain.load_cases.values()
    [force] = load_case.forces
    spin = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    turned_force = force.model_copy(update={"force": tuple(spin @ np.array(force.force))})
    turned = load_case.model_copy(
        update={"gravity_direction": load_case.gravity_direction + turn, "forces": (turned_force,)}
    )
    other = plain.model_copy(
        update={"links": {**plain.links, "base": base}, "pose": pose, "load_cases": {"heavy": turned}}
    )
    one, two = (case_frequencies(case).histories["heavy"] for case in (plain, other))
    for end in ("frequencies", "low", "high"):
        assert getattr(one, end) == pytest.approx(getattr(two, end), rel=1e-6)


@pytest.mark.parametrize("name", ["flapping-wing-chosen", "knee"])
def test_the_mass_matrix_weighs_as_the_kernel_says(name):
    """Moved and turned as a whole, in layers and pairs, with arms, pins and what links carry."""
    case = read_case(name)
    masses = part_masses(case)
    frame = build_frame(case, case.stated_pose, (), held=case.pinned_drive)
    divided, parents = divide(frame, 4)
    mass = mass_matrix(case, frame, divided, parents, masses)
    ladens = {link: one for link, one in laden_masses(case, masses).items() if link != case.linkage.ground}
    total = sum(one.mass for one in ladens.values())
    pose, inertia = case.stated_pose, 0.0
    for link, one in ladens.items():
        place = pose.origins[link] + pose.rotation(link) @ one.centroid
        inertia += one.inertia + one.mass * float(place @ place)
    n = len(divided.nodes)
    for axis in range(3):
        shape = np.zeros((n, 6))
        shape[:, axis] = 1.0
        assert mass.energies(shape)[0] == pytest.approx(total, rel=1e-9)
    turned = np.zeros((n, 6))
    turned[:, 0], turned[:, 1], turned[:, 5] = -divided.nodes[:, 1], divided.nodes[:, 0], 1.0
    whole, plane = mass.energies(turned)
    assert plane == pytest.approx(whole, rel=1e-9)
    assert whole == pytest.approx(inertia, rel=2e-3)


def test_what_has_no_mass_gives_no_spurious_value():
    """A beam without mass and a body at its tip: as many modes as the body has motions with mass."""
    mass, inertia = 1e-5, 4e-3
    body = body_mass(mass, np.zeros(3), inertia)  # a thin rod along the beam
    found = eigenvalues(straight(STOUT, ALL_DOFS, set()), 12, bodies=[(1, body)], density=0.0)
    assert len(found) == 5  # all but the turn about itself
    for second in (STOUT.i_y, STOUT.i_z):  # a body that turns at the end of a cantilever without mass
        bend = YOUNG * second / LENGTH**3 * np.array([[12.0, -6.0 * LENGTH], [-6.0 * LENGTH, 4.0 * LENGTH**2]])
        for value in np.linalg.eigvals(np.diag([1.0 / mass, 1.0 / inertia]) @ bend):
            assert min(found, key=lambda v: abs(v - value)) == pytest.approx(value, rel=0.05)


def springless(**tables):
    """The four-bar without springs and weights, held rigidly, of a plastic."""
    found = tomllib.loads(FOUR_BAR + STIFF)
    for entry in ("springs", "tendons", "carried"):
        del found[entry]
    found["materials"]["stiff"] |= {"youngs_modulus": "3 GPa", "youngs_modulus_range": ["2 GPa", "4.5 GPa"]}
    found["drive"] = {"link": "crank", "joint": "A"}
    return validate({**found, "load_cases": {"own": {"title": "nothing", "own_weight": False}}, **tables})


def test_frequencies_go_with_the_root_of_the_modulus():
    """All links of one range, √(4.5/2) from end to end, whatever eyes add to it."""
    mode = first(springless())
    widths = {source.kind: source.width for source in mode.frequency.sources}
    assert widths[SourceKind.MODULUS] == pytest.approx(math.sqrt(4.5 / 2.0), rel=1e-6)
    eyes = widths[SourceKind.EYES]
    assert eyes * widths[SourceKind.MODULUS] == pytest.approx(mode.frequency.high / mode.frequency.low, rel=0.02)


def test_beams_four_times_as_soft_ring_an_octave_lower(monkeypatch):
    """Every zone between a quarter and four times its flexibility, and bores that do not give."""

    def give(case, frame):
        zones = {i: (Zone(start=0.0, end=math.inf, least=np.full(6, 0.25), most=np.full(6, 4.0)),) for i in frame.beams}
        return zones, []

    monkeypatch.setattr(flexibility_doubt, "give_of_links", give)
    found = tomllib.loads(FOUR_BAR + STIFF)["materials"]["stiff"] | {"youngs_modulus": "3 GPa"}
    band = first(springless(materials={"stiff": found})).frequency
    assert (band.low, band.high) == pytest.approx((band.value / 2.0, band.value * 2.0), rel=1e-6)


def test_a_bore_gives_in_series_with_the_drive(monkeypatch):
    """A stiff lever: 1/k = 1/k_drive + c of its bore, on which the eye beside it counts as if it bore."""
    soft, give = 1e-4, np.zeros(6)
    give[5] = soft

    def give_of_links(case, frame):
        return {}, [("lever", frame.points["lever", "O"], give)]

    monkeypatch.setattr(flexibility_doubt, "give_of_links", give_of_links)
    drive = {"link": "lever", "joint": "O", "stiffness": "8000 N*mm/rad"}
    tables = {"pose": {"coordinate": "lever", "angle": "0 deg"}, "drive": drive}
    case = case_of(LEVER, **tables, load_cases={"own": {"title": "nothing", "own_weight": False}})
    mass = laden_masses(case, part_masses(case))["lever"]
    inertia = mass.inertia + mass.mass * float(mass.centroid @ mass.centroid)
    band = first(case).frequency
    ends = [math.sqrt(k / inertia) / (2 * math.pi) for k in (8000.0 / (1.0 + 8000.0 * soft), 8000.0)]
    assert (band.low, band.value) == pytest.approx(ends, rel=5e-4)


def test_over_a_motion_the_least_frequency_lies_between_poses():
    """A lever that turns through the place where its weight steadies a soft drive least: K = k + m g c cos(...).

    At 90°, while the poses that are asked for stand at 47.5° and 95°: the nearest of the finer ones is found.
    """
    tables = {
        "pose": {"coordinate": "lever", "angle": "0 deg"},
        "drive": {"link": "lever", "joint": "O", "stiffness": "5000 N*mm/rad"},
        "motion": {"range": ["0 deg", "190 deg"], "speed": "60 rpm"},
        "carried": [{"link": "lever", "at": "P", "mass": "100 g"}],
        "load_cases": {"up": {"own_weight": True, "gravity": "150 m/s^2", "speed": "0 rpm"}},
    }
    case = case_of(LEVER, **tables)
    history = case_frequencies(case, poses=5).histories["up"]
    mass = laden_masses(case, part_masses(case))["lever"]
    arm = mass.centroid[0]
    inertia, pull = mass.inertia + mass.mass * arm**2, mass.mass * 150e3 * arm
    expected = [math.sqrt((5000.0 - pull * math.sin(at)) / inertia) / (2 * math.pi) for at in history.at]
    own = np.array(
        [min(row, key=lambda f, e=e: abs(f - e)) for row, e in zip(history.frequencies, expected, strict=True)]
    )
    assert own == pytest.approx(np.array(expected), rel=1e-4)
    assert history.driving == pytest.approx(1.0)
    fine = np.radians(np.linspace(0.0, 190.0, 4 * FINE + 1))
    nearest = fine[np.argmin(np.abs(fine - math.pi / 2.0))]
    assert history.lowest.pose.angles["lever"] == pytest.approx(nearest, abs=1e-6)
    assert history.lowest.modes[0].frequency.low == history.low[:, 0].min()


def test_a_stop_that_bears_holds_rigidly():
    """The lever lies on a stop: it rings as one whose drive does not give, and not on its own drive."""
    found = []
    for tables in (
        {
            "stops": {"rest": {"joint": "O", "at_least": "0 deg"}},
            "pose": {"equilibrium": True},
            "drive": {"link": "lever", "joint": "O", "stiffness": "300 N*mm/rad"},
        },
        {"drive": {"link": "lever", "joint": "O"}},
    ):
        pose = {"coordinate": "lever", "angle": "0 deg"} | tables.get("pose", {})
        case = case_of(LEVER, **{**tables, "pose": pose}, load_cases={"lie": {"own_weight": True}})
        found.append(case_frequencies(case).histories["lie"].frequencies)
    assert found[0] == pytest.approx(found[1], rel=1e-6)


@pytest.mark.parametrize("stated", ["20 N/mm", "0 N*m/rad", "5 N"])
def test_the_stiffness_of_a_drive_is_that_of_its_joint(stated):
    tables = {
        "pose": {"coordinate": "lever", "angle": "0 deg"},
        "drive": {"link": "lever", "joint": "O", "stiffness": stated},
        "load_cases": {"own": {"title": "nothing", "own_weight": False}},
    }
    with pytest.raises(CaseError, match=r"drive\.stiffness"):
        case_of(LEVER, **tables)
