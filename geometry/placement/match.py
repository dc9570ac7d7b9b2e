"""How an imported part lies in its link: its bores are matched to the link's points, by diameter and distance.

The link's plane is normal to the common axis of its bores.
"""

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from alula.geometry.base.errors import CaseError
from alula.geometry.imported.arrangement import PARALLEL, along_slot, angle_between
from alula.geometry.imported.facts import Bore
from alula.geometry.parts.step import FilePart
from alula.geometry.placement.fit import Fit, SlotEnd, Wanted, ends_of

Real = NDArray[np.float64]

STEEPEST = math.radians(1.0)
"""Least angle between the bore of a single pin and a stated direction; the direction's part across the bore counts."""


def place(
    part: FilePart,
    bores: Sequence[Bore],
    wanted: Sequence[Wanted],
    others: Mapping[str, tuple[float, float]] = MappingProxyType({}),
) -> Fit:
    """Find how a part lies in its link.

    Parameters
    ----------
    part : FilePart
        The part, with its tolerances and what it states of its bores.
    bores : sequence of Bore
        All bores of its solid.
    wanted : sequence of Wanted
        The pinned points of the link.
    others : mapping of str to tuple of float, optional
        Its points without a joint, (x, y) in its frame [mm]; beside a single pin, those whose bores the part names tell
        how it lies.

    Returns
    -------
    Fit
        The only one that fits.

    Raises
    ------
    CaseError
        Where none fits, or several do.
    """
    if not wanted:
        wanted = _unpinned(part, bores, others)
    candidates = [_candidates(part, bores, one) for one in wanted]
    if len(wanted) == 1:
        return _placed_about(part, bores, candidates[0], wanted[0], others)
    if part.along is not None:
        raise CaseError("along: the pins of the link tell how the part lies; leave it out")
    _check_named_parallel(part, wanted, candidates)
    spots = [end for one in wanted for end in one.ends]
    rounds = [
        [end for bore in own for end in ends_of(bore)]
        for one, own in zip(wanted, candidates, strict=True)
        for _ in one.ends
    ]
    found: dict[tuple[str, ...], list[Fit]] = {}
    for placement in _fits(part, rounds, spots):
        found.setdefault(tuple(placement.bores[one.name].name for one in wanted), []).append(placement)
    if not found:
        raise CaseError(_none_fits(part, [end for bore in bores for end in ends_of(bore)], spots))
    if len(found) > 1:
        ways = "; or ".join(
            ", ".join(f"{one.name} = {bore}" for one, bore in zip(wanted, names, strict=True))
            for names in list(found)[:4]
        )
        raise CaseError(
            f"its points fit the bores in {len(found)} ways ({ways}{'; ...' if len(found) > 4 else ''}); state which "
            "bore each point is, in the part's bores"
        )
    [either_way_up] = found.values()
    return either_way_up[-1 if part.flip else 0]


def _unpinned(part: FilePart, bores: Sequence[Bore], others: Mapping[str, tuple[float, float]]) -> list[Wanted]:
    """Return the first point with a bore of its own, which tells how a part without pins lies."""
    for name in others:
        if name in part.bores:
            return [Wanted(name=name, place=others[name], diameter=_named(part, bores, name).diameter)]
    raise CaseError(
        "an imported part is placed by its bores, but the link has no joint with a pin; add one, or name in the part's "
        "bores that of a point without a joint"
    )


def _placed_about(
    part: FilePart,
    all_bores: Sequence[Bore],
    bores: Sequence[Bore],
    one: Wanted,
    others: Mapping[str, tuple[float, float]],
) -> Fit:
    """Return how a part lies in a link with a single pin, by the direction or the other bores that the part states."""
    if len(bores) > 1:
        raise CaseError(
            f"the pin at {one.name} fits {', '.join(bore.told for bore in bores[:12])}; state which it is, in the "
            "part's bores"
        )
    if one.slot is not None:
        raise CaseError(f"the link has no joint but one in a slot, {one.name}, which does not hold it; add a joint")
    [bore] = bores
    if part.along is not None:
        return _placed_along(part, bore, one, np.asarray(part.along, dtype=float), np.array([1.0, 0.0]))
    beside: dict[str, Real] = {}
    for name, at in others.items():
        if name in part.bores and at != one.place and not (named := _named(part, all_bores, name)).slot:
            _check_parallel({one.name: bore, name: named})
            beside[name] = _across(np.subtract(named.centre, bore.centre), np.asarray(bore.axis))
    arms = {name: arm for name, arm in beside.items() if np.linalg.norm(arm) > part.place_tolerance}
    if not arms:
        raise CaseError(
            f"the link has a single pin, {one.name}, which does not tell how the part lies; name the bore of a second "
            "point in the part's bores, or state along = [x, y, z], the direction of the link's x axis in the frame of "
            "the file"
        )
    far = max(arms, key=lambda name: round(float(np.linalg.norm(arms[name])), 6))
    fits = [
        _placed_along(part.model_copy(update={"flip": over}), bore, one, arms[far], np.subtract(others[far], one.place))
        for over in (part.flip, not part.flip)
    ]
    off = [max(math.dist((fit.turn @ arm)[:2] + one.place, others[name]) for name, arm in arms.items()) for fit in fits]
    return fits[1] if off[1] <= part.place_tolerance < off[0] else fits[0]


