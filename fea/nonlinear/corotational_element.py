"""The co-rotational Timoshenko beam: a small-strain beam on axes that follow its chord.

Kinematics after Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1, 1991, chapter 7
(in the plane) and vol. 2, 1997, chapter 17 (in space), with the element axes of Nour-Omid & Rankin, Comput. Methods
Appl. Mech. Engrg. 93 (1991) 353-384: x along the chord, y by the mean of the two ends' y axes. The natural
deformations are the lengthening and the rotation vectors of both ends relative to these axes; they meet the natural
stiffness of the linear element (``alula.fea.frame.system``), so that small displacements give the linear frame. The
lengthening counts how the axis bows between its ends, L (2 a² - a b + 2 b²)/30 in either plane for a cubic (the
shallow-arch strain, Crisfield, vol. 1, section 7.3; Oran, J. Struct. Div. ASCE 99 (1973) 987-1001): without it a
divided column buckles some 1.3 % late at eight elements.

Line loads are dead loads (fixed in direction and in force per original length). Their potential holds the work on
the chord, on the bending of the element, and on the element's own deflection: one element is exact in the linear
limit, and forces balance on the deformed shape.

The potential of each element is written down once; its gradient (end forces) and Hessian (exact tangent) follow by
second-order forward differentiation. A shift of the whole element changes neither strains nor, but by what the line
loads do along it, the potential. So it is differentiated by nine variables, the displacement of the second node from
the first and the spins of both, and the twelve of the nodes follow.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.deflection import flexibility
from alula.fea.frame.model import FrameModel, Guide
from alula.fea.frame.system import line_load_effect, natural_flexibility
from alula.fea.nonlinear.jet import EPSILON, Bilinear, Jet, cross, dot, stack, unit
from alula.fea.nonlinear.kinematic_chain import changes_of
from alula.geometry.base.errors import CannotRunError

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class ElementResponse:
    """What m elements answer to their end displacements; 12 variables: displacement and spin of both nodes.

    Attributes
    ----------
    forces : ndarray, shape (m, 12)
        What the nodes do to the elements, global axes, moments about the nodes [N, N·mm].
    tangent : ndarray, shape (m, 12, 12)
        Derivative of the forces by the spins (forces taken in global axes).
    """

    forces: Floats
    tangent: Floats


class CorotationalElements:
    """All elements of a frame, ready to be evaluated together."""

    def __init__(self, model: FrameModel) -> None:
        m = len(model.elements)
        self.start = np.array([model.nodes[e.nodes[0]] for e in model.elements])
        self.end = np.array([model.nodes[e.nodes[1]] for e in model.elements])
        self.arms = np.array([e.offsets for e in model.elements])
        self.lengths = np.array([model.length(i) for i in range(m)])
        self.axes = np.array([model.axes(i).T for i in range(m)])
        every = zip(model.elements, self.lengths, strict=True)
        natural = [natural_flexibility(e.section, e.young, e.poisson, length) for e, length in every]
        self.stiffness: Floats = np.asarray(np.linalg.inv(np.array(natural).reshape(m, 6, 6)), dtype=np.float64)
        self.load_bends = np.zeros((m, 6, 6))
        self.load_sags = np.zeros((m, 6, 6))
        self.loads = np.zeros((m, 2, 3))
        for i, e in enumerate(model.elements):
            length = self.lengths[i]
            self.loads[i] = e.load_first, e.load_last
            if not self.loads[i].any():
                continue
            for k, q in enumerate(np.eye(6)):
                self.load_bends[i, :, k] = line_load_effect(e.section, e.young, length, q[:3], q[3:])[0]
            # The work along the chord goes to both ends alike, so lengthening is not coupled to the load.
            self.load_bends[i, 0] = 0.0
            self.load_sags[i] = _own_deflection(model, i)

    def respond(self, displacements: Floats, rotations: Floats, factor: float) -> ElementResponse:
        """Evaluate all elements.

        Parameters
        ----------
        displacements : ndarray, shape (m, 2, 3)
            Of both nodes [mm].
        rotations : ndarray, shape (m, 2, 3, 3)
            Of both nodes.
        factor : float
            Share of the line loads.

        Returns
        -------
        ElementResponse
            Forces and tangent.

        Raises
        ------
        CannotRunError
            Where an end turns by more than a right angle relative to its element.
        """
        return self.loaded(self.natural(displacements, rotations), displacements, rotations, factor)

    def loaded(
        self, natural: tuple[Jet, Jet], displacements: Floats, rotations: Floats, factor: float
    ) -> ElementResponse:
        """Evaluate all elements whose natural deformations are known, as ``respond``.

        Parameters
        ----------
        natural : tuple of 2 Jet
            What ``natural`` returns.
        displacements, rotations, factor
            As of ``respond``.

        Returns
        -------
        ElementResponse
        """
        loads = factor * self.loads
        return _response(self._potential(natural, displacements, rotations, loads), -self._at_ends(loads))

    def pressed(self, natural: Jet, strains: Floats) -> ElementResponse:
        """Evaluate deformed elements under the forces of further strains, with what these add to the tangent.

        Parameters
        ----------
        natural : Jet
            Natural deformations (m, 6), the first that ``natural`` returns.
        strains : ndarray, shape (m, 6)
            Beside these.

        Returns
        -------
        ElementResponse
        """
        forces = (self.stiffness @ strains[:, :, None]).swapaxes(1, 2)
        return _response(natural.map(forces), np.zeros((len(strains), 2, 3)))

    def geometric(self, natural: Floats) -> ElementResponse:
        """Evaluate the undeformed elements under natural forces.

        Parameters
        ----------
        natural : ndarray, shape (m, 6)
            Natural forces [N, N·mm].

        Returns
        -------
        ElementResponse
            Forces and geometric stiffness.
        """
        v, _ = self.undeformed
        return _response(v.map(natural[:, None, :]) - self._undeformed_work, -self._at_ends(self.loads))

    @cached_property
    def undeformed(self) -> tuple[Jet, Jet]:
        """What ``natural`` returns of the elements as they stand."""
        return self.natural(*self._standing)

    @cached_property
    def _undeformed_work(self) -> Jet:
        """Work of the line loads on the chord as the elements stand."""
        return self._work_on_chord(*self._standing, self.loads)

    @property
    def _standing(self) -> tuple[Floats, Floats]:
        """No displacements and rotations of both nodes."""
        m = len(self.lengths)
        return np.zeros((m, 2, 3)), np.tile(np.eye(3), (m, 2, 1, 1))

    def natural(self, displacements: Floats, rotations: Floats) -> tuple[Jet, Jet]:
        """Return the natural deformations and the element's axes.

        Parameters
        ----------
        displacements : ndarray, shape (m, 2, 3)
            Of both nodes [mm].
        rotations : ndarray, shape (m, 2, 3, 3)
            Of both nodes.

        Returns
        -------
        tuple of 2 Jet
            Natural deformations (m, 6), and the element's axes x, y, z one after the other (m, 9).
        """
        first, second = (self._arm(end, rotations) for end in (0, 1))
        chord = second - first
        chord.value[:] += self.end - self.start + (displacements[:, 1] - displacements[:, 0])
        chord.gradient[:, :, :3] += np.eye(3)
        e1 = unit(chord)
        triads = stack(*(_turned(rotations[:, k], self.axes.swapaxes(1, 2), _SPINS[k]) for k in range(2)))
        e3 = unit(cross(e1, triads.map(_MEAN_Y)))
        axes = stack(e1, cross(e3, e1), e3)
        grown, sines = self._from_changes(displacements, rotations)
        angles = _rotation_vectors(axes, triads, sines)
        lengthening = replace(dot(chord, chord).power(0.5), value=grown)
        lengthening = lengthening + angles.form(_BOWING).times(self.lengths[:, None] / 30.0)
        return stack(lengthening, angles.map(_NATURAL)), axes

    def _from_changes(self, displacements: Floats, rotations: Floats) -> tuple[Floats, Floats]:
        """Lengthening (m, 1) and sines (m, 6) of the ends' turns, from what has changed alone.

        Lengths and axes as they are differ from those at rest by less than they round, where loads are small.
        """
        length, (x, y, z) = self.lengths[:, None], self.axes.transpose(2, 0, 1)
        turned = changes_of(rotations)
        parted = displacements[:, 1] - displacements[:, 0]
        for end, sign in ((0, -1.0), (1, 1.0)):
            parted = parted + sign * np.einsum("mij,mj->mi", turned[:, end], self.arms[:, end])
        grown, along = _stretched(length, x, parted)
        triads = np.concatenate([(turned[:, k] @ self.axes).swapaxes(1, 2).reshape(-1, 9) for k in range(2)], axis=1)
        mean = triads @ _MEAN_Y.T
        tilted = 2.0 * np.cross(along, y) + np.cross(x + along, mean)
        _, across = _stretched(2.0, z, tilted)
        upright = np.cross(across, x + along) + np.cross(z, along)
        axes = np.hstack([along, upright, across])
        still, both = np.hstack([x, y, z]), np.hstack([x, y, z, x, y, z])
        return grown, _sines.of(still + axes, triads) + _sines.of(axes, both)

    def _arm(self, end: int, rotations: Floats) -> Jet:
        """From a node to its end of a beam."""
        return _turned(rotations[:, end], self.arms[:, end, None], _SPINS[end])

    def _at_ends(self, loads: Floats) -> Floats:
        """Forces (m, 2, 3) at the ends of the chord that work as line loads (m, 2, 3) do along it."""
        return np.asarray(np.array([[2.0, 1.0], [1.0, 2.0]]) * self.lengths[:, None, None] / 6.0 @ loads)

    def _work_on_chord(self, displacements: Floats, rotations: Floats, loads: Floats) -> Jet:
        """Potential (m, 1) of the line loads (m, 2, 3) at the chord, counted as work done.

        Its gradient leaves out what a shift of the whole element does.
        """
        points = stack(*(self._arm(k, rotations) for k in range(2)))
        points.value[:] += np.hstack([self.start + displacements[:, 0], self.end + displacements[:, 1]])
        points.gradient[:, 3:, :3] += np.eye(3)
        return points.map(self._at_ends(loads).reshape(-1, 1, 6))

    def _potential(self, natural: tuple[Jet, Jet], displacements: Floats, rotations: Floats, loads: Floats) -> Jet:
        v, axes = natural
        if not loads.any():
            return v.form(self.stiffness).times(0.5)
        onto_axes = np.einsum("mkj,ab->mkabj", loads, np.eye(3)).reshape(-1, 6, 9)
        local = axes.map(onto_axes)
        strained = v - local.map(self.load_bends)
        stored = strained.form(self.stiffness) - local.form(self.load_sags)
        return stored.times(0.5) - self._work_on_chord(displacements, rotations, loads)


_SPINS = (3, 6)
"""First of the three variables that are the spin of either node; the three before them are how far the second node
moves from the first."""
_OF_NODES = np.zeros((9, 12))
"""These nine variables from displacement and spin of both nodes."""
_OF_NODES[:3, :3], _OF_NODES[:3, 6:9] = -np.eye(3), np.eye(3)
_OF_NODES[3:6, 3:6] = _OF_NODES[6:, 9:] = np.eye(3)
_MEAN_Y = np.zeros((3, 18))
"""Twice the mean of both ends' y axes, from the triads of both ends."""
_MEAN_Y[:, 3:6] = _MEAN_Y[:, 12:15] = np.eye(3)
_NATURAL = np.zeros((5, 6))
"""Natural deformations 1 to 5 from the rotation vectors of both ends."""
_NATURAL[[0, 1, 2, 3, 4, 4], [2, 5, 1, 4, 3, 0]] = [1.0, 1.0, 1.0, 1.0, 1.0, -1.0]
_BOWING = np.zeros((6, 6))
"""30/L times the lengthening of the axis as its ends turn by a and b: 2 a² - a b + 2 b² in either plane."""
for _a, _b in ((1, 4), (2, 5)):
    _BOWING[np.ix_([_a, _b], [_a, _b])] = [[2.0, -0.5], [-0.5, 2.0]]
