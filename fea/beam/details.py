"""Hand calculation where a link's plain section does not decide: the net section and the flanks of a slot, arms.

A slot leaves two flanks side by side, joined by its round ends: a frame without diagonals. With c the distance of the
flanks' axes, h their height and t their thickness, the section's moment M over the slot's length splits into its mean,
which the net section bears as a whole, and what is left, which bends each flank by half of it (Vierendeel; the flanks'
ends turn alike, so that it has no mean). The pin's push F on one flank is F/2 on both, which is in M, and F/2 to either
side, which bends each flank as a beam built in at both ends (Roark, 8th ed., table 8.1, case 1d). The sizes of these
moments are added, whatever their signs: pushed beside the middle of its slot, a bar's largest tension is so 2 % high,
and with signs 6 % low (``tests/verification/test_slotted_bar.py``). The round ends give a little, so the flanks count a
quarter of the slot's width longer at either end. Each flank twists under half of the torque; that the slot's ends hold
its warping is left out. Where that counts, flanks of h << t bend instead of twisting, with at most 3 % more stress.

An arm is a straight bar built in at the eye from which it starts, under the force of its pin alone.

The cheeks of a fork are bars built in at the root of its gap. Each bears half of the pin's force and what a couple of
the pin adds as a pressure linear along the walls, q = D z/I with D = ∫ z q dz; a thrust acts on one of them.

A pin through the walls of a tube leaves the net section of ``alula.fea.beam.holed_tube``.
Lengths in mm, forces in N, moments in N·mm, stresses in MPa. The stress of a detail is given as that of its section:
axial N/A of the net section, bending what comes on top at the worst fibre of a flank.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_beam import cut_remark
from alula.fea.beam.flanks import flanks_of
from alula.fea.beam.holed_tube import holed_tube_stress
from alula.fea.beam.piecewise import Piecewise
from alula.fea.beam.section_stress import SectionStress, equivalent_stress, section_stress
from alula.fea.beam.theory import Floats
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.common.reason import Reason, reason
from alula.geometry.bodies.body import extent
from alula.geometry.parts.part import Body, Pin, Section, rectangle

_SAMPLES = 33
SLENDER = 4.0
"""Length over height from which a flank counts as a beam; below, its stress by hand is an estimate."""


@dataclass(frozen=True, kw_only=True)
class Detail:
    """The largest stress by hand at one detail.

    Attributes
    ----------
    name : str
        Such as ``the slot at A``.
    x : float
        Station [mm].
    stress : SectionStress
        The largest.
    remark : Reason
        What its number holds.
    """

    name: str
    x: float
    stress: SectionStress
    remark: Reason


def details(body: Body, loads: LinkLoads, forces: Piecewise, poisson: float = 0.3) -> tuple[Detail, ...]:
    """Return the details of a link under one load case.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    loads : LinkLoads
        Of one load case.
    forces : Piecewise
        Internal forces along the axis.
    poisson : float, optional
        Poisson's ratio, which tells how the shear stress of V is spread.

    Returns
    -------
    tuple of Detail
        One per slot, arm, fork and pin through the walls of a tube; none of a part that is no beam.
    """
    if not has_details(body):
        return ()
    pushed = {load.name: load for load in loads.pins}
    found = [_slot(body, pin, pushed[pin.name], forces, poisson) for pin in body.pins if pin.slot > 0.0]
    found += [_arm(body, pin, pin.foot, pushed[pin.name], poisson) for pin in body.pins if pin.foot is not None]
    torques = {couple.pin: float(couple.torque) for couple in loads.couples}
    forks = [pin for pin in body.pins if pin.fork is not None]
    found += [_fork(body, pin, pushed[pin.name], torques.get(pin.name, 0.0), poisson) for pin in forks]
    if body.part.section.round:
        found += [_through(body, pin, forces, poisson) for pin in body.pins if body.ring(pin).diameter == 0.0]
    return tuple(found)


def has_details(body: Body) -> bool:
    """Return True for a link that has details.

    Parameters
    ----------
    body : Body
        Geometry of the link.

    Returns
    -------
    bool
    """
    through = body.part.section.round
    return body.part.is_beam and any(
        pin.slot > 0.0 or pin.foot is not None or pin.fork is not None or (through and body.ring(pin).diameter == 0.0)
        for pin in body.pins
    )


def remarks(body: Body, found: Sequence[Detail]) -> tuple[Reason | str, ...]:
    """Return what hand calculation found at the details, and where its section is but an estimate.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    found : sequence of Detail
        Its details.

    Returns
    -------
    tuple of Reason or str
        A text is the part's own.
    """
    said: list[Reason | str] = [
        reason("detail_bears", name=d.name, stress=d.stress.equivalent, x=d.x, remark=d.remark) for d in found
    ]
    if any(pin.slot > 0.0 for pin in body.pins):
        said.append(reason("pin_on_slot_flank"))
    said += [told for told in (body.part.by_hand, cut_remark(body)) if told]
    rings = {pin.name: body.ring(pin) for pin in body.pins}
    shares = [reason("share_of_bore", pin=pin, share=ring.share) for pin, ring in rings.items() if ring.share < 1.0]
    if shares:
        said.append(reason("open_bores", shares=shares))
    middles = [reason("middle_of_bore", pin=pin, z=ring.middle) for pin, ring in rings.items() if ring.off_plane]
    if middles:
        said.append(reason("bores_off_plane", middles=middles))
    return tuple(said)


def net_section(width: float, slot: float, thickness: float) -> Section:
    """Return the two flanks that a slot leaves of a bar, as one section; J is that of two separate rectangles.

    Parameters
    ----------
    width : float
        Of the bar [mm].
    slot : float
        Width of the slot [mm].
    thickness : float
        Of the bar [mm].

    Returns
    -------
    Section
        Section of both flanks together.
    """
    flank = rectangle((width - slot) / 2.0, thickness)
    return Section(
        area=(width - slot) * thickness,
        i_y=(width - slot) * thickness**3 / 12.0,
        i_z=thickness * (width**3 - slot**3) / 12.0,
        torsion=2.0 * flank.torsion,
        half_y=width / 2.0,
        half_z=thickness / 2.0,
        round=False,
    )


def flank_moments(length: float, at: float, force: float, x: Floats) -> Floats:
    """Return the moments along a beam built in at both ends under a force.

    With b = length - at: M(0) = -F at b²/L², M(at) = 2 F at² b²/L³, M(L) = -F at² b/L², linear between.

    Parameters
    ----------
    length : float
        Of the beam [mm].
    at : float
        Distance of the force from its start [mm].
    force : float
        Across the beam [N].
    x : ndarray, shape (n,)
        Stations from its start [mm].

    Returns
    -------
    ndarray, shape (n,)
        Moments [N·mm].

    References
    ----------
    Roark's Formulas for Stress and Strain, 8th ed., table 8.1, case 1d.
    """
    b = length - at
    ends = -force * at * b**2 / length**2, 2.0 * force * at**2 * b**2 / length**3, -force * at**2 * b / length**2
    return np.interp(x, [0.0, at, length], ends)


def _slot(body: Body, pin: Pin, load: PinLoad, forces: Piecewise, poisson: float) -> Detail:
    wide, thick = body.ring(pin).diameter, body.ring(pin).thickness
    (flanks,) = (found for found in flanks_of(body) if found.first < pin.x < found.last)
    height, length = flanks.height, flanks.length
    low, high = pin.span
    net, flank = net_section(wide, pin.diameter, thick), flanks.one
    place = float(load.centre[0])
    stations = np.union1d(np.linspace(flanks.first, flanks.last, _SAMPLES), [low, place, high])
    table = np.array([_inside(forces, x, side) for x in stations for side in ("before", "after")])
    x = np.repeat(stations, 2)
    mean = float(np.trapezoid(table[:, 5], x)) / length
    force = abs(float(load.wrench[1])) / 2.0
    push = flank_moments(length, place - flanks.first, force, x - x[0])
    found: list[tuple[float, float, Floats]] = []
    for station, row, apart in zip(x, table, push, strict=True):
        for side in (1.0, -1.0):
            # N of the mean moment, to either side; M of the net section's curvature, of what is left, of the push.
            own = row / 2.0
            own[0] += side * flank.area * mean * flanks.apart / 2.0 / net.i_z
            own[5] = abs(mean) * flank.i_z / net.i_z + abs(row[5] - mean) / 2.0 + abs(apart)
            found.append((float(station), row[0] / net.area, own))
    worst = int(np.argmax(equivalent_stress(flank, np.array([own for *_, own in found]), poisson)))
    worst_x, axial, own = found[worst]
    stress = section_stress(flank, own, poisson)
    stress = replace(stress, axial=float(axial), bending=abs(stress.axial - float(axial)) + stress.bending)
    slender = length / height
    kind = "net_section_of_flanks" if slender >= SLENDER else "net_section_of_stocky_flanks"
    remark = reason(kind, height=height, slender=slender)
    return Detail(name=f"the slot at {pin.name}", x=worst_x, stress=stress, remark=remark)


def _through(body: Body, pin: Pin, forces: Piecewise, poisson: float) -> Detail:
    table = [_inside(forces, pin.x, side) for side in ("before", "after")]
    found = [holed_tube_stress(body.part.section, pin.diameter, pin.y, row, poisson) for row in table]
    remark = reason("net_section_of_walls")
    worst = max(found, key=lambda stress: stress.equivalent)
    return Detail(name=f"the pin hole at {pin.name}", x=pin.x, stress=worst, remark=remark)


def _inside(forces: Piecewise, x: float, side: str) -> NDArray[np.float64]:
    """Internal forces (6,) at a station, zero beyond the loads."""
    first, last = forces.breaks[0], forces.breaks[-1]
    if x < first or x > last or (x == first and side == "before") or (x == last and side == "after"):
        return np.zeros(6)
    return np.asarray(forces.at(x, "before" if side == "before" else "after"))


def _fork(body: Body, pin: Pin, load: PinLoad, torque: float, poisson: float) -> Detail:
    assert pin.fork is not None
    ring, wide = body.ring(pin), 2.0 * body.part.half_width(body, pin.x)
    if pin.foot is None:
        along = np.array([1.0 if pin.x > sum(extent(body)) / 2.0 else -1.0, 0.0, 0.0])
    else:
        wide, along = body.part.arm_section.width, np.array([pin.x - pin.foot[0], pin.y - pin.foot[1], 0.0])
        along = along / np.linalg.norm(along)
    axes = np.array([along, [-along[1], along[0], 0.0], [0.0, 0.0, 1.0]])
    cheek = rectangle(wide, (body.part.section.height - pin.fork.gap) / 2.0)
    tilt = np.array([load.wrench[4], -load.wrench[3], 0.0]) / ring.second
    found = []
    for (low, high), thrust in itertools.product(ring.walls, (0.0, 1.0)):
        length, middle = high - low, (low + high) / 2.0
        force = np.array([*load.wrench[:2], 0.0]) * length / ring.thickness + tilt * length * middle
        force[2] = thrust * load.wrench[2]
        own = np.cross([0.0, 0.0, 1.0], tilt * length**3 / 12.0)
        own[2] = (load.wrench[5] + torque) * length / ring.thickness
        moment = own + np.cross(along * pin.fork.depth, force)
        found.append(section_stress(cheek, np.concatenate([axes @ force, axes @ moment]), poisson))
    remark = reason("cheek_built_in")
    worst = max(found, key=lambda stress: stress.equivalent)
    return Detail(name=f"the fork at {pin.name}", x=pin.x, stress=worst, remark=remark)


def _arm(body: Body, pin: Pin, foot: tuple[float, float], load: PinLoad, poisson: float) -> Detail:
    part = body.part
    start, end = np.array([*foot, 0.0]), np.array([pin.x, pin.y, 0.0])
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    axes = np.array([along, [-along[1], along[0], 0.0], [0.0, 0.0, 1.0]])
    root = start + along * body.arm_root(pin)
    moment = load.wrench[3:] + np.cross(end - root, load.wrench[:3])
    stress = section_stress(part.arm_section, np.concatenate([axes @ load.wrench[:3], axes @ moment]), poisson)
    remark = reason("section_of_arm")
    return Detail(name=f"the arm to {pin.name}", x=foot[0], stress=stress, remark=remark)
