"""A link as a column: its planes, and how its joints hold it, by the rules of ``alula.fea.buckling.buckling``."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from alula.fea.beam.column_factor import Stretch
from alula.fea.beam.cut_beam import cells
from alula.fea.beam.flanks import flanks_of
from alula.geometry.bodies.body import Body, hand_section, mouth
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.joints.joint_kinds import Way
from alula.loads.case.case import Case

Plane = tuple[float, Sequence[Stretch]]

ON_AXIS = 1e-9
"""Share of a link's length below which a pin stands on its axis."""


@dataclass(frozen=True, kw_only=True)
class Holding:
    """Where joints hold a link as a column; x along its axis [mm].

    Attributes
    ----------
    outermost : tuple of float
        First and last pin on it, or the one that there is, and a clamp at its mouth; of the ground the point where it
        is held.
    in_plane : tuple of float or None
        Where pins hold it in the linkage's plane, free to turn, at the most; None where that is not known.
    kept : tuple of float
        Where they keep its angle in that plane as well, at the most.
    across : tuple of float or None
        Where they hold it and keep its angle out of the plane, at the most; None where that is not known.
    alone : tuple of float
        Where it may be built in and free elsewhere, each by itself; empty where its joints stay in place.
    """

    outermost: tuple[float, ...]
    in_plane: tuple[float, ...] | None
    kept: tuple[float, ...]
    across: tuple[float, ...] | None
    alone: tuple[float, ...]


def columns(body: Body, *, free: bool = False) -> tuple[Plane, Plane]:
    """Return how a link resists bending as a column.

    Parameters
    ----------
    body : Body
        The link's; beside its slots two flanks take the section's place.
    free : bool, optional
        Whether a section without symmetry may bend across the plane as well, which makes it softer. Where it may not,
        no way of holding it makes it stiffer.

    Returns
    -------
    tuple of two (float, sequence of Stretch)
        In the plane, and out of it: second moment [mm⁴], and stretches of another one.
    """
    if body.cuts and free:
        return of_cuts(body, lambda cut: cut.free[1]), of_cuts(body, lambda cut: cut.free[0])
    if body.cuts:
        return of_cuts(body, lambda cut: cut.i_z), of_cuts(body, lambda cut: cut.i_y)
    section, slots = hand_section(body), flanks_of(body)
    in_plane = [
        Stretch(
            first=slot.first,
            last=slot.last,
            bending=slot.together.i_z / section.i_z,
            pair=slot.pair / section.i_z,
        )
        for slot in slots
    ]
    across = [Stretch(first=slot.first, last=slot.last, bending=slot.together.i_y / section.i_y) for slot in slots]
    return (section.i_z, in_plane), (section.i_y, across)


def of_cuts(body: Body, second: Callable[[CutSection], float]) -> Plane:
    """Return the column of sections that were cut; what lies beyond the outermost pins is as the mean of all.

    Parameters
    ----------
    body : Body
        A body with cuts.
    second : callable
        The second moment of a section [mm⁴].

    Returns
    -------
    tuple of (float, sequence of Stretch)
        The mean [mm⁴], and stretches of another one.
    """
    cuts = body.cuts
    mean = sum(map(second, cuts)) / len(cuts)
    return mean, [Stretch(first=a, last=b, bending=second(cut) / mean) for a, b, cut in cells(cuts)]


def holding(case: Case, link: str) -> Holding:
    """Return where joints hold a link as a column.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    Holding
    """
    linkage = case.linkage
    body = case.body(link)
    pins = {pin.name: pin for pin in body.pins}
    mouths = {end.name: mouth(body, end) for end in body.ends}
    joints = {name: linkage.point_of(name, link) for name in linkage.joints_of(link)}
    carried = {name for name in joints if linkage.joints[name].carrier == link}
    places, feet = case.links[link].points, {point: pin.foot[0] for point, pin in pins.items() if pin.foot is not None}
    foot = {name: feet.get(point, mouths.get(point, places[point][0])) for name, point in joints.items()}
    on_arms = {name for name, point in joints.items() if point in feet}
    slack = ON_AXIS * linkage.longest
    held_at = case.links[link].held_at
    support = set() if held_at is None else {places[held_at][0]}
    off = on_arms | {name for name, point in joints.items() if abs(places[point][1]) > slack}
    plain = [foot[name] for name in joints if name not in carried | on_arms] or list(foot.values())
    first, last = min(plain), max(plain)
    drive = {case.drive.joint} if case.drive is not None and case.drive.link == link else set()
    # A pin that holds the link off its axis may keep its angle, held by other pins as well.
    fixed = {name for name in joints if linkage.joints[name].fixed}
    guides = {name for name in carried if Way.PIN in linkage.joints[name].bears}
    alone = {foot[name] for name in (fixed | drive) & set(joints)}
    return Holding(
        outermost=tuple(support) or ((first, last) if last - first > slack else (first,)),
        in_plane=None if carried else tuple(sorted({*foot.values(), *support})),
        kept=tuple(sorted({foot[name] for name in (fixed | drive | off) & set(joints)} | support)),
        across=None if guides else tuple(sorted({foot[name] for name in set(joints) - carried} | support)) or None,
        alone=() if support else tuple(sorted(alone)),
    )