_SINES = np.zeros((6, 9, 18))
"""Sines of the turns from axes e to the triads t of both ends: (e_j · t_i - e_i · t_j)/2, with i and j cyclic."""
for _end in range(2):
    for _turn in range(3):
        _i, _j = (_turn + 1) % 3, (_turn + 2) % 3
        for _k in range(3):
            _SINES[3 * _end + _turn, 3 * _j + _k, 9 * _end + 3 * _i + _k] = 0.5
            _SINES[3 * _end + _turn, 3 * _i + _k, 9 * _end + 3 * _j + _k] = -0.5
_sines = Bilinear(_SINES)


def guide_gap(guide: Guide, displacements: Floats, rotations: Floats) -> tuple[float, ElementResponse]:
    """Return the gap d · n or a · n of a guide, which is 0 as the frame stands.

    Parameters
    ----------
    guide : Guide
        Between its carrier and its pin.
    displacements : ndarray, shape (2, 3)
        Of carrier and pin; zero for the ground [mm].
    rotations : ndarray, shape (2, 3, 3)
        Of carrier and pin.

    Returns
    -------
    tuple of float and ElementResponse
        Gap [mm, rad], and what a unit of the guide's force does to both nodes.
    """
    normal = _turned(rotations[None, 0], guide.normal[None, None], _SPINS[0])
    if guide.axis is not None:
        gap = dot(_turned(rotations[None, 1], guide.axis[None, None], _SPINS[1]), normal)
        turned, leant = changes_of(rotations) @ np.array([guide.normal, guide.axis])[:, :, None]
        from_changes = turned[:, 0] @ (guide.axis + leant[:, 0]) + guide.normal @ leant[:, 0]
        gap = replace(gap, value=np.array([[from_changes]]))
    else:
        apart = _constant(displacements[None, 1] - displacements[None, 0])
        apart.gradient[0, :, :3] = np.eye(3)
        gap = dot(apart, normal)
    return float(gap.value[0, 0]), _response(gap, np.zeros((1, 2, 3)))


