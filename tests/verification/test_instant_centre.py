"""Instant centres: where pins and lines of links have them, and the moment of a load about one as the drive's work."""

import cmath
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.findings.of_motion import motion_findings
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_text, validate
from alula.loads.states.case_motion import CaseMotion, solve_case_motion
from alula.loads.states.instant_centre import InstantCentre, instant_centre
from alula.loads.states.kinetostatics import relative_motion
from alula.reports.motion.centre import _stability, centre_section
from alula.reports.sections.section import Group, Text


def centre_of(case: Case) -> tuple[CaseMotion, InstantCentre]:
    moved = solve_case_motion(case)
    found = instant_centre(moved)
    assert found is not None
    return moved, found


@pytest.mark.parametrize("entries", [[], ["motion.range=['65 deg', '-25 deg']"]])
def test_the_moment_about_the_centre_is_the_work_of_the_drive(entries):
    """Drive torques come from equilibrium, the centre from velocities. Behind it the drive holds back."""
    moved, found = centre_of(edited("knee", entries))
    per_thigh = relative_motion(moved.motion, moved.drive) / moved.motion.virtual.spin("thigh")
    onward = np.sign(moved.motion.angles[-1] - moved.motion.angles[0])
    for name, line in found.lines.items():
        held = moved.torque[name] * per_thigh * onward
        assert 940.0 * line.ahead == pytest.approx(held, rel=1e-9, abs=1e-6)
    straight = int(np.argmin(moved.motion.angles))
    heel, late = (found.lines[name].ahead[straight] * onward for name in ("heel-strike", "late-stance"))
    assert heel > 0.0 > late


def test_it_is_where_the_lines_of_the_links_meet():
    moved, found = centre_of(edited("knee", []))
    (a, d), (b, c) = (
        (moved.motion.placement.position(link, one), moved.motion.placement.position(link, other))
        for link, one, other in (("front", "A", "D"), ("rear", "B", "C"))
    )
    for one, along in ((a, d - a), (b, c - b)):
        assert ((found.path - one) / along).imag == pytest.approx(0.0, abs=1e-9)
    start, to = 20.0 + 120.0j, -40.0 - 420.0j
    foot = (found.lines["heel-strike"].foot - start) / (to - start)
    assert foot.imag == pytest.approx(0.0, abs=1e-9)


def test_of_two_moving_links_it_is_their_pin_and_load_lines_run_past_that():
    moved, found = centre_of(edited("knee", ["motion.against='rear'"]))
    assert found.path == pytest.approx(moved.motion.placement.position("rear", "C"), abs=1e-9)
    assert found.lines["heel-strike"].ahead[0] > 0.0


PARALLEL = [
    "links.front.points.D=['90.805 mm', '0 mm']", "links.thigh.points.D=['63.5 mm', '0 mm']", "stops={}",
    "pose={ coordinate = 'rear', angle = '100 deg', near = { front = '100 deg', thigh = '0 deg' } }",
    "motion={ range = ['100 deg', '80 deg'], poses = 5, instant_centre = 'thigh' }",
]  # fmt: skip


def test_parallel_links_have_it_at_infinity():
    moved, found = centre_of(edited("knee", PARALLEL))
    assert np.isnan(found.path).all()
    assert np.isnan(found.lines["heel-strike"].ahead).all()
    assert np.isfinite(found.lines["heel-strike"].foot).all()
    section = centre_section(motion_findings(moved))
    told = [part.text for part in section.parts if isinstance(part, Text)]
    assert any("lies at infinity from rear = 100" in text for text in told)
    assert section.data["instant_centre"]["load_cases"]["heel-strike"]["ahead"]["first"] is None
    for part in section.parts:
        if draw := getattr(part, "draw", None):
            draw().png()


