"""Hand calculation of one link: a straight beam under a balanced set of loads.

The beam lies along the x axis of its link's frame; y is in the linkage's plane, z along the pins. Lengths are
in mm, forces in N, moments in N·mm, stresses in MPa.

Sign convention: the internal forces at x are what the part beyond x does to the part before it, so N > 0 is
tension, and V_y, V_z, T (= M_x), M_y, M_z are components of vectors along the axes of the frame (right-hand
rule). With loads q per length, equilibrium of a slice gives (Gere & Goodno, Mechanics of Materials, 8th ed.,
section 4.4, there with the opposite sign of V)

    dN/dx = -q_x,  dV_y/dx = -q_y,  dV_z/dx = -q_z,  dT/dx = 0,  dM_y/dx = V_z,  dM_z/dx = -V_y

and M_z > 0 compresses the side y > 0 (``fea.beam.section_stress``).
Everything is a piecewise polynomial (N, V of degree 2, M of degree 3 under linearly varying line loads), kept as
such and therefore exact at every station.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fea.beam.flanks import Flanks
from fea.beam.section_stress import SectionStress, equivalent_stress, section_stress
from geometry.base.errors import CannotRunError
from geometry.parts.part import Section

Floats = NDArray[np.float64]
Side = Literal["before", "after"]

LARGEST_IMBALANCE = 1e-6
"""Resultant over load above which a set of loads is refused as unbalanced."""
_SAMPLES = 33
_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0


def _frozen(values: ArrayLike, name: str, *shapes: int) -> Floats:
    """Return a read-only copy of a vector, refused unless finite and of one of the given lengths."""
    array = np.array(values, dtype=np.float64)
    if array.ndim != 1 or array.size not in shapes or not np.isfinite(array).all():
        raise CannotRunError(f"{name} {array.tolist()} must be {' or '.join(map(str, shapes))} finite numbers")
    array.setflags(write=False)
    return array


@dataclass(frozen=True, kw_only=True, eq=False)
class PointLoad:
    """A wrench at a point of the link, in the link's frame.

    point   (3,) x, y, z [mm] (two numbers mean z = 0); off the axis it adds the moment of its force
    wrench  (6,) Fx, Fy, Fz [N], Mx, My, Mz [N·mm]
    """

    point: Floats
    wrench: Floats

    def __post_init__(self) -> None:
        """Copy, complete and check the arrays."""
        point = _frozen(self.point, "the point of a load", 2, 3)
        object.__setattr__(self, "point", _frozen([*point, 0.0][:3], "the point of a load", 3))
        object.__setattr__(self, "wrench", _frozen(self.wrench, "the wrench of a load", 6))

    @property
    def on_axis(self) -> Floats:
        """The same wrench (6,), reduced to the point (x, 0, 0) of the axis."""
        arm = np.array([0.0, self.point[1], self.point[2]])
        return np.concatenate([self.wrench[:3], self.wrench[3:] + np.cross(arm, self.wrench[:3])])


@dataclass(frozen=True, kw_only=True, eq=False)
class LineLoad:
    """A force per length on the axis, varying linearly between two stations.

    start, end   x [mm], start < end
    first, last  (3,) force per length at start and at end [N/mm], in the link's frame; equal for a uniform load
    """

    start: float
    end: float
    first: Floats
    last: Floats

    def __post_init__(self) -> None:
        """Copy and check the arrays."""
        if not (np.isfinite([self.start, self.end]).all() and self.start < self.end):
            raise CannotRunError(f"a line load from x = {self.start:g} mm to {self.end:g} mm needs start < end")
        object.__setattr__(self, "first", _frozen(self.first, "a line load", 3))
        object.__setattr__(self, "last", _frozen(self.last, "a line load", 3))

    @property
    def resultant(self) -> tuple[float, Floats]:
        """Station of the mean force's moment and wrench (6,) about that station: the load as one wrench at mid-length.

        Force (first + last) L/2 at the middle, with the couple e_x × (last - first) L²/12.
        """
        length = self.end - self.start
        slope = (self.last - self.first) * length**2 / 12.0
        couple = np.array([0.0, -slope[2], slope[1]])
        return (self.start + self.end) / 2.0, np.concatenate([(self.first + self.last) * length / 2.0, couple])


@dataclass(frozen=True, kw_only=True, eq=False)
class BeamLoads:
    """All that acts on one link, joint forces included: a balanced set."""

    points: tuple[PointLoad, ...]
    lines: tuple[LineLoad, ...] = ()

    @property
    def span(self) -> tuple[float, float]:
        """The x of the first and of the last loaded station [mm]."""
        stations = [float(p.point[0]) for p in self.points] + [x for q in self.lines for x in (q.start, q.end)]
        if not stations or min(stations) == max(stations):
            raise CannotRunError("a beam needs loads at two stations or more; give the point loads of every joint")
        return min(stations), max(stations)

    @property
    def size(self) -> float:
        """Length scale for moments: the largest extent of the loaded points along any axis [mm]."""
        x0, x1 = self.span
        across = [np.abs(p.point[1:]).max() for p in self.points]
        return max(x1 - x0, *map(float, across), 0.0)

    @property
    def scale(self) -> float:
        """Sum of the magnitudes of all loads [N], moments divided by ``size``."""
        total = 0.0
        for p in self.points:
            total += float(np.linalg.norm(p.wrench[:3]) + np.linalg.norm(p.wrench[3:]) / self.size)
        for q in self.lines:
            mean = (np.linalg.norm(q.first) + np.linalg.norm(q.last)) / 2.0
            total += float(mean) * (q.end - q.start)
        return total

    @property
    def resultant(self) -> Floats:
        """The wrench (6,) of all loads about the middle of the span [N, N·mm]; zero where they balance."""
        middle = sum(self.span) / 2.0
        total = np.zeros(6)
        wrenches = [(float(p.point[0]), p.on_axis) for p in self.points] + [q.resultant for q in self.lines]
        for x, wrench in wrenches:
            total += wrench
            total[4] -= (x - middle) * wrench[2]
            total[5] += (x - middle) * wrench[1]
        return total

    @property
    def imbalance(self) -> float:
        """Resultant over the sum of the loads' magnitudes (moments over ``size``)."""
        if self.scale == 0.0:
            return 0.0
        force, moment = np.linalg.norm(self.resultant[:3]), np.linalg.norm(self.resultant[3:]) / self.size
        return float(max(force, moment)) / self.scale