def _response(potential: Jet, shift: Floats) -> ElementResponse:
    """Gradient of a potential, and its derivative by the spins: the Hessian in rotation vectors less [moment]/2.

    ``shift`` (m, 2, 3) sums up to what shifts of the whole elements do, which the gradient leaves out.
    """
    forces = potential.gradient[:, 0] @ _OF_NODES
    forces[:, :3] += shift.sum(axis=1)
    tangent = _OF_NODES.T @ potential.hessian[:, 0] @ _OF_NODES
    for k in (3, 9):
        tangent[:, k : k + 3, k : k + 3] -= 0.5 * _skew(forces[:, k : k + 3])
    return ElementResponse(forces=forces, tangent=tangent)


def _own_deflection(model: FrameModel, i: int) -> Floats:
    """(6, 6) compliance of an element with held ends to its own line load, by Gauss quadrature (exact).

    The load is (first, last) in local axes; half its quadratic form is the strain energy of the element as a simply
    supported beam, and of the axial load's part that is self-balanced over the chord.
    """
    e, length = model.elements[i], model.length(i)
    along, shear, _, _, about_y, about_z = flexibility(e.section, e.young, e.poisson)
    t = (1.0 + _NODES) / 2.0
    # Per unit load at the first and at the last end, over the span from 0 to 1: N - mean N, V and M.
    n = np.array([-(t - t**2 / 2.0) + 1.0 / 3.0, -(t**2) / 2.0 + 1.0 / 6.0]) * length
    v = np.array([1.0 / 3.0 - t + t**2 / 2.0, 1.0 / 6.0 - t**2 / 2.0]) * length
    m = np.array([t / 3.0 - t**2 / 2.0 + t**3 / 6.0, t / 6.0 - t**3 / 6.0]) * length**2
    dx = _WEIGHTS * length / 2.0
    out = np.zeros((6, 6))
    out[np.ix_([0, 3], [0, 3])] = n * dx @ n.T * along
    for axis, bending in ((1, about_z), (2, about_y)):
        out[np.ix_([axis, axis + 3], [axis, axis + 3])] = m * dx @ m.T * bending + v * dx @ v.T * shear
    return out


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


