"""What a frame is made of: nodes, beams, ties, supports and loads.

Global axes x, y (the linkage's plane) and z (along the pins); mm, N, N·mm, rad. Each node has three displacements
and three rotations (right-hand rule), named ux, uy, uz, rx, ry, rz. Links meet in ties: two nodes at one place
that share some of these, all but rz for a pin along z, which so carries moments about x and y and none about z.
A pin in a slot is kept there by guides.
"""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.fea.frame.condensed import CondensedLink
from alula.fea.frame.spring import FrameSpring
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import Section

Floats = NDArray[np.float64]
Dof = Literal["ux", "uy", "uz", "rx", "ry", "rz"]
DOFS: tuple[Dof, ...] = ("ux", "uy", "uz", "rx", "ry", "rz")
ALL_DOFS = frozenset(DOFS)
PIN_DOFS = ALL_DOFS - {"rz"}
"""What a revolute pin along z holds together."""


def _zeros() -> Floats:
    return np.zeros(3)


def _array(values: ArrayLike, name: str, *shape: int) -> Floats:
    array = np.array(values, dtype=np.float64)
    if array.shape != shape or not np.isfinite(array).all():
        raise CannotRunError(f"{name} must hold {' x '.join(map(str, shape))} finite numbers, not {array.tolist()}")
    array.setflags(write=False)
    return array


@dataclass(frozen=True, kw_only=True, eq=False)
class FrameElement:
    """A straight beam of constant section between two nodes.

    Attributes
    ----------
    nodes : tuple of 2 int
        Numbers of the first and the second node.
    section : Section
        Local z of the element is the section's z.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.
    z_axis : ndarray, shape (3,)
        Direction that local z leans to: its part normal to the element; along the pins by default.
    offsets : ndarray, shape (2, 3)
        Rigid arms from each node to the beam's end, in global axes [mm].
    load_first : ndarray, shape (3,)
        Force per length at the first end, global axes; linear between [N/mm].
    load_last : ndarray, shape (3,)
        The same at the second end.
    rigid : bool
        Whether it stands for a body that does not give, in small displacements; its section is for large ones.
    """

    nodes: tuple[int, int]
    section: Section
    young: float
    poisson: float
    z_axis: Floats = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    offsets: Floats = field(default_factory=lambda: np.zeros((2, 3)))
    load_first: Floats = field(default_factory=_zeros)
    load_last: Floats = field(default_factory=_zeros)
    rigid: bool = False

    def __post_init__(self) -> None:
        """Copy and check."""
        for name in ("z_axis", "load_first", "load_last"):
            object.__setattr__(self, name, _array(getattr(self, name), f"{name} of a frame element", 3))
        object.__setattr__(self, "offsets", _array(self.offsets, "offsets of a frame element", 2, 3))
        s = self.section
        if not min(self.young, s.area, s.i_y, s.i_z, s.torsion) > 0.0 or not -1.0 < self.poisson <= 0.5:
            raise CannotRunError(
                f"a frame element needs positive stiffness and -1 < nu <= 0.5: E = {self.young:g} MPa, "
                f"nu = {self.poisson:g}, A = {s.area:g} mm², I = {s.i_y:g} and {s.i_z:g} mm⁴, J = {s.torsion:g} mm⁴"
            )


@dataclass(frozen=True, kw_only=True)
class Support:
    """Displacements and rotations of a node that the ground holds.

    Attributes
    ----------
    node : int
        Its number.
    dofs : frozenset of Dof
        Held at zero, in global axes.
    """

    node: int
    dofs: frozenset[Dof] = ALL_DOFS


@dataclass(frozen=True, kw_only=True)
class Tie:
    """Two nodes at one place that share displacements and rotations.

    Attributes
    ----------
    nodes : tuple of 2 int
        Their numbers.
    dofs : frozenset of Dof
        Shared, in global axes; by default a pin along z.
    """

    nodes: tuple[int, int]
    dofs: frozenset[Dof] = PIN_DOFS


