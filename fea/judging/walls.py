"""Outcome of the check of thin walls and deep strips: at what factor on its loads a link buckles in their modes.

``docs/theory/walls.md`` has what the bands hold, and what they leave out.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from alula.fea.asked.asked import Asked
from alula.fea.beam.piecewise import Floats, Side
from alula.fea.beam.theory import BeamCheck
from alula.fea.buckling.buckling import column, factor_band
from alula.fea.buckling.holding import holding
from alula.fea.buckling.lateral import ABOUT_Y, ABOUT_Z, lateral_factor
from alula.fea.buckling.wall import (
    BENDING,
    COMPRESSION,
    elastic_stress,
    flattening_moment,
    knock_down,
    least_yielding_stress,
    perfect_stress,
    wall_of,
    yielding_stress,
)
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import Scatter, compliance_scatter, load_scatter, strength_scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import CheckOutcome
from alula.fea.judging.loading import ByHand, Judged, Loading, OverMotion
from alula.fea.modes.wall_modes import WallFactor, WallMode
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case

THIN, LEAST_THIN = 100.0 * (1.0 - 1e-9), 25.0
"""R/t from which on the tests behind SP-8007 lie, but for rounding, and below which a wall is no thin shell."""
ROUND = 9.0 / (2.0 * math.sqrt(6.0))
"""Moment at which the wall of a perfect tube buckles that stays round, over that at which a long one flattens."""
EXACT = 0.971
"""Moment at which a long tube flattens by energy with large rotations, over Brazier's, which has small ones."""
IMPERFECT = Source(kind=SourceKind.IMPERFECTION, detail=reason("knocked_down_to_perfect"))
STAYS_ROUND = Source(kind=SourceKind.RESTRAINT, detail=reason("ends_keep_it_round"))
LARGE = Source(kind=SourceKind.GROWTH, detail=reason("large_rotations_of_section"))
YIELDS = Source(kind=SourceKind.STRENGTH, detail=reason("wall_yields"))
NO_WALL = reason("no_thin_wall")
NOTHING = 1e-9
"""Share of the largest stress below which one is rounding."""


def wall_factors(
    case: Case, load_case: str, one: Asked, plates: Sequence[BeamCheck], growth: Scatter
) -> Iterator[WallFactor]:
    """Yield the factor of every mode in which a link may buckle; of a pair, of either plate.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    one : Asked
        Of a link.
    plates : sequence of BeamCheck
        Hand calculations of the link, or of each plate of a pair, at one pose.
    growth : Scatter
        What else than the scatter of loads makes of what acts on it.

    Yields
    ------
    WallFactor
    """
    more = load_scatter(case, load_case).times(growth).inverse
    for beam in plates:
        if wall := wall_of(case, one.subject.name):
            yield from _of_tube(case.material_of(one.subject.name), beam, wall, more)
        elif not beam.section.round:
            yield from _of_strip(case, load_case, one, beam, growth)


def _of_tube(material: Material, beam: BeamCheck, wall: tuple[float, float], more: Scatter) -> Iterator[WallFactor]:
    (radius, thickness), section, own = wall, beam.section, compliance_scatter(material)
    young, ratio = material.youngs_modulus, material.poissons_ratio
    perfect = perfect_stress(*wall, young, ratio)
    pressed_bears, bent_bears = (perfect * knock_down(*wall, most) for most in (COMPRESSION, BENDING))

    def stresses(forces: Floats) -> tuple[Floats, Floats]:
        """Of compression, and of bending in the middle of the wall."""
        bent = np.hypot(forces[:, 4], forces[:, 5]) * radius / section.i_z
        return np.maximum(-forces[:, 0], 0.0) / section.area, bent

    def used(forces: Floats) -> Floats:
        pressed, bent = stresses(forces)
        return pressed / pressed_bears + bent / bent_bears

    def told(mode: WallMode, x: float, side: Side, bears: float, factor: Band, why: Reason | str) -> WallFactor:
        forces = beam.forces.at(x, side)
        pressed, bent = (float(one) > NOTHING * largest for one in np.squeeze(stresses(forces[None])))
        return WallFactor(
            mode=mode,
            x=x,
            compression=-float(forces[0]) if pressed else 0.0,
            moment=math.hypot(*forces[4:6]) if bent else 0.0,
            bears=bears,
            ratio=radius / thickness,
            factor=more.on(factor),
            told=why,
        )

    x, side, most = beam.forces.largest(used)
    largest = beam.forces.largest(lambda forces: np.add(*stresses(forces)))[2]
    if largest <= NOTHING * _size(beam):
        return
    strength, scatter = material.allowable, strength_scatter(material)

    yields = math.inf if material.brittle else yielding_stress(*wall, young, strength)
    value, plain = min(1.0 / most, yields / largest), 1.0 / most / own.high
    ends = scatter.low * strength, scatter.high * strength
    soft = math.inf if material.brittle else least_yielding_stress(*wall, young / own.high, ends)
    low, elastic = min(value, plain, soft / largest), elastic_stress(*wall, young / own.high) / largest
    found = Band(
        value=value,
        low=low,
        high=perfect / largest / own.low,
        sources=(*own.sources, IMPERFECT, *((*scatter.sources, YIELDS) if low < min(plain, elastic) else ())),
    )
    bears = min(bent_bears, yields) * section.i_z / radius
    why = _told(radius / thickness, min(pressed_bears, bent_bears), strength)
    yield told(WallMode.WALL, x, side, bears, found, why)
    x, side, moment = beam.forces.largest(lambda forces: np.hypot(forces[:, 4], forces[:, 5]))
    if moment * radius / section.i_z > NOTHING * largest:
        bears = flattening_moment(*wall, young, ratio)
        found = Band(
            value=bears / moment,
            low=EXACT * bears / moment / own.high,
            high=ROUND * bears / moment / own.low,
            sources=(*own.sources, LARGE, STAYS_ROUND),
        )
        yield told(WallMode.FLATTENING, x, side, bears, found, "")


