"""Buckling of links in compression, each by itself.

Plates, discs and parts from files buckle as solids (``alula.fea.judging.solid_buckling``), held alike. Any other link
is a straight column of its section under its own normal force, as it varies along it; beside a slot two flanks take the
section's place (``alula.fea.beam.flanks``). How its joints hold it is known but in part, so that its factor is a band:

value  the outermost pins stay where they are and leave the link free to turn, in the linkage's plane and out of it;
       overhangs are free. A link on one pin is built in there, and the ground where its support holds it. A pin in
       a slot of the link, and one on an arm, hold nothing.
high   every pin stays where it is and keeps whatever angle it can: out of the plane the angle, which only stiff
       neighbours would keep, in the plane the driven link's at the drive's joint, and every angle where pins are
       bonded. No linkage whose joints stay where they are holds the link better, so that below 1 it buckles: a link
       fails on this end alone. Times the largest modulus over the modulus.
low    a third of the value, since nothing is relied on below 3 (see below), times the least modulus over the
       modulus. Joints of a driven link and of bonded ones may move with the link as it bends: there it is a third of
       the lesser of the value and the factor of the link built in at the drive's joint, or at either of the
       outermost pins, and free elsewhere.

That joints stay where they are is taken for granted: sway of the whole linkage is the subject of
``alula.fea.judging.linkage``.

Bending that goes with the compression grows to 1/(1 - 1/n) of what linear theory gives, n the factor (Timoshenko &
Gere, Theory of Elastic Stability, 2nd ed., section 1.11). EN 1993-1-1:2005 asks for n >= 10 where this is neglected
(5.2.1(3)): below it stress and deflection are those of second-order theory (``alula.fea.links.second_order``). For n >=
3 a factor may stand for it (section 5.2.2); below 3, where small faults of shape grow much, no link passes.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked
from alula.fea.beam.column_factor import AxialForce, column_factors
from alula.fea.beam.piecewise import Piecewise, values
from alula.fea.beam.theory import BeamCheck
from alula.fea.buckling.holding import Plane, columns, holding, of_cuts
from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import compliance_scatter, load_scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.nonlinear.large_displacement import LEAST_FACTOR, LEAST_LINEAR, LargeDisplacement
from alula.geometry.base.ties import first_largest
from alula.loads.case.case import Case

Real = NDArray[np.float64]

NAME = "buckling"
NO_COMPRESSION = 1e-9
"""Share of the largest force in the link below which compression is rounding."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ColumnFactors:
    """Buckling factors of a link as a column; infinite where nothing makes it buckle, NaN where not known.

    Attributes
    ----------
    value : ndarray, shape (P,)
        Outermost pins in place and free to turn.
    least : ndarray, shape (P,)
        The least where the joints of a driven or a bonded link move as well.
    most : ndarray, shape (P,)
        Joints hold it as well as they can.
    """

    value: Real
    least: Real
    most: Real


@dataclass(frozen=True, kw_only=True)
class StraightColumn:
    """A link in compression as a column, over one pose or several.

    Attributes
    ----------
    pose : int
        Number of the pose with the least factor.
    compression : float
        The largest along the link in that pose [N].
    outermost : tuple of float
        x of the pins, or of the ground's support, that hold it [mm].
    value, least, most : float
        Least factors of all poses, as in ``ColumnFactors``.
    """

    pose: int
    compression: float
    outermost: tuple[float, ...]
    value: float
    least: float
    most: float


def least_factor(case: Case, link: str, beam: BeamCheck) -> float:
    """Return the buckling factor of a link in one pose.

    Parameters
    ----------
    case : Case
    link : str
    beam : BeamCheck
        Its hand calculation.

    Returns
    -------
    float
        Infinite where nothing makes it buckle.
    """
    return math.inf if beam.without else float(least_factors(case, link, beam.forces)[0])


def least_factors(case: Case, link: str, forces: Piecewise) -> Real:
    """Return the buckling factors of a link that is a beam in one state or in n, on its outermost pins.

    Parameters
    ----------
    case : Case
    link : str
    forces : Piecewise
        Internal forces along it.

    Returns
    -------
    ndarray, shape (n,)
        Infinite where nothing makes it buckle.
    """
    pressed = _compression(forces) > 0.0
    found = np.full(len(pressed), math.inf)
    if pressed.any():
        force = _axial(forces)
        found[pressed] = _pinned_factors(case, link, replace(force, values=force.values[..., pressed]))
    return found


