import math

import pytest
from planar_linkages import four_bar, joint, link, quick_return, scotch_yoke, six_bar, slider_crank
from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.linkage import Link, Linkage


def test_mobility_of_known_linkages() -> None:
    assert four_bar(40, 120, 80, 100).mobility == 1
    assert slider_crank(40, 120, -20).mobility == 1
    assert scotch_yoke(30).mobility == 1
    assert quick_return(30, 80).mobility == 1
    assert six_bar().mobility == 1  # Paredes (2018): L = 6, J1 = 7


def test_mobility_of_a_five_bar_and_a_triangle() -> None:
    ground = link(ground=True, A=(0, 0), E=(100, 0))
    bars = {
        "1": link(A=(0, 0), B=(50, 0)),
        "2": link(B=(0, 0), C=(50, 0)),
        "3": link(C=(0, 0), D=(50, 0)),
        "4": link(D=(0, 0), E=(50, 0)),
    }
    pins = {
        "A": joint("0", "1"),
        "B": joint("1", "2"),
        "C": joint("2", "3"),
        "D": joint("3", "4"),
        "E": joint("0", "4"),
    }
    assert Linkage({"0": ground, **bars}, pins).mobility == 2
    triangle = Linkage(
        {"0": ground, "1": link(A=(0, 0), B=(80, 0)), "2": link(E=(0, 0), B=(80, 0))},
        {"A": joint("0", "1"), "B": joint("1", "2"), "E": joint("0", "2")},
    )
    assert triangle.mobility == 0


def test_the_longest_span_is_found_off_the_axis_and_on_the_ground() -> None:
    linkage = Linkage(
        {"0": link(ground=True, A=(0, 0), B=(10, 0)), "1": link(A=(0, 0), B=(10, 0), P=(-30, 40))},
        {"A": joint("0", "1"), "B": joint("0", "1")},
    )
    assert linkage.longest == pytest.approx(math.hypot(40, 40))
    assert six_bar().longest == 190.0


def test_names_of_joints_and_points() -> None:
    linkage = slider_crank(40, 120, 0)
    assert linkage.joint_points("S") == ("S", "C")
    assert linkage.joint_points("B") == ("B", "B")
    assert linkage.joints_of("block") == ("C", "S")
    assert linkage.point_of("S", "block") == "C"
    assert linkage.point_of("S", "ground") == "S"
    assert linkage.moving == ("crank", "coupler", "block")


def _changed(**change: object) -> tuple[dict[str, Link], dict[str, Joint]]:
    linkage = four_bar(40, 120, 80, 100)
    return dict(linkage.links) | change.get("links", {}), dict(linkage.joints) | change.get("joints", {})  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"links": {"crank": link(ground=True, A=(0, 0), B=(40, 0))}}, ["2 links have ground", "exactly one"]),
        ({"links": {"ground": link(A=(0, 0), D=(100, 0))}}, ["0 links have ground", "exactly one"]),
        ({"joints": {"A": joint("ground", "nobody")}}, ["joints.A", "'nobody'", "the links are ground, crank"]),
        ({"joints": {"A": joint("ground", "coupler")}}, ["joints.A", "no point 'A'", "its points are B, C, P"]),
        ({"joints": {"A": joint("crank", "crank")}}, ["joints.A", "itself", "two different"]),
        ({"links": {"loose": link(X=(0, 0), Y=(1, 0))}}, ["links.loose", "no joint", "nothing holds it"]),
    ],
)
def test_links_and_joints_that_do_not_fit(change: dict[str, object], words: list[str]) -> None:
    with pytest.raises(CaseError) as caught:
        Linkage(*_changed(**change))
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_two_links_that_hang_together_but_not_with_the_ground() -> None:
    links, joints = _changed(
        links={"x": link(P=(0, 0), Q=(9, 0)), "y": link(P=(0, 0), Q=(9, 0))},
        joints={"P": joint("x", "y"), "Q": joint("x", "y")},
    )
    with pytest.raises(CaseError, match=r"links\.x: no chain of joints connects it to the ground link 'ground'"):
        Linkage(links, joints)


def test_links_without_length() -> None:
    linkage = Linkage(
        {"0": link(ground=True, A=(0, 0), B=(0, 0)), "1": link(A=(0, 0), B=(0, 0))},
        {"A": joint("0", "1"), "B": joint("0", "1")},
    )
    with pytest.raises(CaseError, match="coincide; give the links a length"):
        _ = linkage.longest


def test_a_moving_link_with_one_point_and_a_joint_of_three_links_are_refused() -> None:
    with pytest.raises(ValidationError, match="at least 2"):
        link(A=(0, 0))
    assert link(ground=True, A=(0, 0)).points == {"A": (0.0, 0.0)}  # one pin may be all that it holds
    with pytest.raises(ValidationError):
        Joint(links=("a", "b", "c"))  # type: ignore[arg-type]


def test_records_are_frozen() -> None:
    linkage = four_bar(40, 120, 80, 100)
    with pytest.raises(ValidationError, match="frozen"):
        linkage.links["crank"].ground = True
    with pytest.raises(AttributeError):
        linkage.joints = {}  # type: ignore[misc]
