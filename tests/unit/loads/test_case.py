import copy
import math
import tomllib

import jsonschema
import numpy as np
import pytest
from edited_cases import edited
from materials import SOURCED

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.linkage.pose import CLOSED
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, read_text, validate
from alula.loads.records.applied import BodyForce, LineLoad, PartMass, PointLoad
from alula.loads.records.load_case import vector3
from alula.loads.states.actions import acting_loads, needs_masses

OWL = "owl-wing-static"


@pytest.fixture(scope="module")
def owl() -> Case:
    return read_case(OWL)


def test_the_owl_wing_as_the_source_states_it(owl: Case) -> None:
    assert owl.linkage.moving == ("GF", "AE", "CF", "CH", "ED")
    assert owl.linkage.longest == 190.0
    assert {name: owl.links["CF"].points[name] for name in "FBC"} == {"F": (0, 0), "B": (60, 0), "C": (150, 0)}
    assert math.degrees(owl.pose.angle) == pytest.approx(228.15)
    assert (owl.pose.coordinate, owl.pinned_drive.link, owl.pinned_drive.joint) == ("GF", "AE", "A")  # type: ignore[union-attr]
    assert sum(row.count for row in owl.links["CH"].holes) == 10
    assert sum(row.count for row in owl.links["CF"].holes) == 12
    assert {joint.pin_diameter for joint in owl.joints.values()} == {1.5}
    part = owl.part_of("ED")
    assert part.shape == "tube"
    assert (part.outer_diameter, part.inner_diameter) == (5.0, 2.5)
    assert owl.load_cases["weight"].forces[0].force == (0.0, -0.25)
    assert not owl.load_cases["weight"].own_weight


def test_bodies_of_the_owl_wing_can_be_built(owl: Case) -> None:
    for link in owl.checked_links:
        check_body(owl.body(link))
    body = owl.body("CH")
    assert [pin.name for pin in body.pins] == ["C", "D"]
    assert [(end.name, end.x, end.patch) for end in body.ends] == [("H", 124.0, 5.0)]
    assert owl.material_of("CH").allowable == 41.4
    assert owl.checked_links == owl.linkage.moving


def test_the_pose_of_the_case(owl: Case) -> None:
    assert owl.solve_pose().residual <= CLOSED


def test_a_link_without_part() -> None:
    # `--set` cannot take an entry away, so the table is read without it.
    data = tomllib.loads(read_text(OWL)[0])
    del data["links"]["ED"]["part"]
    case = validate(data)
    assert case.checked_links == ("GF", "AE", "CF", "CH")
    with pytest.raises(CaseError, match=r"links.ED.part: this link has no part; name one"):
        case.part_of("ED")


def _without(*path: str) -> dict[str, object]:
    data = tomllib.loads(read_text(OWL)[0])
    here = data
    for key in path[:-1]:
        here = here[key]
    del here[path[-1]]
    return data


@pytest.mark.parametrize(
    ("path", "words"),
    [
        (("drive",), "drive: the linkage has mobility 1, but nothing drives it; add a .drive. with its link and joint"),
        (("pose", "coordinate"), "pose.coordinate: .*no link fixes its pose; name one"),
        (("joints", "A", "pin_diameter"), "joints.A.pin_diameter: link 'AE' has a part.*\"1.5 mm\""),
        (("load_cases",), "load_cases: this entry is missing; add it"),
        (("title",), "title: this entry is missing; add it"),
        (("schema_version",), "schema_version: it is missing"),
    ],
)
def test_what_must_not_be_left_out(path: tuple[str, ...], words: str) -> None:
    with pytest.raises(CaseError, match=words):
        validate(_without(*path))


def test_a_structure_needs_neither_drive_nor_coordinate() -> None:
    point = {"A": ["0 mm", "0 mm"], "B": ["80 mm", "0 mm"]}
    data = {
        "schema_version": 1,
        "title": "a truss of two bars",
        "links": {
            "g": {"ground": True, "points": {"A": ["0 mm", "0 mm"], "E": ["96 mm", "0 mm"]}},
            "1": {"points": point},
            "2": {"points": {"E": ["0 mm", "0 mm"], "B": ["80 mm", "0 mm"]}},
        },
        "joints": {"A": {"links": ["g", "1"]}, "B": {"links": ["1", "2"]}, "E": {"links": ["g", "2"]}},
        "pose": {"near": {"1": "60 deg", "2": "120 deg"}},
        "load_cases": {"one": {"forces": [{"link": "1", "at": "B", "force": ["0 N", "-1 N"]}]}},
    }
    case = validate(data)
    assert case.solve_pose().points["B"] == pytest.approx([48.0, 64.0])
    driven = copy.deepcopy(data) | {"drive": {"link": "1", "joint": "A"}}
    with pytest.raises(CaseError, match=r"mobility 0 .* 1 drive; they must be equal"):
        validate(driven)
    posed = copy.deepcopy(data)
    posed["pose"] = {"coordinate": "1", "angle": "53 deg"}
    with pytest.raises(CaseError, match=r"pose.coordinate: it is '1', but the linkage cannot move .*remove it"):
        validate(posed)
    weighing = copy.deepcopy(data)
    weighing["load_cases"]["one"]["own_weight"] = True  # type: ignore[index]
    with pytest.raises(CaseError, match=r"load_cases.one.own_weight: link '1' has neither a part nor a mass"):
        validate(weighing)


