"""What acts on each link on the deformed shape: loads on its straight shape along the chord, which balance."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import in_slot, link_loads
from alula.fea.common.link_loads import EndLoad, LinkLoads
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.nonlinear.equilibrium_path import CorotationalSolution
from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.body import mouth
from alula.geometry.parts.part import Body, PlainEnd
from alula.loads.records.applied import Load, shifted
from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]
NOTHING = 1e-7
"""Share of the whole load below which what acts on a link is taken for the iteration's rest."""
LARGEST_SHIFT = 0.05
"""Moment or force that bending of a link under spread loads may leave unbalanced, as a share of the load."""


def on_deformed_shape(
    frame: LinkageFrame,
    found: CorotationalSolution,
    reactions: Reactions,
    link: str,
    title: str,
    body: Body,
    loads: Sequence[Load],
) -> LinkLoads:
    """Return what acts on a link on the deformed shape, for its straight shape along the chord.

    The chord runs from the first to the last station, or the mouth of a clamp there; z is that of the first node,
    turned normal to it.

    Parameters
    ----------
    frame : LinkageFrame
        Of the linkage.
    found : CorotationalSolution
        Its equilibrium on the deformed shape.
    reactions : Reactions
        On that shape.
    link : str
        Its name.
    title : str
        Of the load case.
    body : Body
        Geometry of the link.
    loads : sequence of Load
        That act on the linkage, global axes.

    Returns
    -------
    LinkLoads
        Loads on the straight link.
    """
    nodes, stations = frame.model.nodes + found.displacements[: len(frame.model.nodes)], frame.stations[link]
    mouths = {end.name: _node_at(stations, mouth(body, end)) for end in body.ends if mouth(body, end) != end.x}
    free = [station for station in stations if station[1] in mouths.values()]
    (x, first), (_, last) = stations[0], stations[-1]
    if any(mouth(body, end) > end.x for end in body.ends):
        x, first = free[0]
    if any(mouth(body, end) < end.x for end in body.ends):
        _, last = free[-1]
    start, end = (nodes[n] + found.rotations[n] @ frame.arms.get(n, np.zeros(3)) for n in (first, last))
    along = (end - start) / np.linalg.norm(end - start)
    across = np.cross(found.rotations[first][:, 2], along)
    across /= np.linalg.norm(across)
    axes = np.column_stack([along, across, np.cross(along, across)])
    moved = {
        point: axes.T @ (nodes[frame.points[link, point]] - start) + np.array([x - x_p, -y_p, 0.0])
        for point, (x_p, y_p) in frame.pose.linkage.links[link].points.items()
    }
    cut = _driven(link_loads(title, link, body, reactions, loads, axes), axes)
    for clamp in (clamp for clamp in body.ends if clamp.name in mouths):
        held, at = nodes[frame.points[link, clamp.name]], nodes[mouths[clamp.name]]
        moved[clamp.name] = axes.T @ (at - start) + np.array([x - mouth(body, clamp), 0.0, 0.0])
        cut = _at_mouth(cut, clamp, axes.T @ (held - at))
    return in_slots(bent(cut, moved), body, link)


def _node_at(stations: Sequence[tuple[float, int]], x: float) -> int:
    """Number of the node of the station at x."""
    return min(stations, key=lambda station: abs(station[0] - x))[1]


def _at_mouth(loads: LinkLoads, end: PlainEnd, arm: Real) -> LinkLoads:
    """Return the loads with the wrench of a clamp moved to its mouth by the arm (3,) that the turned clamp has."""

    def turned(load: EndLoad) -> EndLoad:
        at_joint = shifted(load.wrench, load.point - np.array([end.x, end.y, 0.0]))
        return replace(load, wrench=shifted(at_joint, arm))

    return replace(loads, ends=tuple(turned(load) if load.name == end.name else load for load in loads.ends))


def _driven(loads: LinkLoads, axes: Real) -> LinkLoads:
    """Return the loads with what the drive torque, about the global z, has off the link's own z, at the pin driven."""
    pins = {pin.name: pin for pin in loads.pins}
    for couple in loads.couples:
        wrench = pins[couple.pin].wrench.copy()
        wrench[3:] += couple.torque * (axes[2] - np.array([0.0, 0.0, 1.0]))
        pins[couple.pin] = replace(pins[couple.pin], wrench=wrench)
    return replace(loads, pins=tuple(pins.values()))