def test_a_couple_and_no_load_have_no_line():
    """Of three forces that balance but for their moment 0.1 + 0.2 - 0.3 is left, which is rounding."""
    moment = "moments = [{ link = 'thigh', at = 'K', moment = '5 N*m' }]"
    forces = (
        f"{{ link = 'thigh', at = '{at}', force = ['{x} N', '0 N'] }}"
        for at, x in zip("KCD", (0.1, 0.2, -0.3), strict=True)
    )
    acts = {"turn": moment, "three": f"forces = [{', '.join(forces)}]", "none": "forces = []"}
    cases = ", ".join(f"{name} = {{ own_weight = false, {what} }}" for name, what in acts.items())
    _, found = centre_of(edited("knee", [f"load_cases={{ {cases} }}"]))
    assert all(np.isnan(line.ahead).all() for line in found.lines.values())


def test_sentences_and_record():
    section = centre_section(motion_findings(solve_case_motion(edited("knee", []))))
    told = {part.title: part.parts[0].text for part in section.parts if isinstance(part, Group)}
    stable, falls = told["Load case heel-strike"], told["Load case late-stance"]
    assert stable.startswith("Stable: at thigh = −25.000 deg the load line runs 67.85 mm ahead of the instant centre")
    assert falls.startswith("Not stable: at thigh = −25.000 deg the load line runs 10.82 mm behind the instant centre")
    assert stable.endswith("and behind it from thigh = 25.000 deg to 65.000 deg.")
    record = section.data["instant_centre"]
    assert (record["link"], record["against"]) == ("thigh", "shank")
    assert record["load_cases"]["late-stance"]["behind"][0][0] == pytest.approx(-25.0)
    [series] = section.series
    assert series.file == "instant-centre.csv"
    assert len(series.columns) == 5


def test_all_stretches_on_the_other_side_are_told():
    """Ahead, behind, at infinity, ahead and behind again: from one pose to another, and at a single one."""
    motion = solve_case_motion(edited("knee", ['motion.range=["0 deg", "5 deg"]', "motion.poses=6"])).motion
    ahead = np.array([3.0, -1.0, -2.0, np.nan, 1.0, -1.0])
    told = _stability("the centre", motion, ahead).text
    assert told.endswith("and behind it from thigh = 1.0000 deg to 2.0000 deg and at thigh = 5.0000 deg.")
    told = _stability("the centre", motion, -ahead).text
    assert told.endswith("and ahead of it from thigh = 1.0000 deg to 2.0000 deg and at thigh = 5.0000 deg.")


FLEXION = np.array([5.0, 18.0, 8.0, 8.0, 50.0, 40.0])  # it turns back in rows 2 and 5, and dwells in 3 and 4
FORCE = np.array([400.0, 900.0, 700.0, 700.0, 100.0, 0.0])  # down [N]
MOMENT = np.array([30.0, 60.0, 50.0, 40.0, 9.0, 0.0])  # [N m]
STRIDE = {"file": "stride.csv", "angle": "flexion", "zero": "-25 deg"}


def stride(folder: Path, order: Any = range(6), sign: float = 1.0, **cycle: Any) -> tuple[CaseMotion, InstantCentre]:
    """Return the knee over a stride, its moment with one sign, with the other and left out; rows in any order."""
    rows = zip(range(0, 90, 15), *(values[list(order)] for values in (sign * FLEXION, FORCE, MOMENT)), strict=True)
    table = "\n".join(",".join(map(str, row)) for row in rows)
    (folder / "stride.csv").write_text("cycle [%],flexion [deg],Fy [N],M [N*m]\n" + table, encoding="utf-8")
    data = {key: value for key, value in tomllib.loads(read_text("knee")[0]).items() if key != "checks"}
    down = {"own_weight": False, "forces": [{"link": "thigh", "at": "K", "force": ["0 N", "-column Fy"]}]}
    turns = {name: [{"link": "thigh", "at": "K", "moment": f"{name}column M"}] for name in ("-", "")}
    cases = {"extends": down | {"moments": turns["-"]}, "flexes": down | {"moments": turns[""]}, "alone": down}
    stated = {"motion": {"instant_centre": "thigh"}, "cycle": STRIDE | cycle, "load_cases": cases}
    return centre_of(validate(data | stated, str(folder)))


