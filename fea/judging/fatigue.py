"""Fatigue of links: under the load of a pose that comes and goes, and the outcome of either that or of a motion.

In a pose all stress goes with the load, so that one cycle at every place stands for all: from nothing to its stress and
back, to its opposite, or to the share of it that the load case states; of a test of a level with several steps, the
cycles of each. Of a solid it is that of its worst node, pulled
or pressed. Where it has pins, the stress under an opposite load is not the opposite one, since they press on the other
side of their holes: the band goes down to the cycle from nothing, which is there in any case, and none passes. By hand
the place is not known, so that the largest stress counts as if it pulled; the band goes down to what bending and axial
force leave of it in tension, and to the least share of a hole's peak that may count.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from alula.fea.asked.asked import Asked, asked
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import Scatter, fatigue_scatter, load_scatter, strength_scatter
from alula.fea.common.source import distinct
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.judging.bearing import contact_pressure, in_own_eyes
from alula.fea.judging.loading import Judged, SolvedLinks
from alula.fea.outcomes.fatigue import (
    LIFE_FACTOR,
    NOTCH,
    STRESS_FACTOR,
    Lasting,
    LinkFatigue,
    borne_scatter,
    fatigue_life,
    missing_data,
    notch_factors,
    signed_stress,
)
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.fea.solid.stress import stress_field
from alula.geometry.materials.material import Fatigue
from alula.loads.case.case import Case
from alula.loads.records.check_spec import FatigueCheck

BEYOND_CARD = reason("repetitions_beyond_card")
Ends = tuple[float, float, float]
"""Value, low and high end of a stress [MPa]."""
Extremes = tuple[list[Ends], list[np.ndarray], list[float], bool]
"""The ends of the largest stresses, by places, the share of each that counts for a notch, and whether that is open."""


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


def fatigue_outcomes(
    every: Sequence[Asked], load_case: str, found: Lasting, data: Fatigue, scatter: Scatter | None = None
) -> Iterator[CheckOutcome]:
    """Yield the outcomes of fatigue: on stress, and on life where that is asked and the card has an exponent.

    Parameters
    ----------
    every : sequence of Asked
    load_case : str
        Its name.
    found : Lasting
    data : Fatigue
        Of the material's card.
    scatter : Scatter, optional
        Of the strength; by default that of ``data``.

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
            bears = fatigue_scatter(data) if scatter is None else scatter
            outcome = one.outcome(load_case, bears.on(found.stress.inverse(found.strength)))
            if one.check is not None and lives is not None:
                lasts = reason("lasts", low=lives.low, high=lives.high, wanted=found.wanted, why=outcome.reason)
                outcome = outcome.because(lasts)
            yield outcome


def link_fatigue_outcomes(
    case: Case, every: Sequence[Asked], load_case: str, found: LinkFatigue
) -> Iterator[CheckOutcome]:
    """Yield the outcomes of a link's fatigue; none passes whose stress may be beyond its static strength, not linear.

    Parameters
    ----------
    case : Case
    every : sequence of Asked
        Of the link.
    load_case : str
    found : LinkFatigue

    Yields
    ------
    CheckOutcome
    """
    material = case.material_of(every[0].subject.name)
    assert material.fatigue is not None
    weakest = strength_scatter(material).low * material.allowable
    scatter = None if found.strength is None else borne_scatter(material, found.strength)
    for outcome in fatigue_outcomes(every, load_case, found, material.fatigue, scatter):
        if outcome.verdict is Verdict.PASS and found.largest > weakest:
            outcome = outcome.left_open(reason("yields_in_cycle", stress=found.largest, strength=weakest))
        yield outcome


def pulsating(case: Case, load_case: str, link: str, result: LinkResult) -> LinkFatigue | Reason:
    """Return the fatigue of a link whose load comes and goes as often as the conditions say.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    link : str
    result : LinkResult
        Under that load.

    Returns
    -------
    LinkFatigue or Reason
        Why it is not known, where it is not.
    """
    material, (stated, blocks) = case.material_of(link), case.repeated(load_case)
    data, lacking = material.fatigue, missing_data(material)
    if lacking or data is None:
        return lacking or reason("no_fatigue_data")
    if not stated:
        return reason("fatigue_over_profile")
    if result.decisive.unknowable or result.von_mises_max.unknowable:
        return reason("peak_not_known")
    found = _of_solid(case, result, data) if isinstance(result, SolidResult) else _by_hand(case, result, data)
    extremes, location, counted, notched = found
    shares = np.array(stated)
    pressed = np.maximum(shares, 0.0) if _presses_elsewhere(case, load_case, result) else shares
    lives = [
        [
            fatigue_life(0.0 + of * end, material, blocks)
            for end, of in zip(ends, (shares, pressed, shares), strict=True)
        ]
        for ends in extremes
    ]
    worst = max(range(len(lives)), key=lambda i: lives[i][0].stress)
    ends = [max(own, key=lambda life: life.stress) for own in zip(*lives, strict=True)]
    return LinkFatigue.of(
        ends,
        lives[worst][0],
        0.0 + shares * extremes[worst][0],
        location[worst],
        distinct(result.decisive.sources, (NOTCH,) if notched else ()),
        material=material,
        repetitions=case.conditions.cycles,
        without=result.decisive.without,
        notch=counted[worst],
    )