def _derivative(c: Floats) -> Floats:
    return c[..., 1:] * np.arange(1, c.shape[-1])


def _integral(c: Floats, constant: Floats) -> Floats:
    powers = np.arange(1, c.shape[-1] + 1)
    return np.concatenate([constant[..., None], c / powers], axis=-1)


def _values(c: Floats, s: float | Floats) -> Floats:
    """Polynomials with coefficients c (..., k), lowest power first, at s."""
    value = np.zeros(c.shape[:-1])
    for power in range(c.shape[-1] - 1, -1, -1):
        value = value * s + c[..., power]
    return value


@dataclass(frozen=True, kw_only=True, eq=False)
class Piecewise:
    """Some functions of x, each a polynomial between neighbouring stations.

    breaks        (k + 1,) stations, rising [mm]
    coefficients  (k, m, p) of m functions in powers 0..p-1 of the distance from the interval's first station
    """

    breaks: Floats
    coefficients: Floats

    def at(self, x: float, side: Side = "after") -> Floats:
        """Return the m functions at x; where they jump there, ``side`` tells before from after the jump.

        At the first station "before" and at the last "after" lie outside the beam: there the one-sided value
        inside is returned. Raises ``CannotRunError`` for x off the beam.
        """
        first, last = self.breaks[0], self.breaks[-1]
        slack = 1e-9 * (last - first)
        if not first - slack <= x <= last + slack:
            raise CannotRunError(f"station x = {x:g} mm lies off the beam, which runs from {first:g} to {last:g} mm")
        interval = int(np.searchsorted(self.breaks, x, side="right" if side == "after" else "left")) - 1
        interval = min(max(interval, 0), len(self.coefficients) - 1)
        return _values(self.coefficients[interval], x - self.breaks[interval])

    def largest(self, measure: Callable[[Floats], float]) -> tuple[float, Side, float]:
        """Return station, side and value of the largest measure of the functions over the beam.

        Both ends of every interval are tried, and inside it samples, the best of them refined by golden section;
        a measure that is convex where the functions are linear (any norm) so has its maximum found exactly there.
        """
        best: tuple[float, Side, float] = (float(self.breaks[0]), "after", -np.inf)
        for c, x0, x1 in zip(self.coefficients, self.breaks[:-1], self.breaks[1:], strict=True):
            h = float(x1 - x0)

            def value(s: float, c: Floats = c) -> float:
                return measure(_values(c, s))

            grid = np.linspace(0.0, h, _SAMPLES if np.any(c[:, 2:]) else 2)
            found = [value(s) for s in grid]
            i = int(np.argmax(found))
            s, peak = float(grid[i]), found[i]
            if 0 < i < len(grid) - 1:
                s, peak = _golden(value, float(grid[i - 1]), float(grid[i + 1]), s, peak)
            if peak > best[2]:
                best = (float(x1), "before", peak) if i == len(grid) - 1 else (float(x0) + s, "after", peak)
        return best


