"""The mass of a linkage on its frame: consistent mass matrices of Timoshenko beams, and rigid bodies at nodes.

What moves in the frame weighs as the kernel says. Eyes are rigid bodies about their pins (``eye_masses``). What is left
of a part's mass lies along its beams, arms and flanks of slots included, in proportion to their sections, and changes
linearly along the link so that the centroid is that of the part; where it would become negative for that, or the
centroid lies beside the beams, its line is shifted as a rigid body beside them. Sections have rotary inertia, and where
the part's moment of inertia about z is more than this gives, as that of a wide plate, what is missing is spread along
the beams as rotary inertia. Where it is less, that of the sections is taken off, as far as there is any.
Masses that are spread along a link lie on its axis; bodies stand at a node, with their centroid beside it.

The matrix of a beam is the integral of Nᵀ m N with the shape functions N that its stiffness has, in bending
(Przemieniecki, Theory of Matrix Structural Analysis, 1968, section 11.6; Friedman & Kosmatka, Computers & Structures 47
(1993) 473-481):

    w = N1 w1 + N2 θ1 + N3 w2 + N4 θ2,  N1 = (1 - 3 ξ² + 2 ξ³ + Φ (1 - ξ))/(1 + Φ),  Φ = 12 E I/(κ G A L²), ...

so that the kinetic energy of every motion that its stiffness knows is exact, and frequencies come from above.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.deflection import flexibility
from alula.fea.frame.build import ALONG_X
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import FrameElement, FrameModel
from alula.fea.frame.system import to_ends
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.kinematic_chain import Places
from alula.fea.vibration.eye_masses import eye_bodies, with_rims
from alula.loads.case.case import Case
from alula.loads.records.applied import PartMass
from alula.loads.records.carried import Carried, CarriedSpread, mass_of
from alula.loads.states.masses import all_carried

Floats = NDArray[np.float64]

_XI, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_XI, _WEIGHTS = (1.0 + _XI) / 2.0, _WEIGHTS / 2.0
"""Places and weights along a beam; exact for cubic shapes and a density that changes linearly."""
MOST_IN_EYES = 0.8
"""Share of a part's mass that eyes may have beside its beams; beyond it the part is no beam with eyes."""
IN_PLANE = np.array([True, True, False, False, False, True] * 2)
"""What of the motion of two nodes lies in the linkage's plane."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MassMatrix:
    """The mass of a frame, beam by beam and node by node.

    Attributes
    ----------
    model : FrameModel
        The frame.
    beams : ndarray, shape (m, 12, 12)
        Of the elements, for displacements and rotations of both nodes, global axes [tonne, tonne·mm, tonne·mm²].
    bodies : tuple of (int, ndarray of shape (6, 6))
        Rigid bodies with the nodes that carry them.
    """

    model: FrameModel
    beams: Floats
    bodies: tuple[tuple[int, Floats], ...] = ()

    @cached_property
    def _body_pairs(self) -> tuple[NDArray[np.int64], Floats]:
        """Nodes (b, 2) of the bodies with the ground in second place, and their matrices (b, 12, 12)."""
        found = np.zeros((len(self.bodies), 12, 12))
        for k, (_, matrix) in enumerate(self.bodies):
            found[k, :6, :6] = matrix
        return np.array([(node, -1) for node, _ in self.bodies], dtype=np.int64).reshape(-1, 2), found

    def bordered(self, path: EquilibriumPath) -> Floats:
        """Return the mass matrix in the unknowns of a path of this frame.

        Parameters
        ----------
        path : EquilibriumPath
            Of the frame, at its start.

        Returns
        -------
        ndarray, shape (k + g, k + g)
            With empty rows and columns for the guides.
        """
        axes = path.chain.axes(path.state.rotations)
        pairs, bodies = self._body_pairs
        T = path.places.matrices(axes)
        found = path.places.gathered(T @ self.beams @ T.swapaxes(1, 2))
        if len(bodies):
            places = Places(path.chain, pairs, path.size)
            T = places.matrices(axes)
            found = found + places.gathered(T @ bodies @ T.swapaxes(1, 2))
        return found

    def energies(self, shape: Floats) -> tuple[float, float]:
        """Return twice the kinetic energy of a motion, and that of its part in the linkage's plane.

        Parameters
        ----------
        shape : ndarray, shape (n, 6)
            Velocities of the nodes, global axes [mm/s, rad/s].

        Returns
        -------
        tuple of 2 float
            [tonne·mm²/s²]
        """
        pairs, bodies = self._body_pairs
        moved = np.vstack([shape, np.zeros((1, 6))])
        ends = np.array([e.nodes for e in self.model.elements], dtype=np.int64).reshape(-1, 2)
        whole, plane = 0.0, 0.0
        for nodes, matrices in ((ends, self.beams), (pairs, bodies)):
            v = moved[nodes].reshape(-1, 12)
            whole += float(np.einsum("mi,mij,mj->", v, matrices, v))
            v = v * IN_PLANE
            plane += float(np.einsum("mi,mij,mj->", v, matrices, v))
        return whole, plane


def beam_mass(model: FrameModel, i: int, density: Floats, turning: float = 0.0, aside: Floats | None = None) -> Floats:
    """Return the consistent mass matrix of a beam whose density is given at the four places of integration.

    Parameters
    ----------
    model : FrameModel
        The frame.
    i : int
        Number of the element.
    density : ndarray, shape (4,)
        Mass per length at Gauss's places [tonne/mm].
    turning : float, optional
        Moment of inertia about z per mass, besides that of the section [mm²].
    aside : ndarray, shape (3,), optional
        From the beam to the line of its mass, global axes [mm].

    Returns
    -------
    ndarray, shape (12, 12)
        For the motion of both nodes, global axes.
    """
    element, length, R = model.elements[i], model.length(i), model.axes(i)
    section = element.section
    inertia = np.diag([section.i_y + section.i_z, section.i_y, section.i_z]) / section.area
    if turning:
        z = R[:, 2]  # the axis of the linkage, in the beam's own axes
        inertia = inertia + turning * np.outer(z, z)
    shapes = _shapes(element, length)
    if aside is not None:
        shapes[:, :3] -= _cross(R @ aside) @ shapes[:, 3:]
    grains = density * length * _WEIGHTS
    borne = np.concatenate([shapes[:, :3], inertia @ shapes[:, 3:]], axis=1) * grains[:, None, None]
    across = shapes.reshape(-1, 12) @ to_ends(model, i)
    return np.asarray(across.T @ (borne.reshape(-1, 12) @ to_ends(model, i)))


def _shapes(element: FrameElement, length: float) -> Floats:
    """Displacement and rotation (4, 6, 12) at the places of integration by those of both ends, local axes."""
    _, shear, _, _, about_y, about_z = flexibility(element.section, element.young, element.poisson)
    found, size = np.zeros((len(_XI), 6, 12)), np.array([1.0, length, 1.0, length])
    for row in (0, 3):
        found[:, row, row], found[:, row, row + 6] = 1.0 - _XI, _XI
    for w, turn, sign, bending in ((1, 5, 1.0, about_z), (2, 4, -1.0, about_y)):
        phi = 12.0 * shear / (bending * length**2)
        columns, signs = [w, turn, w + 6, turn + 6], np.array([1.0, sign, 1.0, sign])
        found[:, w, columns] = (_BENT + phi * _SHEARED) * (signs * size / (1.0 + phi))
        found[:, turn, columns] = (_TURNED + phi * _TILTED) * (sign * signs * size / (length * (1.0 + phi)))
    return found


_ZERO = np.zeros(len(_XI))
_BENT = np.array(
    [1.0 - 3.0 * _XI**2 + 2.0 * _XI**3, _XI - 2.0 * _XI**2 + _XI**3, 3.0 * _XI**2 - 2.0 * _XI**3, _XI**3 - _XI**2]
).T
"""N1 to N4 without shear at the places of integration, of a beam of unit length."""
_SHEARED = np.array([1.0 - _XI, (_XI - _XI**2) / 2.0, _XI, (_XI**2 - _XI) / 2.0]).T
"""What shear adds to them, over Φ."""
_TURNED = np.array(
    [6.0 * (_XI**2 - _XI), 1.0 - 4.0 * _XI + 3.0 * _XI**2, 6.0 * (_XI - _XI**2), 3.0 * _XI**2 - 2.0 * _XI]
).T
"""The turns of sections that go with them."""
_TILTED = np.array([_ZERO, 1.0 - _XI, _ZERO, _XI]).T


def _cross(arm: Floats) -> Floats:
    """Matrix of arm x."""
    x, y, z = arm
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def body_mass(mass: float, arm: Floats, inertia: float = 0.0, along: Floats = ALONG_X) -> Floats:
    """Return the mass matrix of a rigid body at a node.

    Parameters
    ----------
    mass : float
        [tonne]
    arm : ndarray, shape (3,)
        From the node to its centroid, global axes [mm].
    inertia : float, optional
        About its centroid and z [tonne·mm²].
    along : ndarray, shape (3,), optional
        Unit vector in the plane. The body is a thin rod along it, with as much inertia about what is normal to both.

    Returns
    -------
    ndarray, shape (6, 6)
    """
    move = np.hstack([np.eye(3), -_cross(arm)])
    found = mass * move.T @ move
    found[3:, 3:] += inertia * (np.eye(3) - np.outer(along, along))
    return np.asarray(found)


def mass_matrix(
    case: Case,
    frame: LinkageFrame,
    divided: FrameModel,
    parents: NDArray[np.int64],
    masses: Mapping[str, PartMass],
    *,
    carried: bool = True,
    rims: bool = True,
) -> MassMatrix:
    """Return the mass of a linkage on its divided frame.

    Parameters
    ----------
    case : Case
    frame : LinkageFrame
        Of the linkage, or of one of its links.
    divided : FrameModel
        Its model with beams divided, whose first nodes are those of the frame.
    parents : ndarray of int, shape (m,)
        Element of the frame that each one is part of.
    masses : mapping of str to PartMass
        Of the parts, by link.
    carried : bool, optional
        False to leave out what the case states as carried; pins are always there.
    rims : bool, optional
        Whether what fillets weigh is at the rims of the eyes; else along the beams.

    Returns
    -------
    MassMatrix
    """
    mass = _Mass(case, frame, divided, parents, rims=rims)
    for link in mass.own:
        mass.part(link, masses[link])
    links = {link for link, _ in frame.points}
    for one in all_carried(case, stated=carried):
        if one.link in links:
            mass.carried(one)
    return MassMatrix(model=divided, beams=mass.beams, bodies=tuple(mass.bodies))


class _Mass:
    """Collects the mass of all links."""

    def __init__(
        self, case: Case, frame: LinkageFrame, divided: FrameModel, parents: NDArray[np.int64], *, rims: bool
    ) -> None:
        self.case, self.frame, self.divided, self.rims = case, frame, divided, rims
        self.beams = np.zeros((len(divided.elements), 12, 12))
        self.bodies: list[tuple[int, Floats]] = []
        self.own: dict[str, list[int]] = {}
        for i, parent in enumerate(parents):
            if int(parent) in frame.beams:
                self.own.setdefault(frame.beams[int(parent)].link, []).append(i)
        self.parents = parents

    def _grains(self, link: str) -> tuple[list[int], Floats, Floats]:
        """Elements of a link's beams, the places of integration on them (e, 4, 2) in its frame, and masses (e, 4).

        The masses are those of sections of unit density.
        """
        elements, place = self.own[link], self.frame.pose
        turn, origin = place.rotation(link), place.origins[link]
        at, sizes = [], []
        for i in elements:
            start, end = self.divided.ends(i)
            points = start + _XI[:, None] * (end - start)
            at.append((points[:, :2] - origin) @ turn)
            sizes.append(self.divided.elements[i].section.area * self.divided.length(i) * _WEIGHTS)
        return elements, np.array(at), np.array(sizes)

    def part(self, link: str, mass: PartMass) -> None:
        """Add a link's part."""
        elements, at, sizes = self._grains(link)
        turn, origin = self.frame.pose.rotation(link), self.frame.pose.origins[link]
        eyes = self._eyes(link, mass, float(sizes.sum()))
        self.bodies += eyes
        weights = np.array([matrix[0, 0] for _, matrix in eyes])
        places = np.array([(self.divided.nodes[node, :2] - origin) @ turn for node, _ in eyes]).reshape(-1, 2)
        offsets = np.array([np.array([matrix[1, 5], -matrix[0, 5]]) @ turn for _, matrix in eyes]).reshape(-1, 2)
        left = mass.mass - float(weights.sum())
        middle = (mass.mass * mass.centroid - (weights @ places + offsets.sum(axis=0))) / left
        sizes = sizes * (left / sizes.sum())
        factors, aside = _matched(at, sizes, PartMass(mass=left, centroid=middle))
        grains = sizes * factors
        line = np.array([*(turn @ aside), 0.0])
        about = at + aside - mass.centroid
        own = [self.divided.elements[i].section for i in elements]
        known = float((grains * (about**2).sum(axis=-1)).sum())
        known += sum(float(g.sum()) * s.i_z / s.area for g, s in zip(grains, own, strict=True))
        for (_, matrix), place, offset in zip(eyes, places - mass.centroid, offsets, strict=True):
            known += float(matrix[5, 5] + 2.0 * offset @ place + matrix[0, 0] * place @ place)
        missing = max((mass.inertia - known) / left, -min(s.i_z / s.area for s in own))
        for i, own_grains in zip(elements, grains, strict=True):
            density = own_grains / (self.divided.length(i) * _WEIGHTS)
            self.beams[i] += beam_mass(self.divided, i, density, missing, line)

    def _eyes(self, link: str, mass: PartMass, beams: float) -> list[tuple[int, Floats]]:
        """Eyes of a link whose beams have this volume; none where they would be the whole part."""
        case, flanks = self.case, {i: self.frame.beams[int(self.parents[i])].flank for i in self.own[link]}
        density = case.links[link].count * case.material_of(link).density
        eyes = eye_bodies(case.body(link), density, self.frame, link, self.divided, flanks)
        known = float(sum(matrix[0, 0] for _, matrix in eyes))
        if not eyes or known >= MOST_IN_EYES * mass.mass:
            return []
        left = max(mass.mass - known - density * beams, 0.0)
        return with_rims(eyes, case.body(link), left) if self.rims else eyes

    def carried(self, one: Carried) -> None:
        """Add what a link carries."""
        points, link = self.case.links[one.link].points, one.link
        if isinstance(one, CarriedSpread) and link in self.own:
            found = [(i, density, _bare(self.divided, i, density)) for i, density in self._spread(one, points)]
            borne = sum(float(density @ _WEIGHTS) * self.divided.length(i) for i, density, _ in found)
            if abs(borne - one.mass) <= 1e-9 * one.mass:  # else it reaches beyond the beams, and stands as a body
                for i, _, matrix in found:
                    self.beams[i] += matrix
                return
        known, place = mass_of(one, points), self.frame.pose
        at = one.start if isinstance(one, CarriedSpread) else one.at
        if (link, at) not in self.frame.points:
            at = next(point for name, point in self.frame.points if name == link)
        turn = place.rotation(link)
        arm, along = (np.array([*(turn @ v), 0.0]) for v in (known.centroid - np.array(points[at]), ALONG_X[:2]))
        self.bodies.append((self.frame.points[link, at], body_mass(known.mass, arm, known.inertia, along)))

    def _spread(self, one: CarriedSpread, points: Mapping[str, tuple[float, float]]) -> Iterator[tuple[int, Floats]]:
        """Yield the elements along the axis of a link between two places, with the density on each."""
        first, last = sorted((points[one.start][0], points[one.end][0]))
        for i in self.own[one.link]:
            beam = self.frame.beams[int(self.parents[i])]
            if beam.arm:
                continue
            start, end = (self._along(one.link, place) for place in self.divided.ends(i))
            low, high = max(start, first), min(end, last)
            if high <= low:
                continue
            share = 0.5 if beam.flank else 1.0
            even = share * one.mass / (last - first) * (high - low) / (end - start)
            # Linear along the element, so that what covers a part of it has its centroid.
            off = ((low + high) / 2.0 - (start + end) / 2.0) / (end - start)
            yield i, even * (1.0 + 12.0 * off * (_XI - 0.5))

    def _along(self, link: str, place: Floats) -> float:
        pose = self.frame.pose
        return float(((place[:2] - pose.origins[link]) @ pose.rotation(link))[0])


def _bare(model: FrameModel, i: int, density: Floats) -> Floats:
    """Mass matrix of what lies on the axis of a beam, without rotary inertia of its own."""
    moved = _shapes(model.elements[i], model.length(i))[:, :3]
    local = np.einsum("p,pai,paj->ij", density * model.length(i) * _WEIGHTS, moved, moved)
    across = to_ends(model, i)
    return np.asarray(across.T @ local @ across)


def _matched(at: Floats, sizes: Floats, mass: PartMass) -> tuple[Floats, Floats]:
    """Factors (e, 4) on masses along beams, and the shift (2,) of their line, that give them a part's centroid."""
    x = at[..., 0]
    middle = float((sizes * x).sum() / mass.mass)
    spread = float((sizes * (x - middle) ** 2).sum() / mass.mass)
    slope = (float(mass.centroid[0]) - middle) / spread if spread > 0.0 else 0.0
    most = 1.0 / max(float(np.abs(x - middle).max()), 1e-300)
    factors = 1.0 + float(np.clip(slope, -most, most)) * (x - middle)
    centre = (sizes * factors)[..., None] * at
    return factors, np.asarray(mass.centroid - centre.sum(axis=(0, 1)) / mass.mass)
