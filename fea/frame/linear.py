"""Spatial frames of Timoshenko beams, in small displacements.

Units and axes are those of ``alula.fea.frame.model``: mm, N, N·mm, rad; x, y the linkage's plane, z along the pins. The
unknowns are the natural forces q of the elements (``alula.fea.frame.system``) together with the displacements u:

    [-F  B] [q]   [v0    ]        F  natural flexibility of the elements, B  compatibility (v = B u),
    [ Bᵀ 0] [u] = [p - p0]        v0, p0  effect of line loads on the elements, p  nodal loads

(equilibrium and compatibility side by side: Strang, Introduction to Applied Mathematics, 1986, section 2.2; in the
language of frames Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapters 6 and 8). Forces so come out
of equilibrium rather than as small differences of large displacements times large stiffnesses: nothing is lost
where stiffnesses differ by many orders of magnitude, and a statically determinate frame gets its forces to rounding
whatever its stiffness. Guides are further rows of B without flexibility, their forces further entries of q. Released
ends are unknowns of their own. Line loads act on the axis of the beams and are
treated exactly, so that one element per link is enough.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.deflection import deflection
from alula.fea.beam.loads import BeamLoads, LineLoad, PointLoad
from alula.fea.beam.piecewise import Piecewise, values
from alula.fea.beam.theory import LARGEST_IMBALANCE, between_loads, internal_forces
from alula.fea.frame.equations import equations_of
from alula.fea.frame.model import DOFS, FrameModel
from alula.fea.frame.system import FrameSystem, line_load_effect
from alula.geometry.base.errors import CannotRunError

Floats = NDArray[np.float64]

LARGEST_RESIDUAL = 1e-8
OPENED_RESIDUAL = 1e-6
"""The same of an answer with further deformations, which soft hinges make large."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FrameSolution:
    """Displacements and forces of a frame (n nodes, m elements).

    Attributes
    ----------
    model : FrameModel
        The frame.
    displacements : ndarray, shape (n, 6)
        Global axes [mm, rad]; a rotation in which no element takes part stands as zero.
    end_displacements : ndarray, shape (m, 2, 6)
        Of the two ends of each beam, beyond the arms, local axes.
    end_forces : ndarray, shape (m, 2, 6)
        What acts on the two ends of each beam, beyond the arms, local axes [N, N·mm].
    joint_wrenches : ndarray, shape (n, 6)
        What ties, guides and supports together do to the part of the frame at each node, global axes: the joint force
        at a pin; zero (to rounding) at nodes without any.
    reactions : ndarray, shape (n, 6)
        What supports and guides on the ground do to the frame, global axes; of tied nodes the first supported has it.
    guide_forces : ndarray, shape (g,)
        What each guide's carrier takes along its normal [N], or about axis x normal [N·mm]; the pin gets the opposite.
    residual : float
        Largest force left over at a node or in the balance of the whole frame, over the sum of loads.
    """

    model: FrameModel
    displacements: Floats
    end_displacements: Floats
    end_forces: Floats
    joint_wrenches: Floats
    reactions: Floats
    guide_forces: Floats
    residual: float

    @property
    def condition(self) -> float:
        """1-norm condition number of the scaled equations (estimated)."""
        return equations_of(self.model).condition

    def beam_loads(self, i: int) -> BeamLoads:
        """Return all that acts on the beam of an element, in local axes with x = 0 at its first end.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        BeamLoads
            Loads on its beam.
        """
        length = self.model.length(i)
        ends = tuple(
            PointLoad(point=np.array([x, 0.0, 0.0]), wrench=f)
            for x, f in zip((0.0, length), self.end_forces[i], strict=True)
        )
        first, last = self.model.line_load(i)
        return BeamLoads(points=ends, lines=(LineLoad(start=0.0, end=length, first=first, last=last),))

    def internal_forces(self, i: int) -> Piecewise:
        """Return N, V_y, V_z, T, M_y, M_z along an element.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        Piecewise
            Signs and axes as in ``alula.fea.beam.theory``.
        """
        breaks = np.array([0.0, self.model.length(i)])
        return Piecewise(breaks=breaks, coefficients=self.forces_along[i][None])

    @cached_property
    def forces_along(self) -> Floats:
        """N, V_y, V_z, T, M_y, M_z (m, 6, 4) along every element, in powers 0 to 3 of the place from its first end.

        Raises ``CannotRunError`` where what acts on an element does not balance.
        """
        numbers = range(len(self.model.elements))
        lengths, lines = np.array([self.model.length(i) for i in numbers]), np.zeros((len(numbers), 3, 2))
        for i, element in enumerate(self.model.elements):
            if element.load_first.any() or element.load_last.any():
                first, last = self.model.line_load(i)
                lines[i] = np.column_stack([first, (last - first) / lengths[i]])
        found = between_loads(-self.end_forces[:, 0], lines)
        # What does not meet the other end's forces is out of balance, or rounding of a far larger load elsewhere.
        left = np.abs(values(found, lengths[:, None]) - self.end_forces[:, 1])
        size = np.abs(self.end_forces).sum(axis=1)
        scale = size[:, :3].sum(axis=1) + size[:, 3:].sum(axis=1) / lengths
        bad = np.maximum(left[:, :3].max(axis=1), left[:, 3:].max(axis=1) / lengths) > LARGEST_IMBALANCE / 2.0 * scale
        for number in np.flatnonzero(bad).tolist():
            internal_forces(self.beam_loads(number))
        return found

    def axis_displacements(self, i: int, stations: Floats) -> Floats:
        """Return the displacements of the axis of an element.

        Parameters
        ----------
        i : int
            Number of the element.
        stations : ndarray, shape (k,)
            From its first end [mm].

        Returns
        -------
        ndarray, shape (k, 3)
            Global axes [mm].
        """
        e, length = self.model.elements[i], self.model.length(i)
        forces = self.internal_forces(i)
        bent = deflection(forces, e.section, young=e.young, poisson=e.poisson, line=(0.0, length)).functions
        start, end = self.end_displacements[i]
        local = np.array([bent.at(float(x))[:3] for x in stations])
        local[:, 0] += start[0]
        local[:, 1:] += start[1:3] + np.outer(stations / length, end[1:3] - start[1:3])
        return np.asarray(local @ self.model.axes(i))


