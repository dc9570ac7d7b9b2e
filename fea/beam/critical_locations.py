"""Hand calculation of the stress at every place of a link that can bear its peak: eyes, holes, loaded ends, sections.

In one state or in n: of these the places are alike, and the stress of each is an array.

Section stresses of beam theory times the handbooks' concentration factors. The factors are for neighbouring shapes
(a shoulder for the junction of an eye, a plate for the eye itself), so that these numbers are estimates, to be used
with the factors that solid models of such links gave (``alula.fea.beam.calibration``). Lengths in mm, forces in N,
moments in N·mm, stresses in MPa.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.deflection import deflection
from alula.fea.beam.flanks import flanks_of
from alula.fea.beam.holes import net_tension, tube_hole_factors
from alula.fea.beam.piecewise import Piecewise, Side, only
from alula.fea.beam.section_stress import bending_stress, equivalent_stress, rim_shear
from alula.fea.beam.theory import largest_stress
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.common.reason import Reason, reason
from alula.geometry.bodies.body import extent, patch_span
from alula.geometry.bodies.eyes import eye_reach
from alula.geometry.bodies.features import Ring
from alula.geometry.parts.part import Body, HoleRow, Pin, Section
from alula.loads.statics.foundation import Foundation

_HEIGHTS = 17
"""Along a bore, at which the pressure of a pin that bends is looked at, with both rims, where it is largest."""
LocationKind = Literal["eye", "hole", "end", "section"]
Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class CriticalLocation:
    """A place of a link and the estimate of the largest von Mises stress there.

    Attributes
    ----------
    kind : Kind
        Of place.
    name : Reason or str
        Such as ``the eye at A``.
    x : float
        Station of its middle [mm].
    low : float
        Station at which it begins [mm].
    high : float
        Station at which it ends [mm].
    each : ndarray, shape (n,)
        By hand in every state [MPa].
    """

    kind: LocationKind
    name: Reason | str
    x: float
    low: float
    high: float
    each: Floats

    @property
    def estimate(self) -> float:
        """The stress of the first state, or of the only one [MPa]."""
        return float(self.each[0])


def critical_locations(body: Body, loads: LinkLoads, forces: Piecewise, poisson: float) -> tuple[CriticalLocation, ...]:
    """Return every critical location of a link.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    loads : LinkLoads
        In n states.
    forces : Piecewise
        Internal forces of all of them, on the link's axis.
    poisson : float
        Poisson's ratio.

    Returns
    -------
    tuple of CriticalLocation
        Eyes, holes, loaded ends; what lies between as one, the last.

    Raises
    ------
    CannotRunError
        For a cross hole outside of the handbook's range.
    """
    first, last = extent(body)
    found = [_eye(body, pin, loads, forces, poisson) for pin in body.pins]
    found += [
        _hole(body, row, number, x, forces, poisson) for number, row in enumerate(body.holes) for x in row.positions
    ]
    for end in loads.ends:
        place = next(e for e in body.ends if e.name == end.name)
        low, high = patch_span(body, place)
        pushed = np.linalg.norm(end.wrench[:, :3], axis=1)
        stress = _largest(body, forces, [(low, high)], poisson) + pushed / (place.patch * body.part.section.width)
        found.append(CriticalLocation(kind="end", name=f"the loaded end at {end.name}", x=end.point[0], low=low,
                                      high=high, each=stress))  # fmt: skip
    rest = CriticalLocation(kind="section", name="the plain section", x=(first + last) / 2.0, low=first, high=last,
                            each=_largest(body, forces, [*_gaps(found, first, last)], poisson))  # fmt: skip
    return (*found, rest)


def displacement_estimate(
    body: Body,
    loads: LinkLoads,
    forces: Piecewise,
    section: Section,
    *,
    young: float,
    poisson: float,
    line: tuple[float, float],
) -> Floats:
    """Estimate the largest displacement of any point, relative to the line through two stations.

    It sums three terms: the displacement of the axis by beam theory, which goes on straight beyond the last load; what
    the rotation of sections and eyes adds at the surface; and the compliance of the eyes under their pins, F/(E t).

    Parameters
    ----------
    body : Body
        Geometry of the link.
    loads : LinkLoads
        In n states.
    forces : Piecewise
        Internal forces of all of them, on the link's axis.
    section : Section
        Of the beam.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.
    line : tuple of 2 float
        x of two stations [mm].

    Returns
    -------
    ndarray, shape (n,)
        Displacement in every state [mm].
    """
    bent = deflection(
        forces, section, young=young, poisson=poisson, line=line, flanks=flanks_of(body), cuts=body.cuts
    ).functions
    first, last = bent.breaks[0], bent.breaks[-1]
    table = np.stack([bent.at(x) for x in np.linspace(first, last, 65)], axis=1)
    table[..., 3] -= (bent.at(line[0])[:, None, 3] + bent.at(line[1])[:, None, 3]) / 2.0
    places = [table[..., :3]]
    low, high = extent(body)
    for end, overhang in ((0, low - first), (-1, high - last)):
        u, v, w, _, turn_y, turn_z = np.moveaxis(table[:, [end]], -1, 0)
        places.append(np.stack([u, v + turn_z * overhang, w - turn_y * overhang], axis=-1))
    axis = np.linalg.norm(np.concatenate(places, axis=1), axis=-1).max(axis=1)
    bending = max(section.half_y, section.half_z) * np.hypot(table[..., 4], table[..., 5])
    rings = {pin.name: body.ring(pin) for pin in body.pins}
    corner = max((math.hypot(ring.diameter, ring.height) / 2.0 for ring in rings.values()), default=0.0)
    twist = corner * np.abs(table[..., 3])
    pinned = [np.linalg.norm(pin.wrench[:, :3], axis=1) / rings[pin.name].thickness for pin in loads.pins]
    return np.asarray(axis + (bending + twist).max(axis=1) + np.max([np.zeros(len(axis)), *pinned], axis=0) / young)


def shoulder_factors(diameter: float, step: float, radius: float) -> tuple[float, float, float]:
    """Return the stress concentration factors of a shaft at a filleted step up.

    K = C1 + C2 s + C3 s² + C4 s³ with s = 2 step/D, for step/radius of 0.1 to 20 in tension and bending and of 0.25 to
    4 in torsion (clipped).

    Parameters
    ----------
    diameter : float
        Of the shaft [mm].
    step : float
        Height of the shoulder on the radius [mm].
    radius : float
        Of the fillet [mm].

    Returns
    -------
    tuple of 3 float
        In tension, bending and torsion.

    References
    ----------
    Pilkey & Pilkey, Peterson's Stress Concentration Factors, 3rd ed., charts 3.4, 3.10 and 3.12.
    """
    t, s = min(max(step / radius, 0.1), 20.0), 2.0 * step / (diameter + 2.0 * step)
    root = math.sqrt(t)
    if t <= 2.0:
        tension = (0.926 + 1.157 * root - 0.099 * t, 0.012 - 3.036 * root + 0.961 * t,
                   -0.302 + 3.977 * root - 1.744 * t, 0.365 - 2.098 * root + 0.878 * t)  # fmt: skip
        bending = (0.947 + 1.206 * root - 0.131 * t, 0.022 - 3.405 * root + 0.915 * t,
                   0.869 + 1.777 * root - 0.555 * t, -0.810 + 0.422 * root - 0.260 * t)  # fmt: skip
    else:
        tension = (1.200 + 0.860 * root - 0.022 * t, -1.805 - 0.346 * root - 0.038 * t,
                   2.198 - 0.486 * root + 0.165 * t, -0.593 - 0.028 * root - 0.106 * t)  # fmt: skip
        bending = (1.232 + 0.832 * root - 0.008 * t, -3.813 + 0.968 * root - 0.260 * t,
                   7.423 - 4.868 * root + 0.869 * t, -3.839 + 3.070 * root - 0.600 * t)  # fmt: skip
    t = min(max(t, 0.25), 4.0)
    root = math.sqrt(t)
    torsion = (0.905 + 0.783 * root - 0.075 * t, -0.437 - 1.969 * root + 0.553 * t,
               1.557 + 1.073 * root - 0.578 * t, -1.061 + 0.171 * root + 0.086 * t)  # fmt: skip
    found = [max(1.0, sum(c * s**power for power, c in enumerate(row))) for row in (tension, bending, torsion)]
    return found[0], found[1], found[2]


def forces_at(forces: Piecewise, x: float, side: Side = "after") -> Floats:
    """Return the internal forces at a station.

    Parameters
    ----------
    forces : Piecewise
        Of one state or of n.
    x : float
        Station [mm].
    side : Side, optional
        Which value, where forces jump at x.

    Returns
    -------
    ndarray, shape (6,) or (n, 6)
        Forces; zero on what stands out beyond the last loaded station.
    """
    inside = forces.breaks[0] <= x <= forces.breaks[-1]
    return forces.at(x, side) if inside else np.zeros((*forces.coefficients.shape[:-3], 6))


def _gaps(found: list[CriticalLocation], first: float, last: float) -> Iterator[tuple[float, float]]:
    """Stretches between the locations."""
    reach = first
    for low, high in sorted((location.low, location.high) for location in found):
        if low > reach:
            yield reach, low
        reach = max(reach, high)
    if last > reach:
        yield reach, last


def _largest(body: Body, forces: Piecewise, stretches: Sequence[tuple[float, float]], poisson: float) -> Floats:
    """Largest equivalent stress (n,) by beam theory on some stretches."""
    return largest_stress(only(forces, stretches), body.part.section, poisson)


def _eye(body: Body, pin: Pin, loads: LinkLoads, forces: Piecewise, poisson: float) -> CriticalLocation:
    part, (first, last) = body.part, extent(body)
    reach = eye_reach(body, pin)
    pushed = next(p for p in loads.pins if p.name == pin.name)
    torque = pushed.wrench[:, 5] + sum(couple.torque for couple in loads.couples if couple.pin == pin.name)
    nothing = np.zeros(pushed.wrench.shape)
    before = forces_at(forces, pin.x, "before") if pin.x > forces.breaks[0] else nothing
    after = forces_at(forces, pin.x, "after") if pin.x < forces.breaks[-1] else nothing
    found = [_bore(body, pin, pushed, torque, before, after)]
    sides: tuple[tuple[float, Side], ...] = ((pin.x - reach, "after"), (pin.x + reach, "before"))
    found += [_junction(body, pin, forces_at(forces, x, side), poisson) for x, side in sides if first < x < last]
    far = reach + part.section.width / 2.0
    return CriticalLocation(kind="eye", name=f"the eye at {pin.name}", x=pin.x, low=pin.x - far, high=pin.x + far,
                each=np.max(found, axis=0))  # fmt: skip


def _with_unit_torque(section: Section, forces: Floats, poisson: float) -> tuple[float, Floats]:
    """Largest shear stress of a unit torque, and equivalent stress (n,) of internal forces (n, 6)."""
    found = equivalent_stress(section, np.vstack([np.eye(6)[3], forces]), poisson)
    return float(found[0]) / math.sqrt(3.0), found[1:]


def _junction(body: Body, pin: Pin, forces: Floats, poisson: float) -> Floats:
    """Stress (n,) at the fillet between the section and an eye under the section's forces (n, 6)."""
    section, width = body.part.section, body.part.section.width
    unit, sheared = _with_unit_torque(section, forces * [0.0, 1.0, 1.0, 0.0, 0.0, 0.0], poisson)
    tension, bending, torsion = shoulder_factors(
        width, (body.ring(pin).diameter - width) / 2.0, body.part.fillet_radius
    )
    bent = bending_stress(section, forces[:, 4], forces[:, 5])
    direct = tension * np.abs(forces[:, 0]) / section.area + bending * bent
    return np.hypot(direct, math.sqrt(3.0) * torsion * unit * np.abs(forces[:, 3]) + sheared)


