"""The linkage of a check, a motion and an envelope as the browser draws it: which poses, and what colours the links."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.verdict import Quantity, Subject, by_nearness, overall
from alula.fea.motion.along import spread_poses
from alula.fea.motion.envelope_result import EnvelopeResult, StressAlong
from alula.fea.outcomes.result import CheckResult
from alula.geometry.linkage.motion import Motion
from alula.geometry.linkage.placement import Placement
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.states.case_motion import CaseMotion
from alula.reports.sentences.verdicts import checks_of
from alula.reports.turnable.linkage import Along, Poses, Values, linkage_record
from alula.reports.words.numbers import band, fixed, number

Real = NDArray[np.float64]

LINKAGE = "linkage"
"""Name of the model of the linkage as a whole."""
CHECK_CAPTION = (
    "Each link has the colour of its largest stress over its strength, in the stated pose and under the load case that "
    "governs it; the last colour is the limit of the check, or all of the strength. In other poses the colours stay "
    "those of the stated one. Arrows are the stated forces, each in its direction."
)
ENVELOPE_CAPTION = (
    "Each link has the colours of its largest stress at the pose that is shown, in stretches along its axis. A link "
    "without colour is not loaded, or the pose was left out. Arrows are the stated forces, each in its direction."
)
MOTION_CAPTION = "Each pin has the colour of the force that it bears at the pose that is shown."
_SAME = 1e-9
"""Difference of two values of a coordinate, over its range, that rounding leaves."""


def check_linkage(result: CheckResult) -> dict[str, Any]:
    """Return the linkage of a check: in its pose, over its motion where it has one, by the use of its strength.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    dict
        As ``linkage_record``.
    """
    shares, texts = {}, {}
    for link in next(iter(result.load_cases.values())).links:
        worst = result.governing(link)
        found = worst.links[link]
        own = [check for check in worst.checks if check.subject == Subject.link(link)]
        verdict = overall(check.verdict for check in own)
        decisive = by_nearness(check for check in own if check.verdict is verdict)
        factor = found.safety_factor
        shares[link] = np.array([math.nan if factor.unknowable else 100.0 / factor.value if factor.value else math.inf])
        told = f"safety factor {band(factor)} under load case {worst.name}"
        texts[link] = told + (f"; checks of this link: {decisive[0].answer}" if own else "")
    limits = [check.limit for check in checks_of(result) if check.quantity is Quantity.SAFETY_FACTOR]
    values = Values(
        label="stress over strength",
        title="largest stress over strength, in the stated pose",
        unit="%",
        links=shares,
        pins={},
        texts=texts,
        top=100.0 / max(limits) if limits else 100.0,
    )
    poses = _of_check(result.case, result.pose, result.motion)
    return linkage_record(result.case, poses, [values])


def envelope_linkage(result: EnvelopeResult) -> dict[str, Any]:
    """Return the linkage of an envelope in motion, each link by its stress at the pose that is shown.

    Among the poses are those at which links have their largest stress. Along a link its colours are those of the
    variant that governs.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    dict
        As ``linkage_record``.
    """
    worst = {found.pose for link in result.links.values() for found in link.load_cases.values()}
    chosen = np.union1d(spread_poses(len(result.angles)), list(worst)).astype(int)
    measures = {link.measure for link in result.links.values()}
    what = f"{measures.pop()} stress" if len(measures) == 1 else "stress that decides"
    values, several = [], len(result.case.load_cases) > 1
    for name in result.case.load_cases:
        loaded = {link: found for link, found in result.links.items() if name in found.load_cases}
        texts = {}
        for link, found in loaded.items():
            least = found.load_cases[name]
            motion = result.moved.motion
            at = f"{motion.coordinate} = {fixed(math.degrees(float(result.angles[least.pose])), 1)} deg"
            if motion.instants is not None:
                at = motion.at_progress(float(motion.progress[least.pose]))
            texts[link] = (
                f"{found.measure} stress against a strength of {number(found.strength, 3)} MPa; least safety factor "
                f"{band(least.safety_factor)} at {at}"
            )
        values.append(
            Values(
                label=name if several else "stress",
                title=f"{what}, load case {name}" if several else what,
                unit="MPa",
                links={link: found.load_cases[name].value[chosen] for link, found in loaded.items()},
                pins={},
                texts=texts,
                along={
                    link: _along(along, chosen)
                    for link, found in loaded.items()
                    if (along := found.load_cases[name].along) is not None
                },
            )
        )
    return linkage_record(result.case, _of_motion(result.moved.motion, chosen), values)


def motion_linkage(result: CaseMotion) -> dict[str, Any]:
    """Return the linkage of a motion, each pin by the force that it bears at the pose that is shown.

    Parameters
    ----------
    result : CaseMotion

    Returns
    -------
    dict
        As ``linkage_record``.
    """
    chosen = spread_poses(len(result.motion.angles))
    values = [
        Values(
            label=f"joint force, {name}",
            title=f"joint force, load case {name}",
            unit="N",
            links={},
            pins={joint: np.linalg.norm(force[chosen], axis=1) for joint, force in solved.forces.items()},
            texts={},
        )
        for name, solved in result.forces.items()
    ]
    return linkage_record(result.case, _of_motion(result.motion, chosen), values)


def _along(found: StressAlong, chosen: NDArray[np.int64]) -> Along:
    """Return the stress along a link at some poses; at one between those that are known, that of the nearest."""
    nearest = np.abs(chosen[:, None] - found.poses).argmin(axis=1)
    return Along(first=found.first, last=found.last, values=found.stress[nearest])


def _of_motion(motion: Motion, chosen: NDArray[np.int64]) -> Poses:
    """Return some poses of a motion."""
    return Poses(
        place=Placement(closure=motion.closure, q=motion.q[chosen]),
        texts=_texts(motion, motion.angles[chosen])
        if motion.instants is None
        else [motion.at_progress(float(percent)) for percent in motion.progress[chosen]],
        returns=motion.returns,
    )


def _texts(motion: Motion, values: Real) -> list[str]:
    return [f"{motion.coordinate} at {fixed(float(told), 1)} {motion.unit}" for told in motion.told(values)]


def _of_check(case: Case, pose: Pose, motion: Motion | None) -> Poses:
    """Return the stated pose and those of the motion; the stated one alone where the linkage does not get along it.

    The stated pose stands in its place among the others, or before them where the motion does not come by it.
    """
    stated = "the stated pose" if not case.pose.equilibrium else "the pose in balance"
    if motion is None:
        return Poses(place=Placement(closure=pose.closure, q=pose.q[None]), texts=[stated])
    values = motion.angles[spread_poses(len(motion.angles))]
    start, end = float(values[0]), float(values[-1])
    held = float(pose.q[motion.coordinate.column(pose.closure)])
    if not motion.coordinate.slides:
        held += 2.0 * math.pi * round(((start + end) / 2.0 - held) / (2.0 * math.pi))
    slack = _SAME * abs(end - start)
    inside = min(start, end) - slack <= held <= max(start, end) + slack
    if inside:
        values = values[np.abs(values - held) > slack]
        first = int(np.searchsorted(np.sign(end - start) * values, np.sign(end - start) * held))
        values = np.insert(values, first, held)
        texts = _texts(motion, values)
    else:
        first, texts = 0, ["", *_texts(motion, values)]
    q = motion.track.at(values) if inside else np.vstack([pose.q[None], motion.track.at(values)])
    texts[first] = f"{texts[first]} ({stated})" if inside else stated
    return Poses(
        place=Placement(closure=pose.closure, q=q),
        texts=texts,
        first=first,
        start=0 if inside else 1,
        returns=motion.returns,
    )