def solve_frame(model: FrameModel) -> FrameSolution:
    """Solve a frame in small displacements.

    Parameters
    ----------
    model : FrameModel
        The frame.

    Returns
    -------
    FrameSolution
        Displacements and forces.

    Raises
    ------
    CannotRunError
        Where the frame can move without strain (naming what moves most) and where the forces found do not balance to
        1e-8 of the load.
    """
    return FactorisedFrame(model).solved()


class FactorisedFrame:
    """A frame whose equations are factorised, so that more than its own loads can be solved.

    Frames that differ in their loads have one factorisation: those of unit loads, of ways in which pins tilt, and of a
    pose under several load cases.

    Parameters
    ----------
    model : FrameModel
        The frame.

    Raises
    ------
    CannotRunError
        Where the frame can move without strain, naming what moves most.
    """

    def __init__(self, model: FrameModel) -> None:
        self.model = model
        self._equations = equations_of(model)
        self.system = self._equations.system
        v0, p = self.system.loaded(model)
        self._own = self._equations.solved(np.concatenate([v0 / self._equations.scale, p]))

    @cached_property
    def _held(self) -> Floats:
        """Forces (m, 12) of line loads alone at beams' ends."""
        held = np.zeros((len(self.model.elements), 12))
        for i, (e, length) in enumerate(zip(self.model.elements, self.system.lengths, strict=True)):
            if e.load_first.any() or e.load_last.any():
                held[i] = line_load_effect(e.section, e.young, length, *self.model.line_load(i))[1]
        return held

    def opened(self, rows: NDArray[np.int64]) -> Floats:
        """Return what a unit of further deformation in each of some natural rows does to a frame without loads.

        Parameters
        ----------
        rows : ndarray of int, shape (r,)
            Numbers of natural deformations: 6 times that of the element, and 0 to 5.

        Returns
        -------
        ndarray, shape (k, r)
            Scaled unknowns, to be added to those of ``solved``; of a row in [mm] or [rad].
        """
        right = np.zeros((len(self._own), len(rows)))
        units = np.array([self.system.natural_unit(i // 6)[i % 6] for i in rows])
        right[rows, np.arange(len(rows))] = units / self._equations.scale
        return self._equations.solved(right)

    def natural_forces(self, rows: NDArray[np.int64], unknowns: Floats) -> Floats:
        """Return natural forces from scaled unknowns.

        Parameters
        ----------
        rows : ndarray of int, shape (r,)
            As for ``opened``.
        unknowns : ndarray, shape (k, ...)
            As ``opened`` gives them.

        Returns
        -------
        ndarray, shape (r, ...)
            [N, N·mm]
        """
        units = np.array([self.system.natural_unit(i // 6)[i % 6] for i in rows])
        return np.asarray((unknowns[rows].T * units).T)

    def displacements(self, unknowns: Floats) -> Floats:
        """Return the displacements of nodes from scaled unknowns.

        Parameters
        ----------
        unknowns : ndarray, shape (k, c)
            As ``opened`` gives them.

        Returns
        -------
        ndarray, shape (n, 6, c)
            Global axes [mm, rad].
        """
        known, number = self._equations, self.system.number
        moved = np.vstack([(unknowns[known.size :].T * known.scale * self.system.unit).T, np.zeros_like(unknowns[:1])])
        return np.asarray(moved[np.where(number >= 0, number, -1)].reshape(-1, 6, unknowns.shape[1]))

    @property
    def own(self) -> Floats:
        """(k,) scaled unknowns under the frame's loads."""
        return self._own

    def solved(self, further: Floats | None = None) -> FrameSolution:
        """Return the frame's answer to its loads.

        Parameters
        ----------
        further : ndarray, shape (k,), optional
            Scaled unknowns to be added.

        Returns
        -------
        FrameSolution

        Raises
        ------
        CannotRunError
            Where the forces found do not balance to 1e-8 of the load, or 1e-6 with further deformations.
        """
        known = self._equations
        unknowns = self._own if further is None else self._own + further
        q, u = unknowns[: known.size], unknowns[known.size :] * known.scale * self.system.unit
        found = _collect(self.model, self.system, known.natural, self._held, q, u)
        allowed = LARGEST_RESIDUAL if further is None else OPENED_RESIDUAL
        if not found.residual <= allowed:
            raise CannotRunError(
                f"the forces of the frame leave {found.residual:.3g} of the load unbalanced, where "
                f"{allowed:g} is allowed (condition number {known.condition:.3g}); the frame is nearly a mechanism: "
                "change its pose"
            )
        return found


def _collect(
    model: FrameModel, system: FrameSystem, natural: Floats, held: Floats, q: Floats, u: Floats
) -> FrameSolution:
    """Turn natural forces (scaled) and displacements into the record, and check their balance."""
    n, m = len(model.nodes), len(model.elements)
    displacements = np.where(system.number >= 0, u[system.number] if len(u) else 0.0, 0.0).reshape(n, 6)
    nodes = np.array([e.nodes for e in model.elements], dtype=np.int64).reshape(m, 2)
    ends = np.einsum("mij,mj->mi", system.matrices, displacements[nodes].reshape(m, 12))
    forces = np.einsum("mij,mj->mi", natural, q[: 6 * m].reshape(m, 6)) + held
    joints = np.zeros((n, 6))
    np.add.at(joints, nodes.ravel(), np.einsum("mji,mj->mi", system.matrices, forces).reshape(2 * m, 6))
    start = 6 * m + len(model.guides)
    for link in model.condensed:
        unit = np.tile(system.condensed_unit, len(link.nodes) - 1)
        acting = link.wrenches @ (unit * q[start : start + len(unit)])
        np.add.at(joints, list(link.nodes), acting.reshape(-1, 6))
        start += len(unit)
    for load in model.loads:
        joints[load.node] -= load.wrench
    held_by: dict[int, int] = {}
    for support in model.supports:
        for dof in support.dofs:
            place = 6 * support.node + DOFS.index(dof)
            held_by.setdefault(int(system.owner[place]), place)
    guided, grounded = np.zeros((n, 6)), np.zeros((n, 6))
    guide_forces = q[6 * m : 6 * m + len(model.guides)] * system.guide_unit
    for guide, force in zip(model.guides, guide_forces, strict=True):
        for node, sign in guide.nodes:
            guided[node] -= sign * force * guide.gradient
            if len(guide.nodes) == 1:
                grounded[node] -= sign * force * guide.gradient
    left_over = np.zeros(6 * n)
    np.add.at(left_over, system.owner, (joints - guided).ravel())
    reactions = np.zeros((n, 6))
    for owner, place in held_by.items():
        reactions[divmod(place, 6)], left_over[owner] = left_over[owner], 0.0
    return FrameSolution(
        model=model,
        displacements=displacements,
        end_displacements=ends.reshape(m, 2, 6),
        end_forces=forces.reshape(m, 2, 6),
        joint_wrenches=joints,
        reactions=reactions + grounded,
        guide_forces=guide_forces,
        residual=_residual(model, left_over.reshape(n, 6), reactions + grounded),
    )


def _residual(model: FrameModel, left_over: Floats, reactions: Floats) -> float:
    """Largest imbalance of a node or of the whole frame over the sum of the loads (moments over the frame's size)."""
    scale = model.load_scale
    if scale == 0.0:
        return 0.0
    # Simpson's rule for the line loads, at both ends and in the middle: exact for the force and its moment.
    m, (starts, ends) = len(model.elements), model.all_ends
    lengths = np.linalg.norm(ends - starts, axis=1)[:, None] / 6.0
    lines = np.array([(e.load_first, e.load_last) for e in model.elements]).reshape(m, 2, 3).swapaxes(0, 1)
    first, last = lines[0] * lengths, lines[1] * lengths
    loaded = [load.node for load in model.loads]
    wrenches = np.array([load.wrench for load in model.loads]).reshape(-1, 6)
    points = np.vstack([model.nodes, model.nodes[loaded], starts, (starts + ends) / 2.0, ends])
    forces = np.vstack([reactions[:, :3], wrenches[:, :3], first, 2.0 * (first + last), last])
    moments = np.cross(points - model.nodes.mean(axis=0), forces).sum(axis=0)
    total = np.concatenate([forces.sum(axis=0), moments + reactions[:, 3:].sum(axis=0) + wrenches[:, 3:].sum(axis=0)])
    sizes = np.array([1.0, 1.0, 1.0, *[1.0 / model.size] * 3])
    return float(max(np.abs(left_over * sizes).max(), np.abs(total * sizes).max())) / scale