@dataclass(frozen=True, kw_only=True, eq=False)
class Guide:
    """A pin's node stays in the plane through its carrier's node, whose normal turns with the carrier.

    With an axis it is that axis which stays in a plane of that normal, wherever the node is. Both nodes start at one
    place.

    Attributes
    ----------
    carrier : int or None
        Number of its node; None for the ground.
    pin : int or None
        Number of its node; None for the ground.
    normal : ndarray, shape (3,)
        Unit vector at the start, which turns with the carrier.
    axis : ndarray or None, shape (3,)
        Unit vector at the start, which turns with the pin's node; None where the pin itself is kept.
    """

    carrier: int | None
    pin: int | None
    normal: Floats
    axis: Floats | None = None

    def __post_init__(self) -> None:
        """Copy and check."""
        for name in ("normal", "axis"):
            if getattr(self, name) is not None:
                vector = _array(getattr(self, name), f"the {name} of a guide", 3)
                object.__setattr__(self, name, vector)
                if abs(float(np.linalg.norm(vector)) - 1.0) > 1e-9:
                    raise CannotRunError(f"the {name} of a guide must have unit length, not {vector.tolist()}")
        if self.carrier == self.pin:
            raise CannotRunError("a guide joins two different nodes, or one node and the ground")

    @property
    def nodes(self) -> tuple[tuple[int, float], ...]:
        """Nodes that move, each with the sign of its motion in the guide's equation."""
        return tuple((node, sign) for node, sign in ((self.carrier, -1.0), (self.pin, 1.0)) if node is not None)

    @property
    def gradient(self) -> Floats:
        """(6,) by displacement and rotation of the pin's node, as it stands: what a unit of the guide's force does."""
        if self.axis is None:
            return np.concatenate([self.normal, np.zeros(3)])
        return np.concatenate([np.zeros(3), np.cross(self.axis, self.normal)])


@dataclass(frozen=True, kw_only=True, eq=False)
class NodeLoad:
    """A wrench on a node.

    Attributes
    ----------
    node : int
        Its number.
    wrench : ndarray, shape (6,)
        Global axes: Fx, Fy, Fz [N], Mx, My, Mz [N·mm].
    lever : ndarray, shape (2, 3)
        An arm that turns with the node, and the force at its end, whose moment is in the wrench; that moment so changes
        as the node turns [mm, N].
    """

    node: int
    wrench: Floats
    lever: Floats = field(default_factory=lambda: np.zeros((2, 3)))

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "wrench", _array(self.wrench, "the wrench of a node load", 6))
        object.__setattr__(self, "lever", _array(self.lever, "the lever of a node load", 2, 3))

    @property
    def stiffness(self) -> Floats:
        """(3, 3) by which the moment of the lever resists turns of the node: (F · r) 1 - r Fᵀ [N·mm]."""
        arm, force = self.lever
        return np.asarray(float(arm @ force) * np.eye(3) - np.outer(arm, force))

    def turned(self, rotation: Floats) -> "NodeLoad":
        """Return the load where its node has turned, and with it the arm.

        Parameters
        ----------
        rotation : ndarray, shape (3, 3)
            Of the node.

        Returns
        -------
        NodeLoad
        """
        arm, force = self.lever
        if not arm.any():
            return self
        moved = rotation @ arm
        wrench = self.wrench + np.concatenate([np.zeros(3), np.cross(moved - arm, force)])
        return NodeLoad(node=self.node, wrench=wrench, lever=np.array([moved, force]))