def _size(beam: BeamCheck) -> float:
    """Return the largest normal stress, as rounding is judged by it."""
    return float((np.abs(beam.axial) + beam.bending).max())


def _told(ratio: float, bears: float, strength: float) -> Reason | str:
    """Return what to know of the number of a wall: whether it yields first, and where no test of thin shells lies."""
    first = reason("wall_yields_first", stress=bears, strength=strength) if bears > strength else None
    kind = "wall_extrapolated" if ratio >= LEAST_THIN else "wall_is_thick"
    return together(None if ratio >= THIN else reason(kind, ratio=ratio), first)


def _of_strip(case: Case, load_case: str, one: Asked, beam: BeamCheck, growth: Scatter) -> Iterator[WallFactor]:
    """Of a bar whose stiff plane it is bent in; none where it is square."""
    section, link = beam.section, one.subject.name
    material, where = case.material_of(link), holding(case, link)
    about = ABOUT_Z if section.i_z > section.i_y else ABOUT_Y
    weak, stiff = sorted((section.i_y, section.i_z))
    young = material.youngs_modulus
    twisting = material.shear_modulus * section.torsion
    stiffness = math.sqrt(young * weak * twisting)
    x, side, moment = beam.forces.largest(lambda forces: np.abs(forces[:, about]))
    if weak == stiff or moment * max(section.half_y, section.half_z) / stiff <= NOTHING * _size(beam):
        return
    value = lateral_factor(beam.forces, about, stiffness, where.outermost)
    least = min([value, *(lateral_factor(beam.forces, about, stiffness, (x,)) for x in where.alone)])
    pressed = column(case, link, beam)
    least = 1.0 / (1.0 / least + (0.0 if pressed is None else 1.0 / pressed.least))
    most = math.inf
    if where.across is not None:
        bent = math.sqrt((1.0 - weak / stiff) * (1.0 - twisting / (young * stiff)))
        most = lateral_factor(beam.forces, about, stiffness, where.across, kept=True) / bent
    yield WallFactor(
        mode=WallMode.LATERAL,
        x=x,
        compression=max(0.0, -float(beam.forces.at(x, side)[0])),
        moment=moment,
        bears=value * moment,
        ratio=math.sqrt(stiff / weak),
        factor=growth.inverse.on(factor_band(case, load_case, link, value, (least, max(most, value)))),
    )


def judge_walls(here: Loading, one: Asked) -> Judged:
    """Return what the thin walls and deep strips of a link bear.

    Parameters
    ----------
    here : Loading
    one : Asked
        Of a link.

    Returns
    -------
    Judged
    """
    found = _modes(here, one)
    numbers = tuple(mode for mode in found if math.isfinite(mode.factor.value))
    return Judged(outcome=wall_outcome(here.load_case, one, found), numbers=numbers)


def _modes(here: Loading, one: Asked) -> tuple[WallFactor, ...]:
    link = one.subject.name
    beams, others = ([hand.check for hand in hands] for hands in (here.hands(link), here.others(link)))
    found = wall_factors(here.case, here.load_case, one, beams, here.link_growth(link))
    # What pulls as stated may press in other air, or with other friction, of which no growth of stress tells.
    may = wall_factors(here.case, here.load_case, one, others, Scatter())
    return (*found, *(replace(mode, factor=replace(mode.factor, value=math.inf, high=math.inf)) for mode in may))


def least_of_walls(over: OverMotion, one: Asked) -> Floats:
    """Return by what all loads on a link may grow until it buckles at each pose.

    Parameters
    ----------
    over : OverMotion
    one : Asked
        Of a link.

    Returns
    -------
    ndarray, shape (n,)
    """
    least = np.full(len(over.evaluated), np.inf)
    for pose in np.flatnonzero(over.evaluated).tolist():
        least[pose] = min((mode.factor.low for mode in _modes(over.at(pose), one)), default=math.inf)
    return least


def wall_outcome(load_case: str, one: Asked, found: Sequence[WallFactor]) -> CheckOutcome:
    """Return the outcome of a link: the least factor of all of its modes.

    Parameters
    ----------
    load_case : str
        Its name.
    one : Asked
        Of a link.
    found : sequence of WallFactor
        Of its modes.

    Returns
    -------
    CheckOutcome
        The reason names the mode whose least factor is the least.
    """
    if not found:
        return one.outcome(load_case, Band.exact(math.inf), NO_WALL)
    worst = min(found, key=lambda of: of.factor.low)
    outcome = one.outcome(load_case, Band.least([of.factor for of in found]))
    why = together(outcome.reason, worst.told)
    acting = {"moment": worst.moment or None, "compression": worst.compression or None}
    return outcome.because(reason("mode_of_wall", mode=str(worst.mode), bears=worst.bears, **acting, why=why))


WALLS = ByHand(judge=judge_walls, least=least_of_walls)
