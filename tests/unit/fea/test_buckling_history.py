"""Buckling factors of links over a motion, against the check of single poses."""

import tomllib
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import PLANAR, edited
from rocker_case import TOML

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import BeamCheck, check_beam, internal_forces
from alula.fea.buckling.buckling import ColumnFactors, column, worst_column
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import air_source
from alula.fea.common.verdict import CheckOutcome
from alula.fea.motion import envelope_outcomes
from alula.fea.motion.buckling_history import axial_compression, factors_over_motion
from alula.fea.motion.link_history import link_histories
from alula.geometry.bodies.body import hand_section
from alula.geometry.linkage.coordinate import Coordinate
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.applied import LineLoad
from alula.loads.states.case_motion import CaseMotion, solve_case_motion
from alula.reports.sentences import told

CASES = [
    ("owl-wing-static", [PLANAR, "motion.poses=7", 'motion.range=["228.15 deg", "200 deg"]']),
    ("ornithopter", [PLANAR, "motion.poses=7"]),
    ("flapping-wing-chosen", [PLANAR, "motion.poses=7"]),
]


def at_pose(case: Case, link: str, history: LinkLoads, pose: int) -> BeamCheck:
    material = case.material_of(link)
    loads = beam_loads(history.chosen(pose), case.body(link), material.density)
    return check_beam(loads, hand_section(case.body(link)), material.allowable)


@pytest.mark.parametrize(("name", "overrides"), CASES)
def test_every_pose_has_the_factor_of_its_own_beam(name: str, overrides: list[str]) -> None:
    case = edited(name, overrides, fits=False)
    moved = solve_case_motion(case)
    compared = 0
    for link in case.checked_links:
        for history in link_histories(moved, link):
            found = factors_over_motion(case, link, history)
            for pose in np.flatnonzero(np.isfinite(found.value)):
                beam = at_pose(case, link, history, int(pose))
                expected = column(case, link, beam)
                assert expected is not None
                for name in ("value", "least", "most"):
                    single = getattr(expected, name)
                    assert getattr(found, name)[pose] == pytest.approx(single, rel=1e-5), name
                compared += 1
            for pose in np.flatnonzero(np.isinf(found.value)):
                assert column(case, link, at_pose(case, link, history, int(pose))) is None
    assert compared > 10


def test_compression_is_that_of_the_internal_forces() -> None:
    """The largest within an interval, where turning mass makes the force a parabola."""
    case = edited("ornithopter", [PLANAR, "motion.poses=5"], fits=False)
    moved = solve_case_motion(case)
    histories = link_histories(moved, "rod")
    assert [history.name for history in histories] == list(case.load_cases)
    for history in histories:
        compression, along = axial_compression(case, "rod", history)
        start, end = along.breaks[[0, -1]]
        inside = np.linspace(start + 1e-6, end - 1e-6, 400)
        for pose in range(history.poses):
            forces = internal_forces(
                beam_loads(history.chosen(pose), case.body("rod"), case.material_of("rod").density)
            )
            sampled = max(-forces.at(float(x))[0] for x in inside)
            at = np.array([start + 1e-3, (2.0 * start + end) / 3.0, end - 1e-3])
            expected = [-forces.at(float(x))[0] for x in at]
            assert along.at(at)[:, pose] == pytest.approx(expected, abs=1e-9 * np.abs(along.values).max())
            assert compression[pose] == pytest.approx(max(sampled, 0.0), rel=1e-3, abs=1e-9 * np.abs(compression).max())


POSES = np.ones(4, dtype=bool)
FACTORS = ColumnFactors(
    value=np.array([8.0, 5.0, 7.0, 2.0]),
    least=np.array([4.5, 4.0, 3.0, 1.0]),
    most=np.array([9.0, 12.0, 14.0, 3.0]),
)


@pytest.mark.parametrize("order", [[0, 1, 2, 3], [2, 0, 1, 3]])
def test_of_the_poses_that_count_the_column_has_the_least_of_each_factor(order: list[int]) -> None:
    """Value, least and most are least in three different poses; it stands in that of the least value."""
    case, counted = read_case("owl-wing-static", [PLANAR]), np.arange(4) < 3
    factors = ColumnFactors(**{name: getattr(FACTORS, name)[order] for name in ("value", "least", "most")})
    found = worst_column(case, "AE", 10.0 * np.array(order), factors, counted)
    assert found is not None
    assert (found.value, found.least, found.most) == (5.0, 3.0, 9.0)
    assert (order[found.pose], found.compression) == (1, 10.0)