def column(case: Case, link: str, beam: BeamCheck) -> StraightColumn | None:
    """Return the column that stands for a link in one pose; None where nothing makes it buckle.

    Parameters
    ----------
    case : Case
    link : str
    beam : BeamCheck
        Its hand calculation, whose normal force is that of the column.

    Returns
    -------
    StraightColumn or None
    """
    compression = _compression(beam.forces)
    if compression[0] <= 0.0:
        return None
    return worst_column(case, link, compression, link_factors(case, link, _axial(beam.forces)), np.array([True]))


def _compression(forces: Piecewise) -> Real:
    """Largest compression (n,) along a link in every state; 0 where rounding alone tells of one."""
    found = forces.peaks(lambda f: -f[:, 0]).value
    rows = forces.samples[1]
    largest = np.abs(rows[..., :3]).max(axis=(-2, -1))
    return np.where(found > NO_COMPRESSION * largest, found, 0.0)


def _axial(forces: Piecewise) -> AxialForce:
    """Compression along a link in every state."""
    along, half = -forces.coefficients[..., 0, :], np.diff(forces.breaks) / 2.0
    each = np.stack([values(along, steps * half) for steps in (0.0, 1.0, 2.0)], axis=-1)
    return AxialForce(breaks=forces.breaks, values=np.moveaxis(each.reshape(-1, *each.shape[-2:]), 0, -1))


def worst_column(
    case: Case, link: str, compression: Real, factors: ColumnFactors, counted: NDArray[np.bool_]
) -> StraightColumn | None:
    """Return the column of several poses; None where nothing makes the link buckle in any.

    Parameters
    ----------
    case : Case
    link : str
    compression : ndarray, shape (P,)
        The largest along the link in every pose [N].
    factors : ColumnFactors
        Of every pose.
    counted : ndarray of bool, shape (P,)
        The poses that count.

    Returns
    -------
    StraightColumn or None
    """
    pose = first_largest(np.where(counted, 1.0 / factors.value, -np.inf))
    if math.isinf(factors.value[pose]):
        return None
    value, least, most = (float(f[counted].min()) for f in (factors.value, factors.least, factors.most))
    outermost, pressed = holding(case, link).outermost, float(compression[pose])
    return StraightColumn(pose=pose, compression=pressed, outermost=outermost, value=value, least=least, most=most)


def link_factors(case: Case, link: str, force: AxialForce) -> ColumnFactors:
    """Return the factors of a link in every pose, for the modulus of its card.

    Parameters
    ----------
    case : Case
    link : str
    force : AxialForce
        Compression along the link, in P poses.

    Returns
    -------
    ColumnFactors
        Each of shape (P,).
    """
    where = holding(case, link)
    in_plane, across = columns(case.body(link))
    value = _pinned_factors(case, link, force)
    least = value
    for x in where.alone:
        least = np.minimum(least, _softer(case, link, force, built_in=(x,)))
    most = np.full(len(value), np.inf)
    if where.in_plane is not None:
        most = _factors(case, link, force, in_plane, where.in_plane, where.kept)
    if where.across is not None:
        most = np.minimum(most, _factors(case, link, force, across, built_in=where.across))
    return ColumnFactors(value=value, least=least, most=np.maximum(most, value))


def _pinned_factors(case: Case, link: str, force: AxialForce) -> Real:
    """Factors (P,) with the outermost pins in place and free to turn; a single place is held in its angle too."""
    outermost = holding(case, link).outermost
    held, built_in = (outermost, ()) if len(outermost) > 1 else ((), outermost)
    return _softer(case, link, force, held, built_in)


def _softer(
    case: Case, link: str, force: AxialForce, held: Sequence[float] = (), built_in: Sequence[float] = ()
) -> Real:
    """Factors (P,) in the plane in which the link is softer."""
    body = case.body(link)
    in_plane, across = columns(body)
    planes = (in_plane, across) if in_plane[1] else (min(in_plane, across, key=lambda plane: plane[0]),)
    if body.cuts:
        planes = (of_cuts(body, lambda cut: cut.principal[0]),)
    return np.asarray(np.min([_factors(case, link, force, plane, held, built_in) for plane in planes], axis=0))


def _factors(
    case: Case, link: str, force: AxialForce, plane: Plane, held: Sequence[float] = (), built_in: Sequence[float] = ()
) -> Real:
    """Factors (P,) in a plane."""
    (inertia, stretches), young = plane, case.material_of(link).youngs_modulus
    return column_factors(force, young * inertia, held=held, built_in=built_in, stretches=stretches)


