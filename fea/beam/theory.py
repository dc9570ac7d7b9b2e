"""Hand calculation of one link: a straight beam under a balanced set of loads.

The beam lies along the x axis of its link's frame; y is in the linkage's plane, z along the pins. Lengths are
in mm, forces in N, moments in N·mm, stresses in MPa.

Sign convention: the internal forces at x are what the part beyond x does to the part before it, so N > 0 is
tension, and V_y, V_z, T (= M_x), M_y, M_z are components of vectors along the axes of the frame (right-hand
rule). With loads q per length, equilibrium of a slice gives (Gere & Goodno, Mechanics of Materials, 8th ed.,
section 4.4, there with the opposite sign of V)

    dN/dx = -q_x,  dV_y/dx = -q_y,  dV_z/dx = -q_z,  dT/dx = 0,  dM_y/dx = V_z,  dM_z/dx = -V_y

and M_z > 0 compresses the side y > 0 (``alula.fea.beam.section_stress``).
Everything is a piecewise polynomial (N, V of degree 2, M of degree 3 under linearly varying line loads), kept as
such and therefore exact at every station.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_beam import about_centre, cut_stress, nearest
from alula.fea.beam.loads import RECENT, BeamLoads
from alula.fea.beam.piecewise import LargestAlong, Piecewise, Side, divided, integral, values
from alula.fea.beam.section_stress import (
    SectionStress,
    bending_stress,
    equivalent_bound,
    equivalent_stress,
    section_stress,
)
from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.ties import first_largest
from alula.geometry.bodies.cut_section import CutSection
from alula.geometry.parts.part import Section

Floats = NDArray[np.float64]

LARGEST_IMBALANCE = 1e-6
"""Resultant over load above which a set of loads is refused as unbalanced."""


@lru_cache(maxsize=RECENT)
def internal_forces(loads: BeamLoads) -> Piecewise:
    """Return the internal forces along the beam.

    Parameters
    ----------
    loads : BeamLoads
        A balanced set, in one state or in n.

    Returns
    -------
    Piecewise
        N, V_y, V_z [N], T, M_y, M_z [N·mm], signs as in the module's docstring.

    Raises
    ------
    CannotRunError
        Where the loads do not balance to 1e-6 of their sum, with the resultant.
    """
    if loads.imbalance.max(initial=0.0) > LARGEST_IMBALANCE:
        worst = loads.imbalance.argmax()
        force, moment = np.split(loads.resultant.reshape(-1, 6)[worst], 2)
        raise CannotRunError(
            f"the loads of a beam do not balance: resultant force ({force[0]:.6g}, {force[1]:.6g}, {force[2]:.6g}) N, "
            f"moment ({moment[0]:.6g}, {moment[1]:.6g}, {moment[2]:.6g}) N·mm about its middle, "
            f"{loads.imbalance.max():.3g} of the load where {LARGEST_IMBALANCE:g} is allowed; check the joint forces"
        )
    stations = [float(p.point[0]) for p in loads.points] + [x for q in loads.lines for x in (q.start, q.end)]
    breaks = np.unique(stations)
    coefficients = np.zeros((*loads.states, len(breaks) - 1, 6, 4))
    state = np.zeros((*loads.states, 6))
    for i, (x, h) in enumerate(zip(breaks[:-1], np.diff(breaks), strict=True)):
        for p in loads.points:
            if p.point[0] == x:
                state = state - p.on_axis
        q = np.zeros((*loads.states, 3, 2))
        for line in loads.lines:
            if line.start <= x < line.end:
                slope = (line.last - line.first) / (line.end - line.start)
                q += np.stack([line.first + slope * (x - line.start), slope], axis=-1)
        coefficients[..., i, :, :] = between_loads(state, q)
        state = values(coefficients[..., i, :, :], h)
    return Piecewise(breaks=breaks, coefficients=coefficients)


def between_loads(start: Floats, line: Floats) -> Floats:
    """Return the internal forces along a stretch with no load but a spread one.

    Parameters
    ----------
    start : ndarray, shape (..., 6)
        N, V_y, V_z [N], T, M_y, M_z [N·mm] at its start.
    line : ndarray, shape (..., 3, 2)
        Force per length at its start [N/mm], and by how much it grows along it [N/mm²].

    Returns
    -------
    ndarray, shape (..., 6, 4)
        In powers 0 to 3 of the distance from its start.
    """
    c = np.zeros((*start.shape, 4))
    c[..., :3, :3] = -integral(line, -start[..., :3])
    c[..., 3, 0] = start[..., 3]
    c[..., 4, :] = integral(c[..., 2, :3], start[..., 4])
    c[..., 5, :] = -integral(c[..., 1, :3], -start[..., 5])
    return c


@dataclass(frozen=True, kw_only=True, eq=False)
class BeamCheck:
    """Internal forces and stresses along a link, and its safety factor by beam theory.

    A station where something jumps stands in ``x`` twice, first with the values before it and then with those after.

    Attributes
    ----------
    forces : Piecewise
        Along the beam, on the link's axis; ``forces.at(x, side)`` gives the values anywhere.
    section : Section
        Of the beam.
    poisson : float
        Poisson's ratio.
    x : ndarray, shape (k,)
        Stations [mm].
    n : ndarray, shape (k,)
        Normal force, tension positive [N].
    v_y : ndarray, shape (k,)
        Shear force along y [N].
    v_z : ndarray, shape (k,)
        Shear force along z [N].
    t : ndarray, shape (k,)
        Torque [N·mm].
    m_y : ndarray, shape (k,)
        Bending moment about y [N·mm].
    m_z : ndarray, shape (k,)
        Bending moment about z [N·mm].
    axial : ndarray, shape (k,)
        N/A, tension positive [MPa].
    bending : ndarray, shape (k,)
        Extreme-fibre bending stress, a magnitude [MPa].
    worst_x : float
        Station of the largest equivalent stress [mm].
    worst : SectionStress
        The stresses there.
    strength : float
        The stress that the safety factor counts from [MPa].
    safety_factor : float
        Strength over the largest equivalent stress; infinite where nothing acts.
    without : str
        Why no beam stands for the link, so that all forces and stresses here are zero; "" where one does.
    cuts : sequence of CutSection
        Sections of a part from a file, in place of ``section``; torque and moments then are those about the centroid of
        the section that is nearest.
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
    worst_x: float
    worst: SectionStress
    strength: float
    safety_factor: float
    without: str = ""
    cuts: Sequence[CutSection] = ()

    @cached_property
    def equivalent(self) -> Floats:
        """Largest von Mises stress (k,) over the section at every station [MPa]."""
        rows = np.column_stack([self.n, self.v_y, self.v_z, self.t, self.m_y, self.m_z])
        if not self.cuts:
            return equivalent_stress(self.section, rows, self.poisson)
        own = (nearest(self.cuts, x) for x in self.x)
        return np.array([cut_stress(cut, row, self.poisson).equivalent for cut, row in zip(own, rows, strict=True)])

    @property
    def idle(self) -> bool:
        """True where nothing acts on the link."""
        return not self.without and self.worst.equivalent == 0.0

    def stress_at(self, x: float, side: Side = "after") -> SectionStress:
        """Return the stresses at a station.

        Parameters
        ----------
        x : float
            Station [mm].
        side : Side, optional
            Which value, where forces jump at x.

        Returns
        -------
        SectionStress
            Stresses of the section.
        """
        forces = self.forces.at(x, side)
        if not self.cuts:
            return section_stress(self.section, forces, self.poisson)
        cut = nearest(self.cuts, x)
        return cut_stress(cut, about_centre(cut) @ forces, self.poisson)