@pytest.mark.parametrize("worse", [0, 1, 2])
def test_of_both_plates_and_all_poses_the_least_factor_is_told_where_it_is(
    monkeypatch: pytest.MonkeyPatch, worse: int
) -> None:
    """Three records of what acts on a link under one load case; poses that were left out leave it open."""
    case = read_case("owl-wing-static", [PLANAR])
    degrees = np.array([10.0, 20.0, 30.0, 40.0])
    motion = SimpleNamespace(coordinate=Coordinate("GF"), angles=np.radians(degrees), progress=degrees, instants=None)
    moved = SimpleNamespace(case=case, motion=motion)
    histories = [SimpleNamespace(name="weight", number=i) for i in range(3)]

    def factors(_: Case, __: str, history: SimpleNamespace) -> ColumnFactors:
        times = 20.0 if history.number == worse else 30.0
        return ColumnFactors(**{name: times * getattr(FACTORS, name) for name in ("value", "least", "most")})

    monkeypatch.setattr(envelope_outcomes, "factors_over_motion", factors)
    monkeypatch.setattr(envelope_outcomes, "axial_compression", lambda *_: (np.ones(4), None))
    monkeypatch.setattr(envelope_outcomes, "column_growth", lambda *_: Scatter())
    every, some = POSES, np.arange(4) < 3
    for counted, verdict, value, said in (
        (every, "pass", 40.0, "at GF = 40 deg"),
        (some, "undecided", 100.0, "were left out"),
    ):
        [found] = envelope_outcomes.column_outcomes(moved, {"AE": histories}, counted)
        assert (found.value.value, found.verdict.value) == (value, verdict)
        assert said in told(found.reason)


def test_compression_by_spread_loads_is_largest_between_stations() -> None:
    """3 - 0.1 x N/mm along 40 mm add up to 45 N at 30 mm, and to 40 N at half of the way and at its end."""
    case = validate(tomllib.loads(TOML))
    ends, total = [(3.0, -1.0), (-1.0, 3.0), (1.0, 1.0)], np.array([40.0, 40.0, 40.0])
    at = np.zeros((2, 3, 3))
    at[:, :, 0] = np.transpose(ends)
    wrenches = np.zeros((2, 3, 6))
    wrenches[1, :, 0] = -total
    pins = tuple(
        PinLoad(name=name, centre=np.array([x, 0.0, 0.0]), diameter=3.0, wrench=wrench)
        for name, x, wrench in zip(("O4", "B"), (0.0, 40.0), wrenches, strict=True)
    )
    line = LineLoad(link="rocker", start=0.0, end=40.0, at_start=at[0], at_end=at[1], axes="link")
    largest, _ = axial_compression(case, "rocker", LinkLoads(name="turn", pins=pins, lines=(line,)))
    assert largest == pytest.approx([45.0, 40.0, 40.0])


def test_a_link_that_is_pressed_in_other_air_alone_is_judged_as_a_column(monkeypatch: pytest.MonkeyPatch) -> None:
    """As stated it is pulled at all poses; in the other answer it is pressed as much."""

    def pushed(force: str) -> Case:
        return edited(
            "four-bar",
            [
                "checks={}",
                'load_cases={ lift={ forces=[{ link="rocker", at="B", axes="link", force='
                f'["{force}", "0 N"] }}] }} }}',
                "motion.poses=5",
            ],
        )

    pulled, pressed = (solve_case_motion(pushed(force)) for force in ("200 N", "-200 N"))
    every = np.ones(5, dtype=bool)

    def outcomes(moved: CaseMotion) -> list[CheckOutcome]:
        return list(envelope_outcomes.column_outcomes(moved, {"rocker": link_histories(moved, "rocker")}, every))

    assert outcomes(pulled) == []
    [itself] = outcomes(pressed)
    cause = Alternatives(source=air_source(1.0, 2.0), others=(pulled, pressed))
    monkeypatch.setattr(envelope_outcomes, "causes_over", lambda *_: [cause])
    [found] = outcomes(pulled)
    assert found.value.value == pytest.approx(itself.value.value)
    assert (found.value.low, found.value.high) == (pytest.approx(itself.value.low), np.inf)
