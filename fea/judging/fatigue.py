"""Fatigue of links: under the load of a pose that comes and goes, and the outcome of either that or of a motion.

In a pose all stress goes with the load, so that one cycle at every place stands for all: from nothing to its stress and
back, or to its opposite. Of a solid it is that of its worst node, pulled or pressed. By hand the place is not known, so
that the largest stress counts as if it pulled; the band goes down to what bending and axial force leave of it in
tension, and to the least share of a hole's peak that may count.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from alula.fea.asked.asked import Asked, asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import fatigue_scatter
from alula.fea.common.source import distinct
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.judging.bearing import contact_pressure
from alula.fea.outcomes.fatigue import (
    LIFE_FACTOR,
    NOTCH,
    STRESS_FACTOR,
    Lasting,
    LinkFatigue,
    fatigue_life,
    missing_data,
    notch_factors,
    signed_stress,
)
from alula.fea.outcomes.limits import layers_of
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.geometry.materials.material import Fatigue
from alula.loads.case.case import Case
from alula.loads.records.check_spec import FatigueCheck

BEYOND_CARD = reason("repetitions_beyond_card")
Ends = tuple[float, float, float]
"""Value, low and high end of a stress [MPa]."""


def asked_fatigue(case: Case, link: str) -> list[Asked]:
    """Return what is asked of a link's fatigue, else what nobody has to ask for over a motion, with default limits.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    list of Asked
    """
    return [*asked(case, FatigueCheck, subject=Subject.link(link))] or unasked(link)


def unasked(link: str, name: str = "fatigue") -> list[Asked]:
    """Return what nobody has to ask for over a motion: factors on stress and on life, with default limits.

    Parameters
    ----------
    link : str
    name : str, optional
        Of the check.

    Returns
    -------
    list of Asked
    """
    limits = {Quantity.FATIGUE_STRESS: STRESS_FACTOR, Quantity.FATIGUE_LIFE: LIFE_FACTOR}
    return [Asked(name=name, subject=Subject.link(link), quantity=what, limit=x) for what, x in limits.items()]


def fatigue_outcomes(every: Sequence[Asked], load_case: str, found: Lasting, data: Fatigue) -> Iterator[CheckOutcome]:
    """Yield the outcomes of fatigue: on stress, and on life where that is asked and the card has an exponent.

    Parameters
    ----------
    every : sequence of Asked
    load_case : str
        Its name.
    found : Lasting
    data : Fatigue
        Of the material's card.

    Yields
    ------
    CheckOutcome
    """
    lives = found.repetitions
    for one in every:
        if one.quantity is Quantity.FATIGUE_LIFE:
            if lives is not None:
                yield one.outcome(load_case, lives.times(1.0 / found.wanted))
        elif found.strength is None:
            why = reason("card_ends_before", cycles=data.cycles, wanted=found.wanted)
            yield one.outcome(load_case, Band.unknown(BEYOND_CARD), why)
        else:
            outcome = one.outcome(load_case, fatigue_scatter(data).on(found.stress.inverse(found.strength)))
            if one.check is not None and lives is not None:
                lasts = reason("lasts", low=lives.low, high=lives.high, wanted=found.wanted, why=outcome.reason)
                outcome = outcome.because(lasts)
            yield outcome


def link_fatigue_outcomes(case: Case, link: str, load_case: str, found: LinkFatigue) -> Iterator[CheckOutcome]:
    """Yield the outcomes of a link's fatigue; none passes whose stress is beyond its static strength, hence not linear.

    Parameters
    ----------
    case : Case
    link, load_case : str
    found : LinkFatigue

    Yields
    ------
    CheckOutcome
    """
    material = case.material_of(link)
    assert material.fatigue is not None
    largest = max(found.life.largest, -found.life.smallest)
    if found.life.stress > 0.0:
        largest *= found.stress.high / found.life.stress
    for outcome in fatigue_outcomes(asked_fatigue(case, link), load_case, found, material.fatigue):
        if outcome.verdict is Verdict.PASS and largest > material.allowable:
            outcome = outcome.left_open(reason("yields_in_cycle", stress=largest, strength=material.allowable))
        yield outcome


def pulsating(case: Case, link: str, result: LinkResult) -> LinkFatigue | Reason:
    """Return the fatigue of a link whose load comes and goes as often as the conditions say.

    Parameters
    ----------
    case : Case
    link : str
    result : LinkResult
        Under that load.

    Returns
    -------
    LinkFatigue or Reason
        Why it is not known, where it is not.
    """
    material = case.material_of(link)
    data, lacking = material.fatigue, missing_data(material)
    if lacking or data is None:
        return lacking or reason("no_fatigue_data")
    if result.decisive.unknowable:
        return reason("peak_not_known")
    extremes, location, notched = (_of_solid if isinstance(result, SolidResult) else _by_hand)(case, result, data)
    back = 1.0 if case.conditions.reverses else 0.0
    lives = [[fatigue_life(np.array([0.0 - back * end, end]), material) for end in ends] for ends in extremes]
    worst = max(range(len(lives)), key=lambda i: lives[i][0].stress)
    ends = [max(own, key=lambda life: life.stress) for own in zip(*lives, strict=True)]
    return LinkFatigue.of(
        ends,
        lives[worst][0],
        np.array([0.0 - back * extremes[worst][0], extremes[worst][0]]),
        location[worst],
        distinct(result.decisive.sources, (NOTCH,) if notched else ()),
        material=material,
        repetitions=case.conditions.cycles,
        without=result.decisive.without,
    )


def _of_solid(case: Case, result: LinkResult, data: Fatigue) -> tuple[list[Ends], list[np.ndarray], bool]:
    """Return the largest pull and push of all nodes, each with its ends and its place, and whether a notch counts."""
    assert isinstance(result, SolidResult)
    band, nodes = result.decisive, result.solution.space.nodes
    least, most = notch_factors(case.body(result.link), nodes, data)
    signed = most * signed_stress(result.stress.nodal, brittle=result.brittle)
    low, high = (end / band.value if band.value > 0.0 else 1.0 for end in (band.low, band.high))
    found, places, notched = list[Ends](), [], False
    for node in {int(np.argmax(signed)), int(np.argmin(signed))}:
        stress, share = float(signed[node]), float(least[node] / most[node])
        found.append((stress, low * share * stress, high * stress))
        places.append(nodes[node].copy())
        notched = notched or share < 1.0
    return found, places, notched


def _by_hand(case: Case, result: LinkResult, data: Fatigue) -> tuple[list[Ends], list[np.ndarray], bool]:
    """Return the largest pull and push that may be, as ``_of_solid``."""
    pins, beam = case.body(result.link).pins, result.beam
    walls = np.array([(pin.x + pin.diameter / 2.0, pin.y, 0.0) for pin in pins]).reshape(-1, 3)
    least = float(notch_factors(case.body(result.link), walls, data)[0].min(initial=1.0))
    most = float((np.abs(beam.axial) + beam.bending).max(initial=0.0))
    pulled = float(np.maximum(beam.axial + beam.bending, 0.0).max(initial=0.0)) / most if most > 0.0 else 1.0
    pull, push = result.decisive, result.von_mises_max
    ends = [
        (pull.value, pulled * least * pull.low, pull.high),
        (-push.value, -least * push.low, -push.high),
    ]
    return ends, [result.location, result.location], least < 1.0


def pose_outcomes(
    case: Case,
    load_case: str,
    links: Mapping[str, LinkResult],
    found: Mapping[str, LinkFatigue | Reason],
    acting: Callable[[str], bool],
    forces: Mapping[str, float],
) -> Iterator[CheckOutcome]:
    """Yield the outcome of every check of fatigue in a pose.

    Where a pin in a loose hole presses harder in the middle of its contact than what is borne so often, that is told:
    peaks of stress leave it out, and S-N lines are not of wear.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    links : mapping of str to LinkResult
    found : mapping of str to (LinkFatigue or Reason)
        As ``pulsating`` returns it, by link.
    acting : callable
        Whether anything acts on a link.
    forces : mapping of str to float
        Of the joints, with all that scatters [N].

    Yields
    ------
    CheckOutcome
    """
    for link, fatigue in found.items():
        own = asked_fatigue(case, link)
        if not acting(link):
            endless = Band(value=math.inf, low=math.inf, high=math.inf)
            yield from (one.outcome(load_case, endless, reason("idle_link")) for one in own)
        elif not isinstance(fatigue, LinkFatigue):
            yield from (one.outcome(load_case, Band.unknown(fatigue), fatigue) for one in own)
        else:
            for outcome in link_fatigue_outcomes(case, link, load_case, fatigue):
                if not links[link].decided_by and outcome.verdict is not Verdict.UNDECIDED:
                    outcome = outcome.left_open(links[link].why)
                elif outcome.verdict is Verdict.PASS and layers_of(case, link) is not None:
                    outcome = outcome.left_open(reason("layers_fatigue_over_motion"))
                pressed = _pressed(case, link, forces, fatigue.strength or math.inf)
                yield outcome.because(together(outcome.reason, pressed)) if pressed else outcome


def _pressed(case: Case, link: str, forces: Mapping[str, float], strength: float) -> Reason | None:
    """Return the pin that presses hardest on an eye of a link, where that is more than a strength [MPa]."""
    own = [joint for joint in case.bearing_joints if link in case.joints[joint].links]
    found = {joint: contact_pressure(case, joint, link, forces[joint]) for joint in own}
    joint, most = max(((x, p[1]) for x, p in found.items() if p), key=lambda of: of[1], default=("", 0.0))
    return reason("pin_presses_beside", joint=joint, pressure=most) if most > strength else None