def _presses_elsewhere(case: Case, load_case: str, result: LinkResult) -> bool:
    """Return True where an opposite load does not make an opposite stress: pins press on the other side of holes."""
    return (
        min(case.repeated(load_case)[0]) < 0.0 and isinstance(result, SolidResult) and bool(case.body(result.link).pins)
    )


def _of_solid(case: Case, result: SolidResult, data: Fatigue) -> Extremes:
    """Return the largest pull and push of all nodes under any variant.

    Of a brittle material the band of its largest tension says nothing of what is pressed; that of the von Mises stress
    stands in where it is wider.
    """
    solution, nodes = result.solution, result.solution.space.nodes
    least, most = notch_factors(case.body(result.link), nodes, data)
    variants = [one for one in solution.cases if one.load == result.governing_case.load]
    fields = [stress_field(solution.space, one.displacement, E=solution.E, nu=solution.nu) for one in variants]
    every = [most * signed_stress(field.nodal, brittle=result.brittle) for field in fields]
    pulled = _beyond(result.decisive, [x.principal if result.brittle else x.von_mises for x in result.variants])
    other = _beyond(result.von_mises_max, [x.von_mises for x in result.variants])
    pressed = min(pulled[0], other[0]), max(pulled[1], other[1])
    found, places, shares, notched = list[Ends](), [], [], False
    for worst, (low, high) in ((np.argmax, pulled), (np.argmin, pressed)):
        picked = [int(worst(signed)) for signed in every]
        stress = [float(signed[node]) for signed, node in zip(every, picked, strict=True)]
        lows = [low * float(least[node] / most[node]) * x for node, x in zip(picked, stress, strict=True)]
        own = [i for i, one in enumerate(variants) if one.transfer in (None, case.torque_transfer)]
        most_stressed = max(own, key=lambda i: abs(stress[i]))
        node = picked[most_stressed]
        found.append((stress[most_stressed], min(lows, key=abs), high * max(stress, key=abs)))
        places.append(nodes[node].copy())
        shares.append(float(most[node]))
        notched = notched or any(least[node] < most[node] for node in picked)
    return found, places, shares, notched


def _beyond(band: Band, peaks: Sequence[float]) -> tuple[float, float]:
    """Return by what factors the ends of a band lie beyond the peaks of the variants."""
    least, most = min(peaks), max(peaks)
    return (band.low / least if least > 0.0 else 1.0, band.high / most if most > 0.0 else 1.0)


def _by_hand(case: Case, result: LinkResult, data: Fatigue) -> Extremes:
    """Return the largest pull and push that may be."""
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
    return ends, [result.location, result.location], [1.0, 1.0], least < 1.0


def judge_fatigue(here: SolvedLinks, one: Asked) -> Judged:
    """Return how often a link bears its load in a pose.

    Where a pin in a loose hole presses harder in the middle of its contact than what is borne so often, that is told:
    peaks of stress leave it out, and S-N lines are not of wear.

    Parameters
    ----------
    here : SolvedLinks
    one : Asked
        Of a link.

    Returns
    -------
    Judged
    """
    case, load_case, link = here.case, here.load_case, one.subject.name
    result = here.links[link]
    fatigue = pulsating(case, load_case, link, result)
    if not isinstance(fatigue, LinkFatigue):
        return Judged(outcome=one.outcome(load_case, Band.unknown(fatigue), fatigue))
    [outcome] = link_fatigue_outcomes(case, [one], load_case, fatigue)
    if not result.decided_by and outcome.verdict is not Verdict.UNDECIDED:
        outcome = outcome.left_open(result.why)
    elif outcome.verdict is Verdict.PASS and case.material_of(link).strength_across_layers is not None:
        outcome = outcome.left_open(reason("layers_fatigue_over_motion"))
    elif outcome.verdict is Verdict.PASS and _presses_elsewhere(case, load_case, result):
        outcome = outcome.left_open(reason("pins_press_elsewhere"))
    pressed = _pressed(here, link, fatigue.strength or math.inf)
    return Judged(
        outcome=outcome.because(together(outcome.reason, pressed)) if pressed else outcome, numbers=(fatigue,)
    )


def _pressed(here: SolvedLinks, link: str, strength: float) -> Reason | None:
    """Return the pin that presses hardest on an eye of a link, where that is more than a strength [MPa]."""
    case, found = here.case, {}
    for joint in case.bearing_joints:
        if link in case.joints[joint].links:
            borne = in_own_eyes(case, joint, here.ways()[0].joints)[link]
            force = load_scatter(case, here.load_case).high * float(np.linalg.norm(borne[:3]))
            found[joint] = contact_pressure(case, joint, link, force)
    joint, most = max(((x, p[1]) for x, p in found.items() if p), key=lambda of: of[1], default=("", 0.0))
    return reason("pin_presses_beside", joint=joint, pressure=most) if most > strength else None