@dataclass(frozen=True, kw_only=True, eq=False)
class FrameModel:
    """A frame and all that acts on it.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Positions [mm].
    elements : tuple of FrameElement
        At least one, or a condensed link.
    supports : tuple of Support
        Of nodes.
    ties : tuple of Tie
        Between nodes.
    guides : tuple of Guide
        Between nodes.
    loads : tuple of NodeLoad
        On nodes.
    names : tuple of str
        Of the nodes, for messages; their numbers where empty.
    condensed : tuple of CondensedLink
        Links that are no beams.
    springs : tuple of FrameSpring
        Between nodes, whose forces as the frame stands are among its loads; in small displacements they keep these.

    Raises
    ------
    CannotRunError
        For an element without length or along its own z, for nodes that do not exist, and for ties or guides between
        nodes at different places.
    """

    nodes: Floats
    elements: tuple[FrameElement, ...]
    supports: tuple[Support, ...]
    ties: tuple[Tie, ...] = ()
    guides: tuple[Guide, ...] = ()
    loads: tuple[NodeLoad, ...] = ()
    names: tuple[str, ...] = ()
    condensed: tuple[CondensedLink, ...] = ()
    springs: tuple[FrameSpring, ...] = ()

    def __post_init__(self) -> None:
        """Copy and check."""
        nodes = np.array(self.nodes, dtype=np.float64)
        object.__setattr__(self, "nodes", _array(nodes, "the nodes of a frame", len(nodes), 3))
        if self.names and len(self.names) != len(nodes):
            raise CannotRunError(f"a frame of {len(nodes)} nodes needs as many names, not {len(self.names)}")
        if not self.elements and not self.condensed:
            raise CannotRunError("a frame needs at least one element")
        named = [e.nodes for e in self.elements] + [t.nodes for t in self.ties]
        named += [(s.node, s.node) for s in self.supports] + [(p.node, p.node) for p in self.loads]
        named += [(n, n) for g in self.guides for n, _ in g.nodes]
        for pair in named:
            if not all(0 <= i < len(nodes) for i in pair):
                raise CannotRunError(f"the frame has nodes 0 to {len(nodes) - 1}, but {pair} are named")
        self._check_elements()
        joined = [t.nodes for t in self.ties]
        joined += [(g.carrier, g.pin) for g in self.guides if g.carrier is not None and g.pin is not None]
        for i, j in joined:
            if np.linalg.norm(nodes[i] - nodes[j]) > 1e-9 * self.size:
                raise CannotRunError(
                    f"tied nodes {self.name(i)} and {self.name(j)} of a frame lie at different places; move one of them"
                )

    def _check_elements(self) -> None:
        starts, ends = self.all_ends
        along, z = ends - starts, np.array([e.z_axis for e in self.elements]).reshape(-1, 3)
        lengths, leans = np.linalg.norm(along, axis=1), np.linalg.norm(z, axis=1)
        for i in np.flatnonzero(~(lengths > 1e-9 * self.size)):
            raise CannotRunError(f"element {i} of the frame has no length; give its nodes different places")
        for i in np.flatnonzero(~(np.linalg.norm(np.cross(along, z), axis=1) > 1e-6 * lengths * leans)):
            raise CannotRunError(f"element {i} of the frame lies along its own z_axis; choose another z_axis for it")

    @cached_property
    def size(self) -> float:
        """Diagonal of the bounding box [mm]."""
        return float(np.linalg.norm(np.ptp(self.nodes, axis=0)))

    def name(self, node: int) -> str:
        """Return the name or number of a node.

        Parameters
        ----------
        node : int
            Its number.

        Returns
        -------
        str
            Its name, or the number.
        """
        return self.names[node] if self.names else str(node)

    def ends(self, i: int) -> tuple[Floats, Floats]:
        """Return both ends of the beam of an element, arms included.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        tuple of 2 ndarray
            First and second end (3,) [mm].
        """
        starts, ends = self.all_ends
        return starts[i], ends[i]

    @cached_property
    def all_ends(self) -> tuple[Floats, Floats]:
        """First and second ends (m, 3) of the beams of all elements, arms included [mm]."""
        a, b = np.array([e.nodes for e in self.elements], dtype=np.int64).reshape(-1, 2).T
        arms = np.array([e.offsets for e in self.elements]).reshape(-1, 2, 3)
        return self.nodes[a] + arms[:, 0], self.nodes[b] + arms[:, 1]

    def length(self, i: int) -> float:
        """Return the length of the beam of an element between its arms.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        float
            Length [mm].
        """
        return self._lengths[i]

    @cached_property
    def _lengths(self) -> list[float]:
        """Of all elements."""
        ends = (self.ends(i) for i in range(len(self.elements)))
        return [float(np.linalg.norm(end - start)) for start, end in ends]

    def axes(self, i: int) -> Floats:
        """Return the local axes of an element.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        ndarray, shape (3, 3)
            Rows: local x, y, z in global axes.
        """
        return np.asarray(self._axes[i])

    @cached_property
    def _axes(self) -> Floats:
        """(m, 3, 3) of all elements."""
        a, b = np.array([e.nodes for e in self.elements]).T
        arms = np.array([e.offsets for e in self.elements])
        x = self.nodes[b] + arms[:, 1] - self.nodes[a] - arms[:, 0]
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        y = np.cross([e.z_axis for e in self.elements], x)
        y /= np.linalg.norm(y, axis=1, keepdims=True)
        return np.stack([x, y, np.cross(x, y)], axis=1)

    def line_load(self, i: int) -> tuple[Floats, Floats]:
        """Return the force per length at both ends of an element.

        Parameters
        ----------
        i : int
            Number of the element.

        Returns
        -------
        tuple of 2 ndarray
            At the first and the second end (3,), local axes [N/mm].
        """
        R = self.axes(i)
        return R @ self.elements[i].load_first, R @ self.elements[i].load_last

    @cached_property
    def load_scale(self) -> float:
        """Sum of the magnitudes of all loads [N], moments divided by ``size``."""
        total = 0.0
        for p in self.loads:
            wrench = p.wrench
            total += float(np.linalg.norm(wrench[:3]) + np.linalg.norm(wrench[3:]) / self.size)
        for i, e in enumerate(self.elements):
            if e.load_first.any() or e.load_last.any():
                first, last = self.line_load(i)
                total += float(np.linalg.norm(first) + np.linalg.norm(last)) / 2.0 * self.length(i)
        return total
