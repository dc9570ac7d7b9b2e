"""Hand calculation where a link's plain section does not decide: the net section and the flanks of a slot, arms.

A slot leaves two flanks side by side, joined by its round ends: a frame without diagonals. With c the distance of the
flanks' axes, h their height and t their thickness, the section's moment M over the slot's length splits into its mean,
which the net section bears as a whole, and what is left, which bends each flank by half of it (Vierendeel; the flanks'
ends turn alike, so that it has no mean). The pin's push F on one flank is F/2 on both, which is in M, and F/2 to either
side, which bends each flank as a beam built in at both ends (Roark, 8th ed., table 8.1, case 1d). The round ends give
a little, so the flanks count a quarter of the slot's width longer at either end.

An arm is a straight bar built in at the eye from which it starts, under the force of its pin alone.
Lengths in mm, forces in N, moments in N·mm, stresses in MPa.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.beam import Floats, Piecewise, SectionStress, section_stress
from fea.flanks import flanks_of
from fea.link_loads import LinkLoads, PinLoad
from geometry.part import Body, Disc, Pin, Section, rectangle

_SAMPLES = 33
SLENDER = 4.0
"""Length over height from which a flank counts as a beam; below, its stress by hand is an estimate."""


@dataclass(frozen=True, kw_only=True)
class Detail:
    """The largest stress by hand at one detail: ``name`` for people, station x, what its number holds."""

    name: str
    x: float
    stress: SectionStress
    remark: str


def details(body: Body, loads: LinkLoads, forces: Piecewise) -> tuple[Detail, ...]:
    """Return the details of a link under one load case, given the internal forces along its axis."""
    pushed = {load.name: load for load in loads.pins}
    found = [_slot(body, pin, pushed[pin.name], forces) for pin in body.pins if pin.slot > 0.0]
    found += [_arm(body, pin, pin.foot, pushed[pin.name]) for pin in body.pins if pin.foot is not None]
    return tuple(found)


def remarks(body: Body, found: Sequence[Detail]) -> tuple[str, ...]:
    """Say what hand calculation found at the details, and where its section is but an estimate."""
    said = [f"by hand {d.name} bears {d.stress.equivalent:.3g} MPa at x = {d.x:.3g} mm ({d.remark})" for d in found]
    if any(pin.slot > 0.0 for pin in body.pins):
        said.append("as a solid a pin pushes on half, and for the band on a quarter of its diameter, of a slot's flank")
    if isinstance(body.part, Disc):
        said.append(
            "hand calculation takes the disc for a beam of its narrowest net section between its holes: an estimate, "
            "since beam theory needs a length of several widths"
        )
    return tuple(said)


def net_section(width: float, slot: float, thickness: float) -> Section:
    """Return the two flanks that a slot leaves of a bar, as one section; J is that of two separate rectangles."""
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
    """Moments along a beam built in at both ends under a force at a place (Roark, 8th ed., table 8.1, case 1d).

    With b = length - at: M(0) = -F at b²/L², M(at) = 2 F at² b²/L³, M(L) = -F at² b/L², linear between.
    """
    b = length - at
    ends = -force * at * b**2 / length**2, 2.0 * force * at**2 * b**2 / length**3, -force * at**2 * b / length**2
    return np.interp(x, [0.0, at, length], ends)


def _slot(body: Body, pin: Pin, load: PinLoad, forces: Piecewise) -> Detail:
    part = body.part
    wide, thick = part.eye_diameter, part.eye_thickness
    (flanks,) = (found for found in flanks_of(body) if found.first < pin.x < found.last)
    height, length = flanks.height, flanks.length
    low, high = pin.span
    net = net_section(wide, pin.diameter, thick)
    place = float(load.centre[0])
    stations = np.union1d(np.linspace(flanks.first, flanks.last, _SAMPLES), [low, place, high])
    table = np.array([_inside(forces, x, side) for x in stations for side in ("before", "after")])
    x = np.repeat(stations, 2)
    moment = table[:, 5]
    mean = float(np.trapezoid(moment, x)) / length
    push = flank_moments(length, place - flanks.first, abs(float(load.wrench[1])) / 2.0, x - x[0])
    local = 6.0 * (np.abs(moment - mean) / 2.0 + np.abs(push)) / (thick * height**2)
    best: tuple[float, float, SectionStress] | None = None
    for station, row, bent in zip(x, table, local, strict=True):
        whole = section_stress(net, np.array([*row[:5], mean]))
        stress = SectionStress(
            axial=whole.axial, bending=whole.bending + float(bent), torsion=whole.torsion, shear=whole.shear
        )
        if best is None or stress.equivalent > best[0]:
            best = (stress.equivalent, float(station), stress)
    assert best is not None
    slender = length / height
    remark = f"net section of two flanks {height:.3g} mm high, and their own bending"
    if slender < SLENDER:
        remark += f"; an estimate, since they are but {slender:.2g} times as long as high"
    return Detail(name=f"the slot at {pin.name}", x=best[1], stress=best[2], remark=remark)


def _inside(forces: Piecewise, x: float, side: str) -> NDArray[np.float64]:
    """Internal forces (6,) at a station, zero beyond the loads."""
    first, last = forces.breaks[0], forces.breaks[-1]
    if x < first or x > last or (x == first and side == "before") or (x == last and side == "after"):
        return np.zeros(6)
    return np.asarray(forces.at(x, "before" if side == "before" else "after"))


def _arm(body: Body, pin: Pin, foot: tuple[float, float], load: PinLoad) -> Detail:
    part = body.part
    start, end = np.array([*foot, 0.0]), np.array([pin.x, pin.y, 0.0])
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    axes = np.array([along, [-along[1], along[0], 0.0], [0.0, 0.0, 1.0]])
    root = start + along * part.eye_diameter / 2.0
    moment = load.wrench[3:] + np.cross(end - root, load.wrench[:3])
    stress = section_stress(part.section, np.concatenate([axes @ load.wrench[:3], axes @ moment]))
    remark = "its own section at the eye from which it starts, under the pin's force alone"
    return Detail(name=f"the arm to {pin.name}", x=foot[0], stress=stress, remark=remark)