def _bore(body: Body, pin: Pin, load: PinLoad, torque: Floats, before: Floats, after: Floats) -> Floats:
    """Stress (n,) at the edge of a pin hole.

    Of the pin's push after Pilkey & Pilkey, 3rd ed., chart 4.67 (close-fitting pin in a strip, net section, d/D of 0.15
    to 0.75, clipped; it holds for an edge one width or more beyond the pin, and an eye has half a width, which the
    calibration takes up), as if the largest pressure along the bore were that all along it; of what passes through
    the eye, with the factors of a hole in a plate: 3 in tension and in bending out of the plane, 2 in bending in the
    plane; of a torque that the bore takes by shear.
    """
    ring, hole = body.ring(pin), pin.diameter
    wide, thick = ring.diameter, ring.thickness
    h = min(max(hole / wide, 0.15), 0.75)
    factor = 12.882 - 52.714 * h + 89.762 * h**2 - 51.667 * h**3
    pushed = factor * net_tension(1.0, wide, hole, thick) * _largest_push(ring, load)
    larger, passing = np.maximum(np.abs(before), np.abs(after)).T, before[:, 0] * after[:, 0] > 0.0
    through = np.where(passing, np.minimum(np.abs(before[:, 0]), np.abs(after[:, 0])), 0.0)
    n = 3.0 * through / ((wide - hole) * thick)
    in_plane = 2.0 * 6.0 * larger[5] * hole / (thick * (wide**3 - hole**3))
    out_of_plane = 3.0 * 6.0 * larger[4] / ((wide - hole) * thick**2)
    twisted = math.sqrt(3.0) * 2.0 * larger[3] / (0.2 * (wide - hole) * thick * min(wide, thick))
    sheared = math.sqrt(3.0) * 2.0 * np.abs(torque) / (math.pi * hole**2 * thick)
    return np.asarray(pushed + n + in_plane + out_of_plane + twisted + sheared)