def by_hand(degrees: float, force: float, moment: float) -> tuple[complex, float]:
    """Return where the lines of both links meet, and the lever of the load about it against flexion.

    The thigh's rear pin C lies where circles about B and about A, less the thigh, meet; the thigh's front pin D on it.
    """
    along = cmath.exp(1j * np.radians(degrees - 25.0))
    a, b = 31.75 + 0.0j, -31.75 + 0.0j
    apart = a - 25.4 * along - b
    x = (90.805**2 - 95.25**2 + abs(apart) ** 2) / (2.0 * abs(apart))
    c = b + apart / abs(apart) * (x + 1j * np.sqrt(90.805**2 - x**2))
    rear, front = c - b, c + 25.4 * along - a
    centre = b + rear * ((a - b).conjugate() * front).imag / (rear.conjugate() * front).imag
    arm = c + (10.0 + 30.0j) * along - centre
    return centre, -((arm.conjugate() * -1j * force).imag + 1e3 * moment) / force if force else np.nan


@pytest.mark.parametrize("period", [None, "1 s"])
def test_over_a_stride_the_centre_is_where_the_lines_meet(tmp_path, period):
    """Where the knee turns back and where it dwells as well; one load extends it at every row, the other bends it."""
    _, found = stride(tmp_path, **({} if period is None else {"period": period}))
    for name, sign in (("extends", -1.0), ("flexes", 1.0)):
        own = [by_hand(*row) for row in zip(FLEXION, FORCE, sign * MOMENT, strict=True)]
        assert found.path[:-1] == pytest.approx(np.array([centre for centre, _ in own]), abs=1e-9)
        ahead = found.lines[name].ahead
        assert ahead == pytest.approx(np.array([lever for _, lever in (*own, own[0])]), abs=1e-9, nan_ok=True)
        assert (np.sign(np.delete(ahead, 5)) == -sign).all()


def test_ahead_is_against_the_growing_column_whichever_row_comes_first(tmp_path):
    _, found = stride(tmp_path)
    _, later = stride(tmp_path, np.roll(np.arange(6), -4))
    _, back = stride(tmp_path, sign=-1.0, angle="-flexion")  # a column that grows as the knee extends
    for name, line in found.lines.items():
        assert later.lines[name].ahead[:-1] == pytest.approx(np.roll(line.ahead[:-1], -4), abs=1e-9, nan_ok=True)
        assert back.lines[name].ahead == pytest.approx(-line.ahead, abs=1e-9, nan_ok=True)


def test_a_held_knee_has_its_centre(tmp_path):
    _, found = stride(tmp_path, angle=None, zero=None)
    assert np.ptp(found.path) == 0.0
    assert found.path[0] == pytest.approx(by_hand(0.0, 1.0, 0.0)[0], abs=1e-6)


def test_the_report_of_a_stride_tells_sides_in_per_cent(tmp_path):
    moved, found = stride(tmp_path)
    section = centre_section(motion_findings(moved))
    told = {part.title: part.parts for part in section.parts if isinstance(part, Group)}
    what = "the instant centre of thigh against shank over the whole cycle while there is one."
    assert told["Load case extends"][0].text == f"The load line runs ahead of {what}"
    assert told["Load case flexes"][0].text == f"The load line runs behind {what}"
    alone = f"The load line runs behind {what.partition(' over')[0]} at 60.000 % of the cycle"
    assert told["Load case alone"][0].text == f"{alone}, ahead of it else while there is one."
    assert {column.unit for column in told["Load case alone"][1].columns} == {"", "%"}
    assert "against growing flexion" in section.parts[0].text
    record = section.data["instant_centre"]["load_cases"]["extends"]["ahead"]
    least = int(np.nanargmin(found.lines["extends"].ahead))
    assert record["smallest_at"] == moved.motion.progress[least]
    for part in section.parts:
        if draw := getattr(part, "draw", None):
            draw().png()


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ("motion.instant_centre='shank'", "motion.instant_centre"),
        ("motion.against='foot'", "is no link"),
        ("motion.against='thigh'", "does not turn against itself"),
    ],
)
def test_what_is_refused(entry, says):
    with pytest.raises(Exception, match=says):
        edited("knee", [entry])