def _placed_along(part: FilePart, bore: Bore, one: Wanted, towards: Real, link: Real) -> Fit:
    """Return how a part lies about its pin, where a direction of its file is one of the link."""
    z = _senses(bore)[-1 if part.flip else 0]
    across = _across(towards, z)
    size = float(np.linalg.norm(across) / np.linalg.norm(towards))
    if size < math.sin(STEEPEST):
        raise CaseError(
            f"along = {towards.tolist()} is the direction of {bore.name}, but the link's x axis lies across its pins; "
            "state one across the bore"
        )
    turn = _turned(across, link, z)
    shift = np.append(one.place, -(part.plane or 0.0)) - turn @ np.asarray(bore.centre)
    return Fit(turn=turn, shift=shift, bores={one.name: bore})


def with_loaded_bores(
    part: FilePart, fit: Fit, bores: Sequence[Bore], points: Mapping[str, tuple[float, float]]
) -> Fit:
    """Add the bores in which points without a joint stand: a load there is that of a pin.

    Parameters
    ----------
    part : FilePart
        The part.
    fit : Fit
        How it lies by the pins of its joints.
    bores : sequence of Bore
        All bores of its solid.
    points : mapping of str to tuple of float
        The link's points without a joint, (x, y) in its frame [mm].

    Returns
    -------
    Fit
        The same, with the bore of every point that is named in the part's bores or stands in the middle of one.

    Raises
    ------
    CaseError
        Where a point stands elsewhere than the bore that is named for it.
    """
    found, upright = dict(fit.bores), next(iter(fit.bores.values()))
    for name, at in points.items():
        if name in part.bores:
            near = [_named(part, bores, name)]
        else:
            near = [bore for bore in bores if not bore.slot and angle_between(bore, upright) <= PARALLEL]
            if not near:
                continue
        if near[0].slot:
            raise CaseError(
                f"bores.{name}: {near[0].name} is a slot, in which the pin of a joint slides, but the point {name} has "
                f'no joint; add one of type "pin-in-slot", or take {name} out of the part\'s bores'
            )
        away = {bore.name: math.dist((fit.turn @ bore.centre + fit.shift)[:2], at) for bore in near}
        bore = min(near, key=lambda one: away[one.name])
        if away[bore.name] <= part.place_tolerance:
            found[name] = bore
        elif name in part.bores:
            raise CaseError(
                f"the point {name} stands {away[bore.name]:.4g} mm from {bore.name}, more than place_tolerance "
                f"{part.place_tolerance:g} mm; correct the point, or take {name} out of the part's bores"
            )
    return replace(fit, bores=found)


def points_of_part(part: FilePart, bores: Sequence[Bore]) -> dict[str, tuple[float, float]]:
    """Return the points that a part's named bores give its link, the first at the origin, the second on the x axis.

    Where a slot is among them, x runs along the first one instead, in the sense in which the second point is at x > 0.
    The point of a slot is its middle.

    Parameters
    ----------
    part : FilePart
        A part that names its bores.
    bores : sequence of Bore
        All bores of its solid.

    Returns
    -------
    dict of str to tuple of float
        Point -> (x, y) [mm].

    Raises
    ------
    CaseError
        Where it names fewer than two bores, or one that is not there, or bores that are not parallel or are coaxial.
    """
    if len(part.bores) < 2:
        raise CaseError('it must name two points or more where a link has points = "from-part"')
    own = {point: _named(part, bores, point) for point in part.bores}
    first, second = list(own.values())[:2]
    _check_parallel(own)
    z = _senses(first)[-1 if part.flip else 0]
    across = _across(np.subtract(second.centre, first.centre), z)
    if np.linalg.norm(across) <= part.place_tolerance:
        names = list(own)[:2]
        raise CaseError(
            f"the bores of {names[0]} and {names[1]} are coaxial, so they tell no direction; swap the order"
        )
    x = along_slot(own.values(), across, z)
    axes = np.array([x, np.cross(z, x)])
    flat = {point: axes @ np.subtract(bore.centre, first.centre) for point, bore in own.items()}
    return {point: (round(float(at[0]), 9), round(float(at[1]), 9)) for point, at in flat.items()}


