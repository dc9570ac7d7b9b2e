"""Whether natural frequencies stay well above that of the drive: outcomes of the linkage and of links by themselves."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from alula.fea.asked.asked import asked, asks
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Verdict
from alula.fea.vibration.harmonics import HIGHEST, Meeting, meetings
from alula.fea.vibration.link_modes import LinkModes, link_modes
from alula.fea.vibration.linkage_modes import LinkageModes
from alula.fea.vibration.modes import Mode
from alula.fea.vibration.over_motion import CaseFrequencies, FrequencyHistory, case_frequencies, lowest_pose
from alula.fea.vibration.running_holes import running_holes
from alula.geometry.base.ties import first_least
from alula.loads.case.case import Case
from alula.loads.records.check_spec import FrequencyCheck

POSES = 13
"""Over the motion, of which the least frequency is sought in between: every 30 degrees of a turn."""


def asked_frequencies(case: Case, *, solids: bool = False, threads: int = 2) -> CaseFrequencies | None:
    """Return the natural frequencies under the load cases with a speed, where a check asks for them.

    Parameters
    ----------
    case : Case
    solids : bool, optional
        True where solids may decide on links by themselves that their beams leave open.
    threads : int, optional
        Of each library.

    Returns
    -------
    CaseFrequencies or None
    """
    if not asks(case, FrequencyCheck):
        return None
    driven = {name: load_case for name, load_case in case.load_cases.items() if load_case.speed != 0.0}
    found = case_frequencies(case.model_copy(update={"load_cases": driven}), poses=POSES, threads=threads)
    if not solids:
        return found
    outcomes = [one for one in frequency_outcomes(found) if one.verdict is Verdict.UNDECIDED]
    left = dict.fromkeys(one.subject.name for one in outcomes if one.subject.kind == "link")
    closer = {link: link_modes(found.case, link, solid=True, threads=threads) for link in left}
    return replace(found, links={**found.links, **closer})


def frequency_outcomes(found: CaseFrequencies | None) -> Iterator[CheckOutcome]:
    """Yield the outcomes of every check of frequencies.

    Parameters
    ----------
    found : CaseFrequencies or None
        Of load cases with a speed.

    Yields
    ------
    CheckOutcome
        The linkage under every load case; links by themselves under the fastest, with and without what they carry.
    """
    if found is None:
        return
    case = found.case
    for one in asked(case, FrequencyCheck):
        if one.subject == LINKAGE:
            for load_case, history in found.histories.items():
                yield one.outcome(load_case, *_of_linkage(case, history))
        else:
            for load_case, modes in _by_itself(found, one.subject.name):
                yield one.outcome(load_case, *_of_link(case, modes, found.histories[load_case].driving))


def deciding_load_case(found: CaseFrequencies) -> str:
    """Return the load case whose lowest natural frequency is nearest to its driving frequency, or the lowest of all.

    Parameters
    ----------
    found : CaseFrequencies

    Returns
    -------
    str
    """
    cases, every = found.case.load_cases, found.histories
    turning = {name: one for name, one in every.items() if cases[name].speed != 0.0}
    driven = turning or {name: one for name, one in every.items() if one.driving > 0.0} or every
    bands = [least_frequency(one).times(1.0 / (one.driving or 1.0)) for one in driven.values()]
    return list(driven)[lowest_pose(np.array([band.low for band in bands]), np.array([band.value for band in bands]))]


def least_frequency(history: FrequencyHistory) -> Band:
    """Return the lowest natural frequency over a motion.

    Parameters
    ----------
    history : FrequencyHistory

    Returns
    -------
    Band
        [Hz]
    """
    value, low, high = (float(curve[:, 0].min()) for curve in (history.frequencies, history.low, history.high))
    return replace(history.lowest.modes[0].frequency, value=value, low=low, high=high)


def least_at(history: FrequencyHistory) -> float:
    """Return where the lowest natural frequency is least: the first of the poses that differ by rounding alone.

    Parameters
    ----------
    history : FrequencyHistory

    Returns
    -------
    float
        Value of the coordinate [rad, mm].
    """
    return float(history.at[lowest_pose(history.low[:, 0], history.frequencies[:, 0])])


def _of_linkage(case: Case, history: FrequencyHistory) -> tuple[Band, Reason]:
    ratio = least_frequency(history).times(1.0 / history.driving)
    why = reason(
        "frequency_of_linkage",
        lowest=lowest_frequency(case, history),
        harmonic=nearest_or_met(case, history),
        hinged=_hinged(case, None),
    )
    return ratio, why


def _by_itself(found: CaseFrequencies, link: str) -> Iterator[tuple[str, LinkModes]]:
    """Yield the load cases that decide on a link, the fastest with what it carries and without, and its modes then."""
    case, own = found.case, found.links[link]
    bears = any(one.link == link for one in case.carried)
    for carried in (True, False) if bears else (None,):
        names = [name for name in found.histories if carried in (None, case.load_cases[name].carried)]
        if names:
            fastest = max(names, key=lambda name: found.histories[name].driving)
            bare = carried is False
            yield fastest, link_modes(case, link, count=1, solid=own.model == "solid", carried=False) if bare else own


def _hinged(case: Case, link: str | None) -> tuple[str, ...]:
    """Joints in which the low end of a frequency of the linkage, or of a link by itself, has hinges."""
    return tuple(dict.fromkeys(name for name, _ in running_holes(case) if link in (None, *case.joints[name].links)))


def _of_link(case: Case, own: LinkModes, driving: float) -> tuple[Band, Reason]:
    link, mode = own.link, own.modes[0]
    why = reason(
        "frequency_of_link",
        link=link,
        held=own.held,
        frequency=mode.frequency,
        in_plane=mode.in_plane,
        driving=driving,
        hinged=_hinged(case, link),
    )
    return mode.frequency.times(1.0 / driving), why


def lowest_frequency(case: Case, history: FrequencyHistory) -> Reason:
    """Tell where the lowest natural frequency is least, how large it is, and in which shape.

    Parameters
    ----------
    case : Case
    history : FrequencyHistory

    Returns
    -------
    Reason
    """
    mode = history.lowest.modes[0]
    frequency = least_frequency(history)
    return reason(
        "lowest_frequency_departs" if frequency.value == 0.0 else "lowest_frequency",
        frequency=frequency,
        at=_at_value(case, least_at(history)),
        in_plane=mode.in_plane,
        link=most_moved(history.lowest, mode),
        driving=history.driving,
        ratio=frequency.times(1.0 / history.driving) if history.driving > 0.0 else None,
    )


def most_moved(found: LinkageModes, mode: Mode) -> str:
    """Return the link that moves furthest in a shape; "" where no beam stands for any.

    Parameters
    ----------
    found : LinkageModes
    mode : Mode
        One of its modes.

    Returns
    -------
    str
    """
    sizes = np.linalg.norm(mode.shape[:, :3], axis=1)
    far: dict[str, float] = {}
    for node, link in _links_of_nodes(found).items():
        far[link] = max(far.get(link, 0.0), float(sizes[node]))
    return max(far, key=lambda link: far[link], default="")


def _links_of_nodes(found: LinkageModes) -> dict[int, str]:
    """Return the links of nodes: of those of the frame by its beams, of those that divide one by their neighbours."""
    frame, own = found.frame, dict[int, str]()
    for i, beam in frame.beams.items():
        own |= dict.fromkeys(frame.model.elements[i].nodes, beam.link)
    left = [element.nodes for element in found.model.elements]
    while left:
        known = [pair for pair in left if pair[0] in own or pair[1] in own]
        if not known:
            return own
        left = [pair for pair in left if pair not in known]
        for first, last in known:
            own.setdefault(last, own.get(first, ""))
            own.setdefault(first, own[last])
    return own


def nearest_or_met(case: Case, history: FrequencyHistory) -> Reason:
    """Tell which harmonic of the drive meets a natural frequency first and where, or comes nearest to one.

    Parameters
    ----------
    case : Case
    history : FrequencyHistory
        Driven.

    Returns
    -------
    Reason
    """
    met = meetings(history)
    if met:
        first = met[0]
        if (history.low[:, first.mode - 1] <= 0.0).all():
            last = max(one.harmonic for one in met if one.mode == first.mode)
            return reason("harmonics_may_meet", last=last, frequency=last * history.driving, mode=first.mode)
        return reason(
            "harmonic_meets",
            harmonic=first.harmonic,
            frequency=first.frequency,
            mode=first.mode,
            at=_meets_at(case, history, first),
            elsewhere=len(first.ranges) > 1,
        )
    if not np.isfinite(history.high[:, 0]).all():
        return reason("harmonics_not_known")
    known = np.isfinite(history.high).all(axis=0)
    driving, low, high = history.driving, history.low[:, known], history.high[:, known]
    if float(low.min()) > HIGHEST * driving:
        return reason("all_harmonics_below", highest=HIGHEST, frequency=HIGHEST * driving)
    apart = {n: np.maximum(low / (n * driving), n * driving / np.maximum(high, 1e-12)) for n in range(1, HIGHEST + 1)}
    nearest = first_least([float(ratio.min()) for ratio in apart.values()]) + 1
    i, k = np.unravel_index(first_least(np.ravel(apart[nearest])), low.shape)
    return reason(
        "nearest_harmonic",
        highest=HIGHEST,
        harmonic=nearest,
        frequency=nearest * driving,
        mode=int(np.flatnonzero(known)[k]) + 1,
        at=_at_value(case, float(history.at[i])),
    )


def _meets_at(case: Case, history: FrequencyHistory, met: Meeting) -> Reason:
    first, last = sorted(told(case, end) for end in met.ranges[0])
    if case.motion is None:
        return reason("in_stated_pose")
    if met.ranges[0] == (history.at[0], history.at[-1]):
        return reason("in_every_pose")
    if last - first < 0.5:
        return reason("at_value", coordinate=case.motion_coordinate.name, value=(first + last) / 2.0, unit=unit(case))
    return reason(
        "from_value_to_value", coordinate=case.motion_coordinate.name, first=first, last=last, unit=unit(case)
    )


def _at_value(case: Case, value: float) -> Reason:
    """Where a value of the coordinate is [rad, mm]."""
    if case.motion is None:
        return reason("in_stated_pose")
    return reason("at_value", coordinate=case.motion_coordinate.name, value=told(case, value), unit=unit(case))


def told(case: Case, value: float) -> float:
    """Return a value of the motion's coordinate as people read it.

    Parameters
    ----------
    case : Case
    value : float
        [rad, mm]

    Returns
    -------
    float
        [deg, mm]
    """
    return value if unit(case) == "mm" else math.degrees(value)


def unit(case: Case) -> str:
    """Return the unit in which people read the motion's coordinate.

    Parameters
    ----------
    case : Case

    Returns
    -------
    {"deg", "mm"}
    """
    travels = case.pose.travel if case.motion is None else case.motion.travel
    return "deg" if travels is None else "mm"
