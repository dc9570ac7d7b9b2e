"""Heights of links in layers, and what is refused of them."""

import re

import pytest
from edited_cases import PLANAR
from edited_cases import edited as edited_case
from tilting_pins import checked, in_one_layer

from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import built_in_cases, read_case, read_text
from alula.loads.case.forks import in_holes, outer_link
from alula.loads.case.layers import slab
from alula.loads.states.clearance import clearance

LINKS = ("AG", "GF", "AE", "CF", "CH", "ED")
FOUR = [f"links.{name}.layer={layer}" for name, layer in zip(LINKS, (0, 0, 1, 2, 3, 2), strict=True)]
WING = "owl-wing-static"


def edited(changes: list[str]) -> Case:
    """Return the owl wing with layers of the test's own."""
    return edited_case(WING, changes, bare=True)


def test_layers_stand_a_spacing_apart() -> None:
    case = edited([*FOUR, 'layer_spacing="7.5 mm"'])
    assert case.layered
    assert case.heights == {"AG": 0.0, "GF": 0.0, "AE": 7.5, "CF": 15.0, "CH": 22.5, "ED": 15.0}
    assert case.linkage.rise("A") == 7.5
    assert slab(case, "AE") == (4.0, 11.0)  # eyes 7 mm thick


def test_washers_lie_between_layers_as_thick_as_their_thickest_link() -> None:
    case = edited([*FOUR, 'washer="0.5 mm"', 'links.AE.thickness="3 mm"'])
    # half of 7, the washer, half of 3; then half of 3, the washer, half of 7; then 7.5
    assert [case.heights[name] for name in ("GF", "AE", "CF", "CH")] == [0.0, 5.5, 11.0, 18.5]


def test_a_height_stands_for_a_layer() -> None:
    case = edited([f'links.{name}.z="{3 * i} mm"' for i, name in enumerate(LINKS)])
    assert case.heights["ED"] == 15.0


def test_a_spacing_of_zero_puts_all_layers_in_one_plane() -> None:
    """The joint forces are those of the same links without layers, from equilibrium alone."""
    flat, plain = edited([*FOUR, PLANAR]), edited([])
    assert not flat.layered
    assert set(flat.heights.values()) == {0.0}
    of_flat, of_plain = (solve_case_statics(case, WING).forces["weight"] for case in (flat, plain))
    assert of_flat.by_equilibrium
    for name, joint in of_plain.reactions.joints.items():
        assert of_flat.reactions.joints[name].force == pytest.approx(joint.force, rel=1e-12, abs=1e-15)
    with pytest.raises(CaseError, match="layer_spacing"):
        edited([*FOUR, 'layer_spacing="-1 mm"'])


def test_a_spacing_of_zero_leaves_tight_pins_without_meaning() -> None:
    """A pin that a layered case has tight in a link need not be taken out of the file."""
    tight = edited([*FOUR, PLANAR, 'joints.A.tight_in="AE"'])
    assert not tight.layered
    of_tight, of_plain = (solve_case_statics(case, WING).forces["weight"] for case in (tight, edited([])))
    assert of_tight.by_equilibrium
    for name, joint in of_plain.reactions.joints.items():
        assert of_tight.reactions.joints[name].force == pytest.approx(joint.force, rel=1e-12, abs=1e-15)
    with pytest.raises(CaseError, match="only where links lie in layers"):
        edited([*(f"links.{link}.layer=0" for link in LINKS), 'layer_spacing="7 mm"', 'joints.A.tight_in="AE"'])


BUILT_IN = [name for name in built_in_cases() if re.search(r"^layer = ", read_text(name)[0], re.M)]


@pytest.mark.parametrize("name", BUILT_IN)
def test_layers_of_built_in_cases_leave_room(name: str) -> None:
    """Nothing touches over the motion, and each layer is marked as assumed."""
    case = read_case(name)
    assert case.layered
    found = clearance(case)
    assert found is not None
    assert all(gap.low > 0.0 for gap in found.gaps)
    marked = [line for line in read_text(name)[0].splitlines() if line.startswith(("layer", "washer"))]
    assert len(marked) == len(case.links) + 1
    assert all("# assumed" in line for line in marked)
    assert any(line.startswith("Layers ") for line in case.assumptions)


NO_ROOM = [name for name in BUILT_IN if 'type = "clearance"' not in read_text(name)[0]]
"""Cases without a check that needs layers."""


@pytest.mark.parametrize("name", NO_ROOM)
def test_a_spacing_of_zero_puts_built_in_cases_in_one_plane(name: str) -> None:
    """As the pages say of ``--set``, whatever a case states of its pins."""
    flat = read_case(name, [PLANAR])
    assert not flat.layered
    assert set(flat.heights.values()) == {0.0}