def _golden(value: Callable[[float], float], low: float, high: float, s: float, peak: float) -> tuple[float, float]:
    """Golden-section search for a maximum; the start (s, peak) is kept if nothing better turns up."""
    for _ in range(60):
        a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        fa, fb = value(a), value(b)
        low, high = (low, b) if fa > fb else (a, high)
        if max(fa, fb) > peak:
            s, peak = (a, fa) if fa > fb else (b, fb)
    return s, peak


def internal_forces(loads: BeamLoads) -> Piecewise:
    """N, V_y, V_z [N], T, M_y, M_z [N·mm] (in this order) along the beam, signs as in the module's docstring.

    Raises ``CannotRunError``, naming the resultant, where the loads do not balance to 1e-6 of their sum.
    """
    if loads.imbalance > LARGEST_IMBALANCE:
        force, moment = loads.resultant[:3], loads.resultant[3:]
        raise CannotRunError(
            f"the loads of a beam do not balance: resultant force ({force[0]:.6g}, {force[1]:.6g}, {force[2]:.6g}) N, "
            f"moment ({moment[0]:.6g}, {moment[1]:.6g}, {moment[2]:.6g}) N·mm about its middle, "
            f"{loads.imbalance:.3g} of the load where {LARGEST_IMBALANCE:g} is allowed; check the joint forces"
        )
    stations = [float(p.point[0]) for p in loads.points] + [x for q in loads.lines for x in (q.start, q.end)]
    breaks = np.unique(stations)
    coefficients = np.zeros((len(breaks) - 1, 6, 4))
    state = np.zeros(6)
    for i, (x, h) in enumerate(zip(breaks[:-1], np.diff(breaks), strict=True)):
        for p in loads.points:
            if p.point[0] == x:
                state = state - p.on_axis
        q = np.zeros((3, 2))
        for line in loads.lines:
            if line.start <= x < line.end:
                slope = (line.last - line.first) / (line.end - line.start)
                q += np.column_stack([line.first + slope * (x - line.start), slope])
        c = coefficients[i]
        c[:3, :3] = -_integral(q, -state[:3])
        c[3, 0] = state[3]
        c[4] = _integral(c[2, :3], state[4])
        c[5] = -_integral(c[1, :3], -state[5])
        state = _values(c, h)
    return Piecewise(breaks=breaks, coefficients=coefficients)


@dataclass(frozen=True, kw_only=True, eq=False)
class BeamCheck:
    """Internal forces and stresses along a link, and its safety factor by beam theory.

    The arrays (k,) hold one value per entry of ``x``; a station where something jumps stands there twice, first
    with the values before it and then with those after. ``forces.at(x, side)`` gives the values anywhere.

    x                  stations [mm]
    n, v_y, v_z        normal force, tension positive, and shear forces [N]
    t, m_y, m_z        torque and bending moments [N·mm]
    axial, bending     N/A, tension positive, and extreme-fibre bending stress, a magnitude [MPa]
    equivalent         largest von Mises stress over the section [MPa]
    worst_x            station of the largest equivalent stress [mm], ``worst_side`` of a jump there
    worst              the stresses there
    strength           the stress that the safety factor counts from [MPa]
    safety_factor      strength over the largest equivalent stress; infinite where nothing acts
    """

    forces: Piecewise
    section: Section
    poisson: float
    x: Floats
    n: Floats
    v_y: Floats
    v_z: Floats
    t: Floats
    m_y: Floats
    m_z: Floats
    axial: Floats
    bending: Floats
    equivalent: Floats
    worst_x: float
    worst_side: Side
    worst: SectionStress
    strength: float
    safety_factor: float

    def stress_at(self, x: float, side: Side = "after") -> SectionStress:
        """Stresses at a station x [mm]."""
        return section_stress(self.section, self.forces.at(x, side), self.poisson)


