"""Instant centres: where pins and lines of links have them, and the moment of a load about one as the drive's work."""

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.findings.of_motion import motion_findings
from alula.loads.case.case import Case
from alula.loads.states.case_motion import CaseMotion, solve_case_motion
from alula.loads.states.instant_centre import InstantCentre, instant_centre
from alula.loads.states.kinetostatics import relative_motion
from alula.reports.motion.centre import centre_section
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
    assert stable.endswith("and behind it from 25.000 deg on.")
    record = section.data["instant_centre"]
    assert (record["link"], record["against"]) == ("thigh", "shank")
    assert record["load_cases"]["late-stance"]["behind"][0][0] == pytest.approx(-25.0)
    [series] = section.series
    assert series.file == "instant-centre.csv"
    assert len(series.columns) == 5


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