def buckling_outcomes(
    case: Case, load_case: str, beams: Mapping[str, BeamCheck], moved: LargeDisplacement
) -> Iterator[CheckOutcome]:
    """Yield the outcome of every beam that is compressed under a load case.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    beams : mapping of str to BeamCheck
        Link -> its hand calculation.
    moved : LargeDisplacement

    Yields
    ------
    CheckOutcome
    """
    for link, beam in beams.items():
        if case.part_of(link).is_beam and (found := column(case, link, beam)) is not None:
            outcome = column_outcome(case, load_case, link, found, moved)
            yield outcome.because(together(outcome.reason, beyond_strength({link: beam})))


def column_outcome(
    case: Case,
    load_case: str,
    link: str,
    found: StraightColumn,
    moved: LargeDisplacement | None = None,
    where: Reason | None = None,
) -> CheckOutcome:
    """Return the outcome of a link in compression.

    A link fails where its compression buckles it however its joints hold it, whatever its stress says.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    link : str
    found : StraightColumn
    moved : LargeDisplacement, optional
        What became of the linkage in large displacement; left out over a motion, whose links are taken as rigid.
    where : Reason, optional
        Of several poses the one of ``found``.

    Returns
    -------
    CheckOutcome
    """
    band = factor_band(case, load_case, link, found.value, (found.least, found.most))
    load = reason(
        "compressed_column", compression=found.compression, where=where, factor=band.value, pins=found.outermost
    )
    outcome = asked_of(Subject.link(link)).outcome(load_case, band, load)
    return outcome.because(reason("buckling_judged", found=load, judgement=judgement(outcome, moved)))


def asked_of(subject: Subject) -> Asked:
    """Return what nobody has to ask for: whether a link, or the linkage, buckles under its load.

    Parameters
    ----------
    subject : Subject

    Returns
    -------
    Asked
    """
    return Asked(name=NAME, subject=subject, quantity=Quantity.BUCKLING_FACTOR, limit=1.0)


def factor_band(
    case: Case, load_case: str, link: str, value: float, ends: tuple[float, float], *sources: Source
) -> Band:
    """Return the band of a link's buckling factor, with what imperfections, modulus and load add.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    link : str
    value : float
    ends : tuple of 2 float
        The least and the largest that its joints leave.
    *sources : Source
        What else ``ends`` cover.

    Returns
    -------
    Band
    """
    compliance = compliance_scatter(case.material_of(link))
    band = Band(
        value=value,
        low=ends[0] / LEAST_LINEAR / compliance.high,
        high=ends[1] / compliance.low,
        sources=(
            *compliance.sources,
            Source(kind=SourceKind.IMPERFECTION, detail=reason("bending_grows")),
            Source(kind=SourceKind.RESTRAINT),
            *sources,
        ),
    )
    return load_scatter(case, load_case).inverse.on(band)


def judgement(outcome: CheckOutcome, moved: LargeDisplacement | None) -> Reason | None:
    """Return, for the end of a reason, what follows from a link's buckling factor.

    Parameters
    ----------
    outcome : CheckOutcome
    moved : LargeDisplacement or None
        What became of the linkage in large displacement; None where links are taken by themselves.

    Returns
    -------
    Reason or None
        Its sentence begins with what separates it from the one before; None where nothing follows.
    """
    band, verdict = outcome.value, outcome.verdict
    if verdict is Verdict.FAIL:
        return reason("buckles_with_stiffest_joints", most=band.high)
    if verdict is Verdict.UNDECIDED and band.value < 1.0:
        return reason("stiffer_joints_raise_it", most=band.high)
    if verdict is Verdict.UNDECIDED:
        return reason("imperfections_grow", within=LEAST_LINEAR)
    if band.value < LEAST_FACTOR and moved is not None and moved.state == "small":
        return reason("bending_grows_little", linkage=moved.buckling)
    if band.value < LEAST_FACTOR and (moved is None or moved.state in ("deformed", "off", "unknown")):
        return reason("bending_has_grown", times=1.0 / (1.0 - 1.0 / band.value))
    return None


def beyond_strength(beams: Mapping[str, BeamCheck]) -> Reason | None:
    """Return which link bears more than its strength by beam theory.

    Parameters
    ----------
    beams : mapping of str to BeamCheck
        Link -> its hand calculation.

    Returns
    -------
    Reason or None
        None where none does.
    """
    link, worst = max(beams.items(), key=lambda item: item[1].worst.equivalent / item[1].strength)
    stress = worst.worst.equivalent
    if stress <= worst.strength:
        return None
    return reason("beyond_strength", link=link, stress=stress, strength=worst.strength)
