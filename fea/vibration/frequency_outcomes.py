"""Whether natural frequencies stay well above that of the drive: outcomes of the linkage and of links by themselves."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.verdict import LINKAGE, CheckOutcome, Quantity, Subject, Verdict
from alula.fea.vibration.harmonics import HIGHEST, Meeting, banded, hertz, in_words, meetings, ordinal, stated
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
    if not any(isinstance(check, FrequencyCheck) for check in case.checks.values()):
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
    for name, check in case.checks.items():
        if not isinstance(check, FrequencyCheck):
            continue
        for load_case, history in found.histories.items():
            yield _linkage(case, name, check, load_case, history)
        for link in check.links or case.checked_links:
            for load_case, modes in _by_itself(found, link):
                yield _link(case, name, check, load_case, modes, found.histories[load_case].driving)


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


def _linkage(case: Case, name: str, check: FrequencyCheck, load_case: str, history: FrequencyHistory) -> CheckOutcome:
    ratio = least_frequency(history).times(1.0 / history.driving)
    reason = f"{lowest_sentence(case, history)}; {harmonic_sentence(case, history)}{running_clause(case, None)}"
    return CheckOutcome.of(name, LINKAGE, load_case, Quantity.FREQUENCY_RATIO, ratio, check.minimum, reason)


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


def running_clause(case: Case, link: str | None) -> str:
    """Say in which joints the low end of a frequency has hinges, since nothing states that their pins are tight.

    Parameters
    ----------
    case : Case
    link : str or None
        By itself; None for the linkage.

    Returns
    -------
    str
        After a semicolon; "" where all pins between layers are stated to be tight.
    """
    joints = dict.fromkeys(name for name, _ in running_holes(case) if link in (None, *case.joints[name].links))
    if not joints:
        return ""
    return (
        f"; the low end has hinges in holes at {', '.join(joints)}, where pins may run: nothing states that they are "
        "tight in both links (tight_in, or bonded)"
    )


def _link(case: Case, name: str, check: FrequencyCheck, load_case: str, own: LinkModes, driving: float) -> CheckOutcome:
    link, mode = own.link, own.modes[0]
    reason = (
        f"by itself, {own.held}, {link} vibrates at {hertz(mode.frequency)}, {in_words(mode.in_plane)}; "
        f"the drive turns at {stated(driving)} Hz{running_clause(case, link)}"
    )
    ratio = mode.frequency.times(1.0 / driving)
    return CheckOutcome.of(name, Subject.link(link), load_case, Quantity.FREQUENCY_RATIO, ratio, check.minimum, reason)


def lowest_sentence(case: Case, history: FrequencyHistory) -> str:
    """Say where the lowest natural frequency is least, how large it is, and in which shape.

    Parameters
    ----------
    case : Case
    history : FrequencyHistory

    Returns
    -------
    str
    """
    mode = history.lowest.modes[0]
    frequency = least_frequency(history)
    text = f"the lowest natural frequency is {hertz(frequency)}{where(case, history)}, {in_words(mode.in_plane)}"
    if frequency.value == 0.0:
        return f"{text}: under its loads the linkage does not swing but departs"
    if moved := most_moved(history.lowest, mode):
        text += f", where {moved} moves most"
    if history.driving > 0.0:
        ratio = frequency.times(1.0 / history.driving)
        text += f"; over the driving frequency of {stated(history.driving)} Hz that is {banded(ratio)}"
    return text


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


def harmonic_sentence(case: Case, history: FrequencyHistory) -> str:
    """Say which harmonic of the drive meets a natural frequency first and where, or comes nearest to one.

    Parameters
    ----------
    case : Case
    history : FrequencyHistory
        Driven.

    Returns
    -------
    str
    """
    met = meetings(history)
    if met:
        first = met[0]
        if (history.low[:, first.mode - 1] <= 0.0).all():
            last = max(one.harmonic for one in met if one.mode == first.mode)
            up_to = f"harmonics up to the {ordinal(last)}, {stated(last * history.driving)} Hz, may meet"
            return f"{up_to} the {ordinal(first.mode)} natural frequency, since its band goes down to 0"
        return f"the {ordinal(first.harmonic)} harmonic, {stated(first.frequency)} Hz, {_meets(case, history, first)}"
    if not np.isfinite(history.high[:, 0]).all():
        return "which harmonics meet a natural frequency is not known, since the lowest one has no band"
    known = np.isfinite(history.high).all(axis=0)
    driving, low, high = history.driving, history.low[:, known], history.high[:, known]
    if float(low.min()) > HIGHEST * driving:
        return f"all harmonics up to the {ordinal(HIGHEST)}, {stated(HIGHEST * driving)} Hz, stay below it"
    apart = {n: np.maximum(low / (n * driving), n * driving / np.maximum(high, 1e-12)) for n in range(1, HIGHEST + 1)}
    nearest = first_least([float(ratio.min()) for ratio in apart.values()]) + 1
    i, k = np.unravel_index(first_least(np.ravel(apart[nearest])), low.shape)
    return (
        f"no harmonic up to the {ordinal(HIGHEST)} meets a natural frequency; the {ordinal(nearest)}, "
        f"{stated(nearest * driving)} Hz, comes nearest to the {ordinal(int(np.flatnonzero(known)[k]) + 1)} one"
        f"{at_value(case, float(history.at[i]))}"
    )


def _meets(case: Case, history: FrequencyHistory, met: Meeting) -> str:
    first, last = sorted(told(case, end) for end in met.ranges[0])
    if case.motion is None:
        place = " in the stated pose"
    elif met.ranges[0] == (history.at[0], history.at[-1]):
        place = " in every pose"
    elif last - first < 0.5:
        place = f" at {case.motion_coordinate} = {(first + last) / 2.0:.1f} {unit(case)}"
    else:
        place = f" from {case.motion_coordinate} = {first:.0f} to {last:.0f} {unit(case)}"
    more = " and elsewhere" if len(met.ranges) > 1 else ""
    return f"meets the {ordinal(met.mode)} natural frequency{place}{more}"


def where(case: Case, history: FrequencyHistory) -> str:
    """Say in which pose the lowest natural frequency is least, with a blank before it.

    Parameters
    ----------
    case : Case
    history : FrequencyHistory

    Returns
    -------
    str
    """
    return at_value(case, least_at(history))


def at_value(case: Case, value: float) -> str:
    """Return `` at crank = 85.0 deg``.

    Parameters
    ----------
    case : Case
    value : float
        Of the coordinate [rad, mm].

    Returns
    -------
    str
    """
    if case.motion is None:
        return " in the stated pose"
    return f" at {case.motion_coordinate} = {told(case, value):.1f} {unit(case)}"


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