def check_beam(
    loads: BeamLoads, section: Section, strength: float, poisson: float = 0.3, cuts: Sequence[CutSection] = ()
) -> BeamCheck:
    """Calculate a link of constant section, or of sections that were cut, by hand.

    Of a constant section eyes and holes are left out; stress concentration is in no case in these numbers.

    Parameters
    ----------
    loads : BeamLoads
        A balanced set.
    section : Section
        The one between the eyes.
    strength : float
        That the safety factor counts from [MPa].
    poisson : float, optional
        Poisson's ratio, which tells how the shear stress of V is spread.
    cuts : sequence of CutSection, optional
        Sections of a part from a file, which take the section's place, each for what is nearest to it.

    Returns
    -------
    BeamCheck
        Forces, stresses and the safety factor.

    Raises
    ------
    CannotRunError
        For unbalanced loads.
    """
    forces = divided(internal_forces(loads), [cut.x for cut in cuts])
    stations, rows = forces.samples
    if cuts:
        own = [nearest(cuts, x) for x in stations]
        rows = np.array([about_centre(cut) @ row for cut, row in zip(own, rows, strict=True)])
        found = [cut_stress(cut, row, poisson) for cut, row in zip(own, rows, strict=True)]
        most = first_largest([stress.equivalent for stress in found])
        x, worst = float(stations[most]), found[most]
        axial, bending = (np.array([getattr(stress, name) for stress in found]) for name in ("axial", "bending"))
    else:
        axial, bending = rows[:, 0] / section.area, bending_stress(section, rows[:, 4], rows[:, 5])
        peak = _peaks(forces, section, poisson)
        x, side = float(peak.x[0]), peak.side()
        worst = section_stress(section, forces.at(x, side), poisson)
    n, v_y, v_z, t, m_y, m_z = rows.T
    return BeamCheck(
        forces=forces,
        section=section,
        poisson=poisson,
        x=stations,
        n=n,
        v_y=v_y,
        v_z=v_z,
        t=t,
        m_y=m_y,
        m_z=m_z,
        axial=axial,
        bending=bending,
        worst_x=x,
        worst=worst,
        strength=strength,
        safety_factor=strength / worst.equivalent if worst.equivalent > 0.0 else np.inf,
        cuts=cuts,
    )