def _skew(w: Floats) -> Floats:
    x, y, z = w.T
    o = np.zeros_like(x)
    return np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)


def _constant(values: Floats) -> Jet:
    m, c = values.shape
    return Jet(value=values, gradient=np.zeros((m, c, 9)), hessian=np.zeros((m, c, 9, 9)))


def _turned(rotations: Floats, vectors: Floats, first: int) -> Jet:
    """Vectors (m, v, 3) turned by exp(δ) R, with the spin δ the variables from ``first`` on, at δ = 0; (m, 3 v).

    exp(δ) w = w + δ × w + δ × (δ × w)/2 + ... holds all that two derivatives see.
    """
    w = vectors @ rotations.swapaxes(1, 2)
    m, c = len(w), 3 * w.shape[1]
    out = _constant(w.reshape(m, c))
    spin = slice(first, first + 3)
    out.gradient[:, :, spin] = (w @ _ONCE).reshape(m, c, 3)
    out.hessian[:, :, spin, spin] = (w @ _TWICE.reshape(3, 27)).reshape(m, c, 3, 3)
    return out


_ONCE = EPSILON.transpose(2, 0, 1).reshape(3, 9)
"""First derivatives of the components of exp(δ) w by δ, from w."""
_TWICE = np.zeros((3, 3, 3, 3))
"""Second derivatives: (δ_ij w_k + δ_ik w_j)/2 - w_i δ_jk by component i and spins j, k."""
for _i in range(3):
    for _j in range(3):
        _TWICE[_j, _i, _i, _j] += 0.5
        _TWICE[_j, _i, _j, _i] += 0.5
        _TWICE[_i, _i, _j, _j] -= 1.0