def in_slots(loads: LinkLoads, body: Body, link: str) -> LinkLoads:
    """Return the loads with every pin in a slot at the place to which it has slid, pushing across the slot alone.

    Friction acts along it besides. On a bent link a slot is not parallel to the chord; what the pin's force has along
    it is left to ``balanced``.

    Parameters
    ----------
    loads : LinkLoads
        Of one link.
    body : Body
        Geometry of the link.
    link : str
        Its name.

    Returns
    -------
    LinkLoads
        Loads with pins where they have slid.

    Raises
    ------
    CaseError
        Where a pin has slid out of its slot.
    """
    pins = []
    for pin in loads.pins:
        if pin.slotted:
            across, moment = pin.wrench[1], pin.wrench[5] - pin.rubbed
            slid = moment / across if abs(across) > NOTHING * float(np.linalg.norm(pin.wrench[:3])) else 0.0
            own = next(p for p in body.pins if p.name == pin.name)
            x = in_slot(own, np.array([pin.centre[0] + slid]), link)[0]
            wrench = np.array([pin.friction, across, 0.0, pin.wrench[3], 0.0, pin.rubbed])
            pin = replace(pin, centre=np.array([x, *pin.centre[1:]]), wrench=wrench)
        pins.append(pin)
    return replace(loads, pins=tuple(pins))


def bent(loads: LinkLoads, moved: Mapping[str, Real]) -> LinkLoads:
    """Return the loads of a straight link with pairs of transverse forces that stand for its being bent.

    Between two loaded stations that have left the chord by d1 and d2, a normal force N (tension positive) has the
    moment of the transverse forces N (d2 - d1)/L, one at each station: bending moments at the stations so are those of
    the bent link (the fictitious lateral loads of the P-Δ method: Wilson & Habibullah, Engineering Journal AISC 24
    (1987) 172-175). Transverse forces take the moment of having left their places along.

    Parameters
    ----------
    loads : LinkLoads
        Of the straight link.
    moved : dict of str to ndarray
        Point -> (3,) by which it has left its place in the straight link [mm].

    Returns
    -------
    LinkLoads
        Loads with the pairs of forces.
    """
    names = [*(pin.name for pin in loads.pins), *(end.name for end in loads.ends)]
    held = list(zip(names, loads.wrenches, strict=True))
    stations = sorted(((float(place[0]), name, wrench) for name, (place, wrench) in held), key=itemgetter(0))
    normal, extra = 0.0, {name: np.zeros(6) for name in names}
    for _, name, wrench in stations:
        extra[name][3:] += np.cross(moved[name], [0.0, wrench[1], wrench[2]])
    for (x0, first, wrench), (x1, last, _) in itertools.pairwise(stations):
        normal -= float(wrench[0])
        if x1 - x0 > 0.0:
            shear = normal * (moved[last] - moved[first]) / (x1 - x0)
            extra[first][1:3] += shear[1:]
            extra[last][1:3] -= shear[1:]
    return loads.with_wrenches(wrench + extra[name] for name, (_, wrench) in held)


def balanced(loads: LinkLoads, whole: float = 0.0) -> LinkLoads:
    """Return the loads of a link with what they leave unbalanced taken by a clamp, or by its strongest pin in no slot.

    Spread loads stay on the undeformed axis while the link bends off it, which leaves a little. Where all on the link
    is but ``NOTHING`` of the whole load, it is what the iteration left, and nothing acts.

    Parameters
    ----------
    loads : LinkLoads
        Of one link.
    whole : float, optional
        Sum of all loads on the linkage [N].

    Returns
    -------
    LinkLoads
        Loads that balance.

    Raises
    ------
    CannotRunError
        Where more than ``LARGEST_SHIFT`` of the link's load is unbalanced.
    """
    places, wrenches = map(list, zip(*loads.wrenches, strict=True))
    reach = max(float(np.linalg.norm(place - places[0])) for place in places)
    total = loads.resultant()
    size = sum(float(np.linalg.norm(part[:3])) for part in loads.parts())
    if size <= NOTHING * whole:
        return loads.with_wrenches(np.zeros(6) for _ in loads.wrenches)
    left = max(float(np.linalg.norm(total[:3])), float(np.linalg.norm(total[3:])) / reach if reach else 0.0)
    if left > LARGEST_SHIFT * size:
        raise CannotRunError(
            f"on the deformed shape the loads of a link in case '{loads.name}' leave {left / size:.1%} of them "
            f"unbalanced (at most {LARGEST_SHIFT:.0%}): it bends too far for its undeformed shape to carry them; "
            "stiffen the link"
        )
    clamps = [i for i, end in enumerate(loads.ends, len(loads.pins)) if end.clamped or not loads.pins]
    pins = [i for i, pin in enumerate(loads.pins) if not pin.slotted] or range(len(loads.pins))
    takes, part = (clamps, slice(3, 6)) if clamps else (pins, slice(3))
    holds = max(takes, key=lambda i: float(np.linalg.norm(wrenches[i][part])))
    wrenches[holds] = wrenches[holds] + shifted(-total, -places[holds])
    return loads.with_wrenches(wrenches)