def _largest_push(ring: Ring, load: PinLoad) -> Floats:
    """Largest resultant (n,) per length along a bore, times the bore's length [N].

    It is F + 6M/t of a stiff pin; one that bends presses more on the rim at which it is loaded
    (``alula.loads.statics.foundation``).
    """
    wrenches = load.wrench
    tilted = ring.thickness * max(ring.high - ring.middle, ring.middle - ring.low) / ring.second
    stiff = np.linalg.norm(wrenches[:, :3], axis=1) + tilted * np.linalg.norm(wrenches[:, 3:5], axis=1)
    foundation = Foundation.of(load.seat)
    if foundation is None:
        return np.asarray(stiff)
    force = wrenches[:, :2]
    moment = np.column_stack([wrenches[:, 4], -wrenches[:, 3]]) - ring.middle * force
    even, turning = foundation.shapes(np.linspace(-0.5, 0.5, _HEIGHTS)[:, None, None] * foundation.length)
    along = np.linalg.norm(even * force + turning * moment, axis=2)
    return np.asarray(np.maximum(stiff, along.max(axis=0) * foundation.length))


def _hole(body: Body, row: HoleRow, number: int, x: float, forces: Piecewise, poisson: float) -> CriticalLocation:
    """Stress at the rim of a cross hole: N and M with the handbook's factors on the gross section, shear with 4.

    The shear of V is that where the hole opens: on a tube the wall's mean at the neutral axis, 4V/3A (1+m+m²)/(1+m²)
    with m the ratio of the radii (Gere & Goodno, 8th ed., section 5.9), on a bar that of the rim.
    """
    part, section = body.part, body.part.section
    here = forces_at(forces, x)
    n, v_y, v_z, t, m_y, m_z = here.T
    unit, plain = _with_unit_torque(section, here, poisson)
    opened, across = (m_z, m_y) if row.along == "y" else (m_y, m_z)
    shear = v_z if row.along == "y" else v_y
    if section.round:
        tension, bending = tube_hole_factors(section.width, section.radius_ratio * section.width, row.diameter)
        at_rim, aside = section.half_y / section.i_z, section.half_y / section.i_z
        m = section.radius_ratio
        transverse = 4.0 / 3.0 * (1.0 + m + m**2) / (1.0 + m**2) * np.abs(shear) / section.area
    else:
        width = part.section.across(row.along)
        h = row.diameter / width
        # Roark, 8th ed., table 17.1, case 7a (tension of a plate with a central hole), on the gross section.
        tension = (3.0 - 3.14 * h + 3.667 * h**2 - 1.527 * h**3) / (1.0 - h)
        bending = tension
        half, second = (section.half_y, section.i_z) if row.along == "y" else (section.half_z, section.i_y)
        other, other_second = (section.half_z, section.i_y) if row.along == "y" else (section.half_y, section.i_z)
        at_rim, aside = half / second, other / other_second
        transverse = rim_shear(section, poisson)[1 if row.along == "y" else 0] * np.abs(shear)
    axial = np.abs(n) / section.area
    rim = tension * axial + bending * np.abs(opened) * at_rim + 4.0 * (unit * np.abs(t) + transverse)
    each = np.max([rim, plain, axial + np.abs(across) * aside + rim / 3.0], axis=0)
    return CriticalLocation(kind="hole", name=reason("hole_of_row", x=x, row=number + 1), x=x, low=x - row.diameter,
                high=x + row.diameter, each=each)  # fmt: skip