def check_beam(loads: BeamLoads, section: Section, strength: float, poisson: float = 0.3) -> BeamCheck:
    """Hand calculation of a link of constant section under a balanced set of loads.

    strength in MPa; Poisson's ratio tells how the shear stress of V is spread. Raises ``CannotRunError`` for unbalanced
    loads. Eyes and holes are left out: the section is the one between the eyes, and stress concentration is not in
    these numbers.
    """
    forces = internal_forces(loads)
    stations, rows = [], []
    for c, x0, x1 in zip(forces.coefficients, forces.breaks[:-1], forces.breaks[1:], strict=True):
        for s in np.linspace(0.0, x1 - x0, _SAMPLES if np.any(c[:, 2:]) else 2):
            stations.append(x0 + s)
            rows.append(_values(c, s))
    table = np.array(rows)
    stresses = [section_stress(section, row, poisson) for row in rows]
    x, side, peak = forces.largest(lambda f: equivalent_stress(section, f, poisson))
    n, v_y, v_z, t, m_y, m_z = table.T
    return BeamCheck(
        forces=forces,
        section=section,
        poisson=poisson,
        x=np.array(stations),
        n=n,
        v_y=v_y,
        v_z=v_z,
        t=t,
        m_y=m_y,
        m_z=m_z,
        axial=np.array([s.axial for s in stresses]),
        bending=np.array([s.bending for s in stresses]),
        equivalent=np.array([s.equivalent for s in stresses]),
        worst_x=x,
        worst_side=side,
        worst=section_stress(section, forces.at(x, side), poisson),
        strength=strength,
        safety_factor=strength / peak if peak > 0.0 else np.inf,
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class Deflection:
    """Displacement of a beam's axis relative to the line through two of its stations.

    functions  u, v, w [mm] and the rotations φ, θ_y, θ_z [rad] about x, y, z, as piecewise polynomials; u and φ
               are relative to the first of the two stations
    largest    the largest √(v² + w²) [mm], at ``largest_x`` [mm]
    """

    functions: Piecewise
    largest: float
    largest_x: float


def deflection(
    forces: Piecewise,
    section: Section,
    *,
    young: float,
    poisson: float,
    line: tuple[float, float],
    flanks: Sequence[Flanks] = (),
) -> Deflection:
    """Integrate the internal forces to the deflection relative to the line through two stations [mm].

    One station twice is a line through it that turns with the section there, as where a single joint holds the link.

    Along a slot its ``flanks`` take the section's place: as both bend alike, M_z less the moment of the pair of forces
    that their ends' turning makes, (∫M_z dx/L) S/(S + I) with S the pair's second moment and I the flanks' own. How the
    pin bends the flank that it pushes further than the other is left out.

    Timoshenko's beam with Cowper's shear coefficient κ (Przemieniecki, Theory of Matrix Structural Analysis,
    1968, section 5.6): θ_z' = M_z/(E I_z), v' = θ_z + V_y/(κ G A), θ_y' = M_y/(E I_y), w' = -θ_y + V_z/(κ G A),
    u' = N/(E A), φ' = T/(G J). Exact for the polynomial loads of ``BeamLoads``. E (``young``) in MPa.
    """
    x_a, x_b = line
    forces = _divided(forces, [x for slot in flanks for x in (slot.first, slot.last)])
    middles = (forces.breaks[:-1] + forces.breaks[1:]) / 2.0
    out = np.zeros((len(forces.coefficients), 6, 6))
    state = np.zeros(6)
    for i, (c, x, h) in enumerate(zip(forces.coefficients, middles, np.diff(forces.breaks), strict=True)):
        slot = next((slot for slot in flanks if slot.first < x < slot.last), None)
        strain = c * flexibility(section if slot is None else slot.together, young, poisson)[:, None]
        if slot is not None:
            own = slot.together.i_z
            mean = _moment_between(forces, slot.first, slot.last) / slot.length
            strain[5, 0] -= mean * slot.pair / (slot.pair + own) / (young * own)
        out[i, [0, 3, 4, 5], :5] = _integral(strain[[0, 3, 4, 5]], state[[0, 3, 4, 5]])
        slope = out[i, [5, 4], :5] * np.array([[1.0], [-1.0]])
        slope[:, :4] += strain[[1, 2]]
        out[i, [1, 2]] = _integral(slope, state[[1, 2]])
        state = _values(out[i], h)
    free = Piecewise(breaks=forces.breaks, coefficients=out)
    at_a, at_b = free.at(x_a), free.at(x_b)
    tilt = np.array([at_a[5], -at_a[4]]) if x_a == x_b else (at_b[1:3] - at_a[1:3]) / (x_b - x_a)
    relative = out.copy()
    starts = forces.breaks[:-1]
    relative[:, [0, 3], 0] -= at_a[[0, 3]]
    for row, angle in ((1, tilt[0]), (2, tilt[1])):
        relative[:, row, 0] -= at_a[row] + angle * (starts - x_a)
        relative[:, row, 1] -= angle
    relative[:, 5, 0] -= tilt[0]
    relative[:, 4, 0] += tilt[1]
    functions = Piecewise(breaks=forces.breaks, coefficients=relative)
    x, _, value = functions.largest(lambda f: float(np.hypot(f[1], f[2])))
    return Deflection(functions=functions, largest=value, largest_x=x)


def flexibility(section: Section, young: float, poisson: float) -> Floats:
    """Strains (6,) per unit of N, V_y, V_z, T, M_y, M_z [1/N, 1/(N·mm²)]."""
    shear_modulus = young / (2.0 * (1.0 + poisson))
    shear = 1.0 / (section.shear_coefficient(poisson) * shear_modulus * section.area)
    return np.array(
        [
            1.0 / (young * section.area),
            shear,
            shear,
            1.0 / (shear_modulus * section.torsion),
            1.0 / (young * section.i_y),
            1.0 / (young * section.i_z),
        ]
    )


def _divided(functions: Piecewise, stations: Sequence[float]) -> Piecewise:
    """Return the same functions with further breaks at stations inside."""
    first, last = functions.breaks[0], functions.breaks[-1]
    breaks = np.unique([*functions.breaks, *(x for x in stations if first < x < last)])
    if len(breaks) == len(functions.breaks):
        return functions
    rows = []
    for x in breaks[:-1]:
        i = min(int(np.searchsorted(functions.breaks, x, side="right")) - 1, len(functions.coefficients) - 1)
        c, s = functions.coefficients[i], float(x - functions.breaks[i])
        taylor, factorial = [], 1.0
        for k in range(c.shape[-1]):
            taylor.append(_values(c, s) / factorial)
            c, factorial = _derivative(c), factorial * (k + 1)
        rows.append(np.stack(taylor, axis=-1))
    return Piecewise(breaks=breaks, coefficients=np.array(rows))


def _moment_between(forces: Piecewise, first: float, last: float) -> float:
    """∫M_z dx between two stations that are breaks or lie beyond the beam, where there is none [N·mm²]."""
    total = 0.0
    for c, x, h in zip(forces.coefficients, forces.breaks[:-1], np.diff(forces.breaks), strict=True):
        if first <= x < last:
            total += float(_values(_integral(c[5], np.zeros(())), float(h)))
    return total


@dataclass(frozen=True, kw_only=True)
class CantileverCheck:
    """A whole wing as one cantilever: moment at the root [N·mm], bending stress there [MPa], safety factor."""

    moment: float
    stress: float
    safety_factor: float


def uniform_cantilever(weight: float, length: float, section: Section, strength: float) -> CantileverCheck:
    """Cantilever of a given length [mm] under a total weight [N] spread evenly: M = W L/2, σ = M c/I_z.

    Gere & Goodno, Mechanics of Materials, 8th ed., example 4-5 (q = W/L). ``strength`` in MPa.
    """
    if not (length > 0.0 and np.isfinite([weight, length]).all()):
        raise CannotRunError(f"a cantilever needs a length above zero and a finite weight, not {length:g} mm")
    moment = abs(weight) * length / 2.0
    stress = moment * section.half_y / section.i_z
    return CantileverCheck(moment=moment, stress=stress, safety_factor=strength / stress if stress > 0.0 else np.inf)