def test_without_layers_all_lies_in_one_plane() -> None:
    case = edited([])
    assert not case.layered
    assert set(case.heights.values()) == {0.0}


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (FOUR, r"layer_spacing: it is missing"),
        ([*FOUR[1:], 'layer_spacing="7 mm"'], r"links\.AG\.layer: it is missing"),
        ([*FOUR, 'layer_spacing="7 mm"', 'washer="1 mm"'], r"washer: layer_spacing is stated as well"),
        ([*FOUR, 'layer_spacing="7 mm"', 'links.AE.z="7 mm"'], r"links\.AE\.z: the link states a layer as well"),
        (['layer_spacing="7 mm"'], r"layer_spacing: no link states a layer"),
        ([*FOUR, 'layer_spacing="7 mm"', 'joints.A.tight_in="CH"'], r"joints\.A\.tight_in: 'CH' is no link"),
        ([*FOUR, 'layer_spacing="7 mm"', 'joints.A.tight_in=["AE", "CH"]'], r"joints\.A\.tight_in: 'CH' is no link"),
        (['joints.A.tight_in="AE"'], r"joints\.A\.tight_in: .*only where links lie in layers"),
        ([*FOUR, 'layer_spacing="7 mm"', 'joints.A.pin_gap="1 mm"'], r"joints\.A\.pin_gap: the layers tell the gap"),
        ([*FOUR, 'washer="1 mm"', "links.AG.layer=-1"], r"links\.AG\.thickness: how high"),
    ],
)
def test_what_does_not_fit_is_refused(changes: list[str], sentence: str) -> None:
    with pytest.raises(CaseError) as told:
        edited(changes)
    assert re.search(sentence, str(told.value))


@pytest.mark.parametrize("joint", ["O2", "A", "B", "O4"])
@pytest.mark.parametrize("entry", ["tight_in", "heads"])
def test_without_layers_a_fork_alone_tells_in_which_links_its_pin_is_tight(joint: str, entry: str) -> None:
    """The coupler has two, at A and B; heads stand outside of a fork, and no joint has them."""
    data = in_one_layer()
    links = data["joints"][joint]["links"]
    data["joints"][joint][entry] = links if entry == "tight_in" else {"diameter": "6 mm", "gap": "0.1 mm"}
    if entry == "tight_in" and joint in "AB":
        assert checked(data).joints[joint].tight_in == tuple(links)
        return
    with pytest.raises(CaseError, match=rf"^joints\.{joint}\.{entry}: it has a meaning only where links lie in layers"):
        checked(data)


STATED = {
    "O2": {"base": "0 mm", "crank": ["0 mm", "0.1 mm"]},  # it may run in one of its holes
    "A": {"crank": "0 mm", "coupler": "0 mm"},
    "B": {"coupler": "0.1 mm", "rocker": "0 mm"},
}


@pytest.mark.parametrize(("forks", "stand"), [(False, {"O2", "B"}), (True, {"O2", "A", "B"})])
def test_without_layers_pins_of_forks_and_those_that_may_run_stand_in_their_holes(forks: bool, stand: set[str]) -> None:
    """Of O4 nothing is stated. Where a spacing of 0 takes layers back, clearances are of play in the plane."""
    data = in_one_layer(forks=forks)
    for name, stated in STATED.items():
        data["joints"][name]["clearance"] = stated
    case = checked(data)
    assert {name for name in case.joints if in_holes(case, name)} == stand
    for link in data["links"].values():
        link["layer"] = 0
    flat = checked(data | {"layer_spacing": "0 mm"})
    assert {name for name in flat.joints if in_holes(flat, name)} == ({"A", "B"} if forks else set())


@pytest.mark.parametrize("links", [["coupler", "rocker"], ["rocker", "coupler"]])
@pytest.mark.parametrize("kind", ["forks", "pairs"])
def test_of_two_forks_or_pairs_at_a_joint_the_wider_is_the_outer_one(kind: str, links: list[str]) -> None:
    """The rocker's of 4 mm lies in the coupler's, which is that of 5 mm between its cheeks or plates."""
    data = in_one_layer(forks=kind == "forks")
    if kind == "forks":
        data["links"]["rocker"]["eyes"] = {"B": {"fork": "1.5 mm", "fork_depth": "16 mm", "fork_radius": "0.4 mm"}}
    else:
        data["parts"]["thin"] = data["parts"]["bar"] | {"thickness": "1.5 mm"}
        data["links"]["rocker"] |= {"part": "thin", "count": 2, "apart": "2.5 mm"}
        data["links"]["coupler"] |= {"count": 2, "apart": "9 mm"}
    data["joints"]["B"]["links"] = links
    assert outer_link(checked(data), "B") == "coupler"