def _stretched(length: float | Floats, direction: Floats, change: Floats) -> tuple[Floats, Floats]:
    """By how much vectors of a length and a direction (m, 3) lengthen, (m, 1), and what their directions gain."""
    gained = ((2.0 * length * direction + change) * change).sum(axis=1, keepdims=True)
    after = np.sqrt(length**2 + gained)
    longer = gained / (after + length)
    return longer, (change - longer * direction) / after


def _rotation_vectors(axes: Jet, triads: Jet, sines: Floats) -> Jet:
    """Rotation vectors (m, 6), in the element's axes, that turn these axes into both triads; below a right angle.

    ``sines`` (m, 6) are the values of those that ``_sines`` gives of both.
    """
    traces = np.einsum("mi,mki->mk", axes.value, triads.value.reshape(-1, 2, 9))
    if np.any(traces <= 1.0 + 1e-3):
        raise CannotRunError("a beam bends by a right angle within one element; divide it into more elements")
    sine = replace(_sines(axes, triads), value=sines).rows(3)
    s = dot(sine, sine)
    return (sine * s.apply(*_arc_sine_ratio(s.value))).rows(6)


_SERIES = np.array([1.0, 1 / 6, 3 / 40, 5 / 112, 35 / 1152, 63 / 2816, 231 / 13312, 143 / 10240, 6435 / 557056])
_POWERS = np.arange(len(_SERIES))
"""Of f = asin(√s)/√s by s."""


def _arc_sine_ratio(s: Floats) -> tuple[Floats, Floats, Floats]:
    """Return f = asin(√s)/√s and its first two derivatives by s; by series below s = 0.01."""
    small = s < 0.01
    n = _POWERS
    powers = np.where(small, s, 0.0)[..., None] ** n
    series = (
        powers @ _SERIES,
        powers[..., :-1] @ (n * _SERIES)[1:],
        powers[..., :-2] @ (n * (n - 1) * _SERIES)[2:],
    )
    if small.all():
        return series
    x = np.where(small, 0.25, s)
    root, rest = np.sqrt(x), 1.0 - x
    f = np.arcsin(root) / root
    # f satisfies 2 s f' = 1/√(1 - s) - f.
    first = (1.0 / np.sqrt(rest) - f) / (2.0 * x)
    second = (0.5 * rest**-1.5 - first) / (2.0 * x) - first / x
    return np.where(small, series[0], f), np.where(small, series[1], first), np.where(small, series[2], second)
