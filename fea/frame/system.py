"""The equations of a frame: elements, numbering, scaling, compatibility, and the test for mechanisms.

Elements are Timoshenko beams in their natural mode: what it resists once rigid motion is taken out.

Local axes: x from the first end to the second, z as the model says, y = z × x. Each end has three displacements
and three rotations about the local axes (right-hand rule), in this order, and so have the forces at it.

The six natural forces and the deformations that they work on (Przemieniecki, Theory of Matrix Structural Analysis,
1968, chapters 5 and 6; the simply supported beam as the basic system):

    N           normal force, tension positive             lengthening
    M_z1, M_z2  end moments about z, right-hand rule       rotations of the end sections relative to the chord
    M_y1, M_y2  end moments about y                        the same about y
    T           torque, that on the second end             twist
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.deflection import flexibility
from alula.fea.frame.model import DOFS, FrameModel, NodeLoad
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import Section

Floats = NDArray[np.float64]

_MECHANISM = 1e-10
"""A motion of unit size that strains the elements less than this is a mechanism."""
RIGID = 1e-6
"""Flexibility of an element that stands for a rigid body, over the least of all others, whatever its length. Not nil:
of a closed loop of rigid bodies the forces would have no single answer."""


def _motion(dof: int) -> str:
    return f"{'along' if dof < 3 else 'about'} {'xyz'[dof % 3]}"


def natural_deformations(length: float | Floats) -> Floats:
    """Return the matrix G from the displacements of both ends to the natural deformations.

    Parameters
    ----------
    length : float or ndarray, shape (...)
        Of the beam, or of many [mm].

    Returns
    -------
    ndarray, shape (..., 6, 12)
        G; Gᵀ gives end forces.
    """
    G, slope = np.zeros((*np.shape(length), 6, 12)), 1.0 / length
    G[..., 0, [0, 6]] = -1.0, 1.0
    for row, rotation in ((1, 5), (2, 11)):
        G[..., row, rotation] = 1.0
        G[..., row, 1], G[..., row, 7] = slope, -slope
    for row, rotation in ((3, 4), (4, 10)):
        G[..., row, rotation] = 1.0
        G[..., row, 2], G[..., row, 8] = -slope, slope
    G[..., 5, [3, 9]] = -1.0, 1.0
    return G


def natural_flexibility(section: Section, young: float, poisson: float, length: float) -> Floats:
    """Return the natural flexibility of a Timoshenko beam, exact for any slenderness.

    End rotations under end moments: L/(3EI) M1 - L/(6EI) M2 + (M1 + M2)/(κ G A L), by virtual work (inverse of
    Przemieniecki, 1968, eq. 5.116, with Cowper's κ in the shear parameter).

    Parameters
    ----------
    section : Section
        Of the beam.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.
    length : float
        Of the beam [mm].

    Returns
    -------
    ndarray, shape (6, 6)
        Flexibility [mm/N, 1/(N·mm)].
    """
    along, shear, _, twist, about_y, about_z = flexibility(section, young, poisson)
    F = np.diag([along, 0.0, 0.0, 0.0, 0.0, twist]) * length
    for first, bending in ((1, about_z), (3, about_y)):
        own = np.array([[2.0, -1.0], [-1.0, 2.0]]) * bending * length / 6.0
        F[first : first + 2, first : first + 2] = own + shear / length
    return F


def line_load_effect(
    section: Section, young: float, length: float, first: Floats, last: Floats
) -> tuple[Floats, Floats]:
    """Return the effect of a linearly varying line load on the basic system.

    The basic system is simply supported and held along x at its first end. End rotations 8, 7 (360ths of q L³/(E I))
    after Gere & Goodno, Mechanics of Materials, 8th ed., appendix G, table G-2, cases 1 and 11; shear does not turn the
    end sections.

    Parameters
    ----------
    section : Section
        Of the beam.
    young : float
        Young's modulus [MPa].
    length : float
        Of the beam [mm].
    first : ndarray, shape (3,)
        Force per length at the first end, local axes [N/mm].
    last : ndarray, shape (3,)
        The same at the second end.

    Returns
    -------
    tuple of 2 ndarray
        Natural deformations (6,) and end forces (12,).
    """
    v0, p0 = np.zeros(6), np.zeros(12)
    v0[0] = length**2 * (first[0] + 2.0 * last[0]) / (6.0 * young * section.area)
    p0[0] = -(first[0] + last[0]) * length / 2.0
    for axis, row, sign, inertia in ((1, 1, 1.0, section.i_z), (2, 3, -1.0, section.i_y)):
        q1, q2 = first[axis], last[axis]
        slope = sign * length**3 / (360.0 * young * inertia)
        v0[row] = slope * (8.0 * q1 + 7.0 * q2)
        v0[row + 1] = -slope * (7.0 * q1 + 8.0 * q2)
        p0[axis] = -(2.0 * q1 + q2) * length / 6.0
        p0[6 + axis] = -(q1 + 2.0 * q2) * length / 6.0
    return v0, p0


def to_ends(model: FrameModel, i: int) -> Floats:
    """Return the matrix from the displacements of an element's nodes to those of its beam's ends beyond the arms.

    Parameters
    ----------
    model : FrameModel
        The frame.
    i : int
        Number of the element.

    Returns
    -------
    ndarray, shape (12, 12)
        From global axes to local ones.
    """
    R, found = model.axes(i), np.zeros((12, 12))
    for first in range(0, 12, 3):
        found[first : first + 3, first : first + 3] = R
    offsets = model.elements[i].offsets
    if offsets.any():
        for end, (x, y, z) in enumerate(offsets @ R.T):
            across = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
            found[6 * end : 6 * end + 3, 6 * end + 3 : 6 * end + 6] = across @ R
    return found


class FrameSystem:
    """Numbering and scaling of the unknowns of a frame.

    Unknown rotations are multiplied by the mean element length, natural moments divided by their element's length,
    so that all entries of the compatibility matrix are of order one.

    Attributes
    ----------
    unit : ndarray, shape (k,)
        Factor from the scaled unknowns to mm and rad.
    guide_unit : ndarray, shape (g,)
        Factor from the scaled forces of the guides to N or N·mm.
    condensed_unit : ndarray, shape (6,)
        Factors from the scaled natural forces at a node of a condensed link to N and N·mm.
    idle : ndarray of bool, shape (6 n,)
        Rotations, by their owners, that are no unknowns since nothing takes part in them.
    """

    def __init__(self, model: FrameModel) -> None:
        self.model = model
        n, m = len(model.nodes), len(model.elements)
        self.lengths = np.array([model.length(i) for i in range(m)])
        mean = float(self.lengths.mean()) if m else model.size
        self.condensed_unit = np.array([1.0, 1.0, 1.0, mean, mean, mean])
        self.guide_unit = np.array([1.0 if guide.axis is None else mean for guide in model.guides])
        self.owner = self._owners()
        supported = {int(self.owner[6 * s.node + DOFS.index(dof)]) for s in model.supports for dof in s.dofs}
        self.idle = self._idle()
        free = [i for i in range(6 * n) if self.owner[i] == i and i not in supported and not self.idle[i]]
        self._free = free
        self.unit = np.array([1.0 if i % 6 < 3 else 1.0 / mean for i in free])
        number = np.full(6 * n, -1)
        number[free] = np.arange(len(free))
        self.number = number[self.owner]

    @property
    def labels(self) -> list[str]:
        """What moves with each unknown, for messages."""
        return [f"node {self.model.name(i // 6)} {_motion(i % 6)}" for i in self._free]

    @cached_property
    def matrices(self) -> Floats:
        """(m, 12, 12) from the displacements of every element's nodes, global axes, to its beam's ends, local axes."""
        m = len(self.lengths)
        return np.array([to_ends(self.model, i) for i in range(m)]).reshape(m, 12, 12)

    def _owners(self) -> NDArray[np.int64]:
        """(6 n,) the first of all displacements tied to each."""
        owner = np.arange(6 * len(self.model.nodes))
        for tie in self.model.ties:
            for dof in tie.dofs:
                least, other = sorted(int(owner[6 * node + DOFS.index(dof)]) for node in tie.nodes)
                if least < other:
                    owner[owner == other] = least
        return owner

    @cached_property
    def _columns(self) -> NDArray[np.int64]:
        """(m, 12) displacements of the nodes of every element."""
        nodes = np.array([e.nodes for e in self.model.elements], dtype=np.int64).reshape(-1, 2)
        return np.asarray((6 * nodes[:, :, None] + np.arange(6)).reshape(-1, 12))

    def _idle(self) -> NDArray[np.bool_]:
        """(6 n,) rotations in which no element takes part, at nodes of ties alone, and no moment or guide.

        They are no unknowns. Where a moment does act the rotation stays one, and is refused as a mechanism.
        """
        needed = np.zeros(len(self.owner), dtype=bool)
        needed[np.arange(len(needed)) % 6 < 3] = True
        needed[self.owner[self._columns]] = True
        for link in self.model.condensed:
            needed[self.owner[link.columns]] = True
        acting = [(load.node, load.wrench) for load in self.model.loads]
        acting += [(node, guide.gradient) for guide in self.model.guides for node, _ in guide.nodes]
        for node, wrench in acting:
            needed[self.owner[6 * node + np.flatnonzero(wrench)]] = True
        return ~needed

    def place(self, i: int) -> tuple[NDArray[np.int64], Floats]:
        """Return which unknowns move an element, and how.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        tuple of ndarray of int and ndarray
            Numbers (k,) of the unknowns, and the matrix (12, k) from them to the beam's ends.
        """
        numbers = self.number[self._columns[i]]
        return numbers[numbers >= 0], self.matrices[i][:, numbers >= 0]

    def natural_unit(self, i: int) -> Floats:
        """Return the factors from the scaled natural forces of an element to N and N·mm.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        ndarray, shape (6,)
            Factors.
        """
        return np.asarray(self.natural_units[i])

    @cached_property
    def natural_units(self) -> Floats:
        """(m, 6) those of all elements."""
        return np.column_stack([np.ones(len(self.lengths)), *[self.lengths] * 5])

    def _with_rigid(self, flexibility: list[Floats]) -> list[Floats]:
        """Return the scaled flexibilities of all elements, those that stand for rigid bodies stiffer than any other."""
        elements = self.model.elements
        known = [np.diag(F) for F, e in zip(flexibility, elements, strict=True) if not e.rigid]
        known += [
            np.diag(link.natural_flexibility) * np.tile(self.condensed_unit, len(link.nodes) - 1) ** 2
            for link in self.model.condensed
        ]
        every = np.concatenate([*known, np.zeros(1)])
        least = float(every[every > 0.0].min(initial=np.inf))
        return [
            RIGID * least * np.eye(6) if e.rigid and np.isfinite(least) else F
            for F, e in zip(flexibility, elements, strict=True)
        ]

    def bears(self, loads: Sequence[NodeLoad]) -> bool:
        """Return whether the unknowns do for other loads: none is a moment about what was left out as idle.

        Parameters
        ----------
        loads : sequence of NodeLoad

        Returns
        -------
        bool
        """
        return not any(self.idle[6 * load.node + np.flatnonzero(load.wrench)].any() for load in loads)

    def equations(self) -> tuple[Any, Any]:
        """Return scaled B (6 m + g + c, k) and F, sparse.

        The g guides come after the m elements: rows of unit stiffness in B, without flexibility in F. The c natural
        forces of condensed links come last.
        """
        from scipy.sparse import coo_matrix

        m, guides, units = len(self.lengths), self.model.guides, self.natural_units
        numbers = self.number[self._columns]
        size = np.append(self.unit, 0.0)[numbers]  # -1 stands for what does not move
        moved = units[:, :, None] * (natural_deformations(self.lengths) @ self.matrices) * size[:, None]
        moves = np.broadcast_to((numbers >= 0)[:, None], moved.shape)
        strained = np.broadcast_to(np.arange(6 * m).reshape(m, 6, 1), moved.shape)
        rows, values = [strained[moves]], [moved[moves]]
        columns = [np.broadcast_to(numbers[:, None], moved.shape)[moves]]
        every = zip(self.model.elements, self.lengths, units, strict=True)
        flexibility = self._with_rigid(
            [
                unit[:, None] * natural_flexibility(e.section, e.young, e.poisson, length) * unit
                for e, length, unit in every
            ]
        )
        for row, guide in enumerate(guides, start=6 * m):
            for node, sign in guide.nodes:
                place = self.number[6 * node : 6 * node + 6]
                free = place >= 0
                rows.append(np.full(np.count_nonzero(free), row))
                columns.append(place[free])
                values.append(sign * self.guide_unit[row - 6 * m] * guide.gradient[free] * self.unit[place[free]])
        size, blocks = 6 * m + len(guides), [(6 * i, F) for i, F in enumerate(flexibility)]
        blocks += [(6 * m + i, np.zeros((1, 1))) for i in range(len(guides))]
        for link in self.model.condensed:
            unit, numbers = np.tile(self.condensed_unit, len(link.nodes) - 1), self.number[link.columns]
            free = numbers >= 0
            B = unit[:, None] * link.wrenches.T[:, free] * self.unit[numbers[free]]
            rows.append(size + np.repeat(np.arange(len(unit)), len(B.T)))
            columns.append(np.tile(numbers[free], len(unit)))
            values.append(B.ravel())
            blocks.append((size, unit[:, None] * link.natural_flexibility * unit))
            size += len(unit)
        shape = (size, len(self.unit))
        B = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=shape).tocsr()
        known = [
            (first + row, first + column, F[row, column])
            for first, F in blocks
            for row, column in [np.divmod(np.arange(F.size), len(F))]
        ]
        down, across, entries = (np.concatenate(part) for part in zip(*known, strict=True))
        return B, coo_matrix((entries, (down, across)), shape=(size, size)).tocsr()

    def loaded(self, model: FrameModel) -> tuple[Floats, Floats]:
        """Return scaled deformations v0 (6 m + g + c,) and nodal loads p - p0 (k,) of a frame.

        Parameters
        ----------
        model : FrameModel
            This frame, or one that differs from it in its loads.

        Returns
        -------
        tuple of 2 ndarray
        """
        v0, p = np.zeros(6 * len(self.lengths) + len(model.guides)), np.zeros(len(self.unit))
        for load in model.loads:
            place = self.number[6 * load.node : 6 * load.node + 6]
            np.add.at(p, place[place >= 0], load.wrench[place >= 0])
        for i, (e, length) in enumerate(zip(model.elements, self.lengths, strict=True)):
            if e.load_first.any() or e.load_last.any():
                numbers, matrix = self.place(i)
                v, ends = line_load_effect(e.section, e.young, length, *model.line_load(i))
                v0[6 * i : 6 * i + 6] = self.natural_unit(i) * v
                np.add.at(p, numbers, -(matrix.T @ ends))
        moved = [np.tile(self.condensed_unit, len(link.nodes) - 1) * link.natural_moved for link in model.condensed]
        return np.concatenate([v0, *moved]), p * self.unit


def refuse_mechanism(system: FrameSystem, B: Any) -> None:
    """Refuse a frame that can move without strain.

    The test is kinematic (the null space of the compatibility matrix), so that no difference of stiffnesses can hide or
    mimic a mechanism. Inverse iteration on BᵀB finds the motion of least strain; its strain is then taken from B
    itself, without squaring the rounding error.

    Parameters
    ----------
    system : FrameSystem
        Equations of the frame.
    B : Any
        Its scaled compatibility matrix, sparse.

    Raises
    ------
    CannotRunError
        Where it can, naming what moves most.
    """
    from scipy.sparse import identity
    from scipy.sparse.linalg import splu

    k = B.shape[1]
    if k == 0:
        return
    factors = splu((B.T @ B + 1e-14 * identity(k)).tocsc())
    motion = np.random.default_rng(0).standard_normal(k)
    for _ in range(4):
        motion = factors.solve(motion)
        motion /= np.linalg.norm(motion)
    strain = float(np.linalg.norm(B @ motion))
    if strain < _MECHANISM:
        largest = np.argsort(-np.abs(motion))[:3]
        moving = [system.labels[i] for i in largest if abs(motion[i]) > 0.3 * abs(motion[largest[0]])]
        raise CannotRunError(
            f"the frame is a mechanism: it can move without strain, most of all {', '.join(moving)} "
            f"(strain {strain:.1e} for a unit motion, where {_MECHANISM:g} is the least); support it or tie it there"
        )