def test_a_safety_factor_check_needs_a_limit_from_somewhere() -> None:
    bare = (
        'materials.bare={title="m",density="1 g/cm^3",youngs_modulus="2 GPa",poissons_ratio=0.3,'
        'yield_strength="40 MPa",strength="yield",' + SOURCED + "}"
    )
    use = 'parts.tube.material="bare"'
    assert edited(OWL, [bare, use]).material_of("ED").minimum_safety_factor is None
    with pytest.raises(CaseError, match=r"checks.x.minimum: it is missing, and 'bare', the material of link 'GF'"):
        edited(OWL, [bare, use, 'checks.x={type="safety-factor"}'])


def test_a_load_point_off_the_axis_must_be_a_pin() -> None:
    with pytest.raises(CaseError, match=r"links.CH.points.H: .*axis \(y = 0\), but y is 3 mm; move it"):
        edited(OWL, ['links.CH.points.H=["124 mm", "3 mm"]'])


# ---- from load cases to loads ------------------------------------------------------------------------------


def test_actions_of_every_kind(owl: Case) -> None:
    case = edited(
        OWL,
        [
            'load_cases.weight.moments=[{link="CH", at="H", moment="2 N*m"}]',
            'load_cases.weight.spread=[{link="CH", start="H", end="D", total=["1 N", "2 N", "3 N"]}]',
            "load_cases.weight.own_weight=true",
            "load_cases.weight.gravity_direction=180 deg",
        ],
    )
    assert needs_masses(case)
    assert not needs_masses(owl)
    masses = {name: PartMass(mass=2e-6, centroid=np.array([30.0, 0.0])) for name in case.checked_links}
    loads = acting_loads(case, case.load_cases["weight"], case.solve_pose().placement, masses)
    points = [load for load in loads if isinstance(load, PointLoad)]
    np.testing.assert_array_equal(points[0].wrench, [0, -0.25, 0, 0, 0, 0])
    np.testing.assert_array_equal(points[1].wrench, [0, 0, 0, 0, 0, 2000.0])
    (line,) = [load for load in loads if isinstance(load, LineLoad)]
    assert (line.start, line.end) == (77.0, 124.0)
    np.testing.assert_allclose(line.at_start * 47.0, [1.0, 2.0, 3.0])
    weights = [load for load in loads if isinstance(load, BodyForce)]
    assert [load.link for load in weights] == list(case.checked_links)
    np.testing.assert_allclose(weights[0].specific_force, [-9810.0, 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize(
    ("override", "words"),
    [
        (
            'load_cases.weight.moments=[{link="XX", at="E", moment="2 N*m"}]',
            "moments.0.link: 'XX' is not a moving link",
        ),
        ('load_cases.weight.moments=[{link="AE", at="C", moment="2 N*m"}]', "moments.0: link 'AE' has no point 'C'"),
        (
            'load_cases.weight.spread=[{link="CH", start="D", end="D", total=["1 N", "0 N"]}]',
            "spread.0: start and end lie at the same station; name two",
        ),
        (
            'load_cases.weight.spread=[{link="CH", start="D", end="Z", total=["1 N", "0 N"]}]',
            "spread.0: link 'CH' has no point 'Z'",
        ),
    ],
)
def test_loads_that_act_nowhere(override: str, words: str) -> None:
    with pytest.raises(CaseError, match=words):
        edited(OWL, [override])


def test_vectors_of_two_and_three_components() -> None:
    np.testing.assert_array_equal(vector3((1.0, 2.0)), [1.0, 2.0, 0.0])
    np.testing.assert_array_equal(vector3((1.0, 2.0, 3.0)), [1.0, 2.0, 3.0])
    with pytest.raises(CaseError, match="at most 3"):
        edited(OWL, ['load_cases.weight.forces.0.force=["1 N", "1 N", "1 N", "1 N"]'])


# ---- the schema --------------------------------------------------------------------------------------------


def test_the_schema_accepts_the_built_in_case_and_refuses_bare_numbers() -> None:
    schema = Case.model_json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    data = tomllib.loads(read_text(OWL)[0])
    validator.validate(data)
    for key, value in (("title", 5), ("bogus", 1), ("pose", {"angle": 228})):
        assert not validator.is_valid(data | {key: value})


def test_the_schema_describes_its_entries() -> None:
    schema = Case.model_json_schema()
    for name, definition in schema["$defs"].items():
        assert definition.get("description"), name
    assert "driven" in schema["$defs"]["DriveSpec"]["properties"]["link"]["description"]


def test_a_case_is_frozen(owl: Case) -> None:
    with pytest.raises(ValueError, match="frozen"):
        owl.title = "other"