def _candidates(part: FilePart, bores: Sequence[Bore], one: Wanted) -> list[Bore]:
    """Return the bores that may be a point's: the one that is named, else all of its diameter."""
    what = "bore" if one.slot is None else "slot"
    if one.name in part.bores:
        bore = _named(part, bores, one.name)
        if bool(bore.slot) != (one.slot is not None):
            is_a, wants = ("slot", "turns in a round bore") if bore.slot else ("round bore", "slides in a slot")
            raise CaseError(f"the pin at {one.name} {wants}, but {bore.name} is a {is_a}; name another bore")
        if not _holds(part, bore, one):
            raise CaseError(
                f"the pin at {one.name} has a diameter of {one.diameter:g} mm, but {bore.name} has {bore.diameter:.6g} "
                f"mm, and diameter_tolerance is {part.diameter_tolerance:g} mm; correct pin_diameter or name another "
                "bore"
            )
        return [bore]
    found = [bore for bore in bores if bool(bore.slot) == (one.slot is not None) and _holds(part, bore, one)]
    if not found:
        loose = f" and {one.clearance:g} mm of clearance" if one.clearance else ""
        raise CaseError(
            f"no {what} is within {part.diameter_tolerance:g} mm (diameter_tolerance) of the diameter of the pin at "
            f"{one.name}, {one.diameter:g} mm{loose}; {listed(bores)}"
        )
    return found


def _holds(part: FilePart, bore: Bore, one: Wanted) -> bool:
    return abs(bore.diameter - one.diameter - one.clearance) <= part.diameter_tolerance + 1e-9 * one.diameter


def _named(part: FilePart, bores: Sequence[Bore], point: str) -> Bore:
    name = part.bores[point]
    for bore in bores:
        if bore.name == name:
            return bore
    raise CaseError(f"bores.{point}: the part has no bore '{name}'; {listed(bores)}")


def listed(bores: Sequence[Bore]) -> str:
    """Say which bores a part has.

    Parameters
    ----------
    bores : sequence of Bore
        All of them.

    Returns
    -------
    str
        For a message.
    """
    if not bores:
        return "the part has no bores"
    shown = ", ".join(bore.told for bore in bores[:12]) + (", ..." if len(bores) > 12 else "")
    return f"its bores are {shown}"


def _check_named_parallel(part: FilePart, wanted: Sequence[Wanted], candidates: Sequence[Sequence[Bore]]) -> None:
    named = {one.name: found[0] for one, found in zip(wanted, candidates, strict=True) if one.name in part.bores}
    _check_parallel(named)


def _check_parallel(named: Mapping[str, Bore]) -> None:
    """Refuse bores whose axes are not parallel, with the angle."""
    for (one, bore), (other, second) in itertools.combinations(named.items(), 2):
        angle = angle_between(bore, second)
        if angle > PARALLEL:
            raise CaseError(
                f"the bores of {one} and {other} ({bore.name}, {second.name}) stand at {math.degrees(angle):.3g} "
                "degrees to each other, but the pins of a link are parallel; name other bores"
            )


def _senses(bore: Bore) -> tuple[Real, Real]:
    """Return both senses of an axis, first the one whose largest component is positive."""
    axis = np.asarray(bore.axis, dtype=float)
    axis = axis if axis[int(np.argmax(np.abs(axis) > np.abs(axis).max() - 1e-6))] > 0.0 else -axis
    return axis, -axis


def _across(vector: Real, z: Real) -> Real:
    return np.asarray(vector - (vector @ z) * z)