def largest_stress(
    forces: Piecewise, section: Section, poisson: float = 0.3, cuts: Sequence[CutSection] = ()
) -> Floats:
    """Return the largest von Mises stress along a link in each of n states.

    Parameters
    ----------
    forces : Piecewise
        Internal forces of the states.
    section, poisson, cuts
        As of ``check_beam``.

    Returns
    -------
    ndarray, shape (n,)
        [MPa].
    """
    if not cuts:
        return _peaks(forces, section, poisson).value
    stations, rows = divided(forces, [cut.x for cut in cuts]).samples
    along = [
        [cut_stress(cut, about_centre(cut) @ row, poisson).equivalent for row in np.moveaxis(rows, -2, 0)[i]]
        for i, cut in enumerate(nearest(cuts, x) for x in stations)
    ]
    return np.asarray(np.max(along, axis=0))


def _peaks(forces: Piecewise, section: Section, poisson: float) -> LargestAlong:
    return forces.peaks(
        lambda f: equivalent_stress(section, f, poisson), lambda sizes: equivalent_bound(section, sizes, poisson)
    )


@dataclass(frozen=True, kw_only=True)
class CantileverCheck:
    """A whole wing as one cantilever.

    Attributes
    ----------
    moment : float
        At the root [N·mm].
    stress : float
        Of bending there [MPa].
    safety_factor : float
        Strength over that stress.
    """

    moment: float
    stress: float
    safety_factor: float


def uniform_cantilever(weight: float, length: float, section: Section, strength: float) -> CantileverCheck:
    """Calculate a cantilever under a weight spread evenly: M = W L/2, σ = M c/I_z.

    Parameters
    ----------
    weight : float
        In all [N].
    length : float
        Of the cantilever [mm].
    section : Section
        At the root.
    strength : float
        That the safety factor counts from [MPa].

    Returns
    -------
    CantileverCheck
        Moment, stress and safety factor.

    Raises
    ------
    CannotRunError
        For a length that is not above zero.

    References
    ----------
    Gere & Goodno, Mechanics of Materials, 8th ed., example 4-5 (q = W/L).
    """
    if not (length > 0.0 and np.isfinite([weight, length]).all()):
        raise CannotRunError(f"a cantilever needs a length above zero and a finite weight, not {length:g} mm")
    moment = abs(weight) * length / 2.0
    stress = moment * section.half_y / section.i_z
    return CantileverCheck(moment=moment, stress=stress, safety_factor=strength / stress if stress > 0.0 else np.inf)