def _fits(part: FilePart, candidates: Sequence[Sequence[Bore]], wanted: Sequence[Wanted]) -> Iterator[Fit]:
    """Yield every way in which a part lies so that all points are bores: first those the right way up."""
    places = np.array([one.place for one in wanted])
    far = np.linalg.norm(places[:, None] - places, axis=2)
    first, second = map(int, np.unravel_index(int(np.argmax(far)), far.shape))
    for one, other in itertools.product(candidates[first], candidates[second]):
        if one is other or angle_between(one, other) > PARALLEL:
            continue
        for z in _senses(one):
            arm = _across(np.subtract(other.centre, one.centre), z)
            if abs(np.linalg.norm(arm) - far[first, second]) > 2.0 * part.place_tolerance:
                continue
            turn = _turned(arm, places[second] - places[first], z)
            flat = turn[:2]
            shift = places[first] - flat @ np.asarray(one.centre)
            chosen = [
                min(found, key=lambda bore: float(np.linalg.norm(flat @ np.asarray(bore.centre) + shift - at)))
                for found, at in zip(candidates, places, strict=True)
            ]
            wholes = {(at.name, b.whole.name) for at, b in zip(wanted, chosen, strict=True) if isinstance(b, SlotEnd)}
            if (
                len({bore.name for bore in chosen}) == len(chosen)
                and len(wholes) == len({point for point, _ in wholes})
                and all(angle_between(one, b) <= PARALLEL for b in chosen)
            ):
                placement = _fitted(part, chosen, wanted, turn)
                if placement is not None:
                    yield placement


def _turned(arm: Real, along: Real, z: Real) -> Real:
    """Return the rotation (3, 3) that takes a vector of the file to a direction of the link, and z to z."""
    cosine, sine = along / np.linalg.norm(along)
    unit = arm / np.linalg.norm(arm)
    across = np.cross(z, unit)
    return np.array([cosine * unit - sine * across, sine * unit + cosine * across, z])


def _fitted(part: FilePart, bores: Sequence[Bore], wanted: Sequence[Wanted], turn: Real) -> Fit | None:
    """Return the placement whose bores are nearest to the points by least squares; None where one is too far off.

    The best rotation in the plane: Kabsch, Acta Cryst. A32 (1976) 922-923. Where there is a slot, it is the one that
    brings the (first) slot along x instead, since a pin pushes across it alone.
    """
    places = np.array([one.place for one in wanted])
    centres = np.array([bore.centre for bore in bores]) @ turn.T
    own, flat = places - places.mean(axis=0), centres[:, :2] - centres[:, :2].mean(axis=0)
    turned = math.atan2(float((flat[:, 0] * own[:, 1] - flat[:, 1] * own[:, 0]).sum()), float((flat * own).sum()))
    about = np.array(
        [[math.cos(turned), -math.sin(turned), 0.0], [math.sin(turned), math.cos(turned), 0.0], [0.0, 0.0, 1.0]]
    )
    turn = about @ turn
    slot = next((bore for bore in bores if isinstance(bore, SlotEnd)), None)
    if slot is not None:
        x = along_slot([slot.whole], turn[0], turn[2])
        turn = np.array([x, np.cross(turn[2], x), turn[2]])
    centres = np.array([bore.centre for bore in bores]) @ turn.T
    shift = np.append((places - centres[:, :2]).mean(axis=0), 0.0)
    if np.linalg.norm(centres[:, :2] + shift[:2] - places, axis=1).max() > part.place_tolerance:
        return None
    named = {
        one.name: bore.whole if isinstance(bore, SlotEnd) else bore for one, bore in zip(wanted, bores, strict=True)
    }
    heights = np.array([turn[2] @ bore.centre for bore in named.values()])
    shift[2] = -(heights.mean() if part.plane is None else heights[0] + part.plane)
    return Fit(turn=turn, shift=shift, bores=named)


def _none_fits(part: FilePart, bores: Sequence[Bore], wanted: Sequence[Wanted]) -> str:
    """Say that no bores lie as the points do, with the distances of both."""
    pairs = list(itertools.combinations(wanted, 2))[:3]
    stated = ", ".join(f"{a.name} to {b.name} {math.dist(a.place, b.place):.5g} mm" for a, b in pairs)
    apart = []
    for one, other in itertools.combinations(bores, 2):
        if angle_between(one, other) <= PARALLEL:
            across = _across(np.subtract(other.centre, one.centre), np.asarray(one.axis))
            apart.append(f"{one.name} to {other.name} {np.linalg.norm(across):.5g} mm")
    told = ", ".join(apart[:6]) + (", ..." if len(apart) > 6 else "") or "no two of them are parallel"
    return (
        f"no parallel bores lie as the link's points do within place_tolerance {part.place_tolerance:g} mm: the points "
        f'have {stated}, the bores {told}; correct the points, or take them from the part (points = "from-part")'
    )
