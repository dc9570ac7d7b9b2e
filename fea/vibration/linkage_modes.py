"""Natural frequencies and shapes of the linkage as a whole, in one pose under one set of loads.

They are those of small motions about the pose: (K + K_g) x = ω² M x with the frame's stiffness K, the geometric
stiffness K_g of the forces that the load case's weight, inertia and stated loads make in it (``stiffness_parts``; so
weights and springs hold a linkage), and the mass M of parts, pins and what links carry (``mass_matrix``). The pose is
frozen: Coriolis and gyroscopic terms, and the change of inertia forces with the motion, are left out, which are small
while links turn slowly beside the frequency. So are friction, play, a range of C_N, and the air that moves along. Pins
between layers are tight in both links; the low ends of bands have hinges in the holes in which they may run
(``running_holes``). What the load closes of them is told beside it (``on_rims``). Bands hold the scatter of the load
case, whose forces are all in proportion, and masses as they are.

The drive holds its link rigidly; with a stiffness of its own it is a spring about its joint or along its guide, about
the state in which it held the linkage. A stop that bears is pressed on and holds rigidly. Where the pose balances by
itself nothing holds but springs and weights.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason, reason
from alula.fea.common.scatter import load_scatter
from alula.fea.frame.build import ALONG_PINS, build_frame
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import FrameModel, Guide
from alula.fea.nonlinear.corotational import subdivide
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.on_rims import RimPath
from alula.fea.nonlinear.stability import beam_answers, stiffness_parts
from alula.fea.pins.states import pin_states
from alula.fea.vibration.flexibility_doubt import FlexibilityDoubt
from alula.fea.vibration.mass_matrix import MassMatrix, mass_matrix
from alula.fea.vibration.modes import Mode, NaturalModes, ends_between, lowest, with_scatter
from alula.fea.vibration.running_holes import running_holes, with_hinges, with_low_ends
from alula.geometry.base.errors import CannotRunError
from alula.geometry.linkage.placement import vector
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.records.applied import PartMass

Floats = NDArray[np.float64]

SUBDIVISIONS = 4
"""Elements along the longest beam; shorter ones have fewer in proportion."""
BASIS = 12
"""Modes beyond those asked for in which the doubt about flexibilities is resolved."""
TIGHT_PINS = reason("pins_taken_to_be_tight")
_ROUNDING = 1e-12
"""Negative eigenvalue over the largest that was found, above which it may be rounding."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkageModes:
    """The lowest modes of a linkage in a pose.

    Attributes
    ----------
    pose : Pose
    load_case : str
        Its name.
    frame : LinkageFrame
        Of the linkage, held by its drive.
    model : FrameModel
        Its model with divided beams, to whose nodes the shapes belong.
    modes : tuple of Mode
        The lowest frequency first.
    notes : tuple of Reason or str
        What the reader must know.
    rims : RimModes or None
        What the pins' holes make of the lowest frequency; None where no pin may run, and where that was not asked.
    """

    pose: Pose
    load_case: str
    frame: LinkageFrame
    model: FrameModel
    modes: tuple[Mode, ...]
    notes: tuple[Reason | str, ...] = ()
    rims: "RimModes | None" = None


@dataclass(frozen=True, kw_only=True)
class RimModes:
    """The lowest frequency of a linkage whose pins stand in their holes as its loads press them.

    Attributes
    ----------
    frequency : Band or None
        For vibrations so small that rims go on touching [Hz]; None where pins lean.
    touching, rims : int
        How many rims touch, of all at which pins may run.
    force : float
        The largest at a rim [N].
    """

    frequency: Band | None
    touching: int
    rims: int
    force: float


def linkage_modes(
    case: Case, load_case: str, frame: LinkageFrame, masses: Mapping[str, PartMass], *, count: int = 4
) -> LinkageModes:
    """Return the lowest natural modes of a linkage.

    Parameters
    ----------
    case : Case
        As it stands, with what holds it as its drive.
    load_case : str
        Its name.
    frame : LinkageFrame
        In the pose, under the loads, held by the drive.
    masses : mapping of str to PartMass
        Of the parts, by link.
    count : int, optional
        Modes.

    Returns
    -------
    LinkageModes

    Raises
    ------
    CannotRunError
        Where the held frame moves without strain, or what moves has no mass.
    """
    own = _Held(case, load_case, frame, masses)
    tight = EquilibriumPath(own.model)
    beams = beam_answers(tight, own.held.end_forces)

    def solved(path: EquilibriumPath, mass: MassMatrix) -> tuple[tuple[Mode, ...], float]:
        more = len(path.model.guides) - len(own.model.guides)
        K, G = stiffness_parts(path, own.held.end_forces, np.append(own.guide_forces, np.zeros(more)), beams)

        def swings(share: float) -> tuple[NaturalModes, Floats]:
            found = frame_modes(path, K + share * G + own.drive(path), mass, count + BASIS)
            return found, found.vectors.T @ G @ found.vectors

        found, modes = own.modes(path, mass, swings, count)
        unstable = found.values[:count] < -_ROUNDING * abs(found.values[-1])
        rate = float(np.sqrt(-found.values[0])) if unstable.any() else 0.0
        return modes, rate

    (modes, rate), holes = solved(tight, own.mass), running_holes(case)
    if holes:
        hinged: tuple[Mode, ...] = ()
        loose = with_hinges(frame, own.model, own.parents, holes)
        with suppress(CannotRunError):  # a pin alone may move freely, as between a hinge and a slot
            # Beams and bodies stay where they are, so that they answer and weigh the same.
            hinged, _ = solved(EquilibriumPath(loose, tight.elements), replace(own.mass, model=loose))
        modes = with_low_ends(modes, hinged)
    notes = _notes(frame, rate)
    return LinkageModes(pose=frame.pose, load_case=load_case, frame=frame, model=own.model, modes=modes, notes=notes)


def on_rims(case: Case, found: LinkageModes, masses: Mapping[str, PartMass]) -> LinkageModes:
    """Return the modes of a linkage with the frequency that it has with pins that stand in their holes.

    Parameters
    ----------
    case : Case
        As for ``linkage_modes``.
    found : LinkageModes
        Of the case.
    masses : mapping of str to PartMass
        Of the parts, by link.

    Returns
    -------
    LinkageModes
        The same where no pin may run. Where the rims hold the linkage less than hinges would, low ends are lower.
    """
    pins = pin_states(case, found.frame)
    if pins is None:
        return found
    own = _Held(case, found.load_case, found.frame, masses)
    tangent = pins.tangent(pins.radii.value, pins.value)
    path = EquilibriumPath(own.model)
    state = RimPath(pins.rims.divided(own.divided, own.parents), path, own.drive(path))
    forces = state.forces(tangent)
    guides = forces.guide_forces if own.stiffness is None else _released(case, found.frame, own.divided, forces)[1]
    known = state.extended(tangent, replace(forces, guide_forces=guides))
    modes, count = tuple[Mode, ...](), len(found.modes)
    with suppress(CannotRunError):  # where pins lean that have no mass of their own
        Z, M = known.allowed, own.mass.bordered(path)
        heavy = np.pad(Z.T @ M @ Z, (0, len(known.plain) - Z.shape[1]))

        def swings(share: float) -> tuple[NaturalModes, Floats]:
            found = lowest(known.plain + share * known.pressed, heavy, count + BASIS)
            X = found.vectors
            return replace(found, vectors=Z @ X[: Z.shape[1]]), X.T @ known.pressed @ X

        _, modes = own.modes(path, own.mass, swings, count)
    rims = RimModes(
        frequency=modes[0].frequency if modes else None,
        touching=tangent.touching,
        rims=2 * len(pins.rims.holes),
        force=tangent.force,
    )
    return replace(found, modes=with_low_ends(found.modes, modes), rims=rims)


class _Held:
    """A linkage in a pose with divided beams, held by its drive, under its loads.

    ``divided`` is held rigidly and ``model`` by the drive's stiffness.
    """

    def __init__(self, case: Case, load_case: str, frame: LinkageFrame, masses: Mapping[str, PartMass]) -> None:
        self.frame, self.stiffness = frame, _drive_stiffness(case, frame)
        self.divided, self.parents = divide(frame, SUBDIVISIONS)
        self.held = solve_frame(self.divided)
        self.model, self.guide_forces = self.divided, self.held.guide_forces
        if self.stiffness is not None:
            self.model, self.guide_forces = _released(case, frame, self.divided, self.held)
        carried = case.load_cases[load_case].carried
        self.mass = mass_matrix(case, frame, self.model, self.parents, masses, carried=carried)
        self.doubt = FlexibilityDoubt(case, frame, self.model, self.parents)
        self.scatter = load_scatter(case, load_case)

    def modes(
        self,
        path: EquilibriumPath,
        mass: MassMatrix,
        swings: Callable[[float], tuple[NaturalModes, Floats]],
        count: int,
    ) -> tuple[NaturalModes, tuple[Mode, ...]]:
        """Return what swings under the stated loads, and modes whose bands hold the scatter of these loads.

        ``swings`` tells, at a share of the loads, what swings in the unknowns of the path, and the part of its
        stiffness (c, c) that all of the loads make.
        """
        found, work = swings(1.0)
        if not self.scatter.sources:
            return found, _modes(path, mass, found, count, self.doubt)
        modes, others = _modes(path, mass, found, count, self.doubt, work), []
        ends = self.scatter.low, self.scatter.high
        for share in ends:
            others.append(tuple[Mode, ...]())
            with suppress(CannotRunError):  # where what has no mass is unstable there
                there, pressed = swings(share)
                others[-1] = _modes(path, mass, there, count, self.doubt, share * pressed)
        return found, with_scatter(modes, others, ends_between(found, work, ends, count), self.scatter)

    def drive(self, path: EquilibriumPath) -> Floats:
        """Stiffness of the drive (k + g, k + g)."""
        found = np.zeros((path.size, path.size))
        if self.stiffness:
            way = _drive_way(self.frame, path)
            found[: path.chain.count, : path.chain.count] = self.stiffness * np.outer(way, way)
        return found


def frame_modes(path: EquilibriumPath, tangent: Floats, mass: MassMatrix, count: int) -> NaturalModes:
    """Return the lowest modes of a frame.

    Parameters
    ----------
    path : EquilibriumPath
        Of the frame, at its start.
    tangent : ndarray, shape (k + g, k + g)
        Its whole stiffness, with the guides' rows and columns.
    mass : MassMatrix
        Its mass.
    count : int
        Modes at the most.

    Returns
    -------
    NaturalModes
        With vectors (k + g, c) in the unknowns of the path.
    """
    M, unit = mass.bordered(path), path.unit
    if not path.model.guides:
        found = lowest(tangent * np.outer(unit, unit), M * np.outer(unit, unit), count)
        return replace(found, vectors=unit[:, None] * found.vectors)
    Z = path.allowed(tangent)
    found = lowest(Z.T @ tangent @ Z, Z.T @ M @ Z, count)
    return replace(found, vectors=Z @ found.vectors)


def divide(frame: LinkageFrame, subdivisions: int) -> tuple[FrameModel, NDArray[np.int64]]:
    """Return the model of a linkage with its links' beams divided, and the element of the frame that each is part of.

    Parameters
    ----------
    frame : LinkageFrame
    subdivisions : int
        Elements along the longest beam.

    Returns
    -------
    tuple of FrameModel and ndarray of int, shape (m,)
    """
    lengths = {i: frame.model.length(i) for i in frame.beams}
    longest = max(lengths.values())
    parts = [
        int(np.ceil(subdivisions * lengths[i] / longest - 1e-9)) if i in lengths else 1
        for i in range(len(frame.model.elements))
    ]
    return subdivide(frame.model, parts), np.repeat(np.arange(len(parts)), parts)


def _modes(
    path: EquilibriumPath,
    mass: MassMatrix,
    found: NaturalModes,
    count: int,
    doubt: FlexibilityDoubt,
    pressed: Floats | None = None,
) -> tuple[Mode, ...]:
    """Modes with the bands of their frequencies; ``pressed`` is what the forces make of their stiffness."""
    shapes = node_motions(path, found.vectors)
    bands = doubt.bands(path.model, found, shapes, count, pressed)
    modes = []
    for shape, band in zip(shapes, bands, strict=False):
        whole, plane = mass.energies(shape)
        size = float(np.linalg.norm(shape[:, :3], axis=1).max()) or 1.0
        modes.append(Mode(frequency=band, shape=shape / size, in_plane=plane / whole))
    return tuple(modes)


def _notes(frame: LinkageFrame, rate: float) -> tuple[Reason | str, ...]:
    """What the reader must know; ``rate`` by which an unstable pose departs [1/s]."""
    notes: list[Reason | str] = list(frame.notes)
    if any(not frame.model.elements[i].rigid for i in frame.pin_beams.values()):
        notes.append(TIGHT_PINS)
    if rate > 0.0:
        notes.append(reason("pose_is_unstable", time=1.0 / rate))
    return tuple(notes)


def node_motions(path: EquilibriumPath, vectors: Floats) -> Floats:
    """Return the motions of the nodes by the unknowns of a path.

    Parameters
    ----------
    path : EquilibriumPath
        Of the frame, at its start.
    vectors : ndarray, shape (k + g, c)
        Its unknowns in every motion.

    Returns
    -------
    ndarray, shape (c, n, 6)
        Displacements and rotations, global axes [mm, rad].
    """
    chain = path.chain
    turns = chain.axes(path.state.rotations)[:, None] * vectors[: chain.count, :, None]
    found = np.zeros((len(path.model.nodes), vectors.shape[1], 6))
    moved = np.where(chain.translations[..., None] >= 0, vectors[chain.translations], 0.0)
    found[..., :3] = moved.swapaxes(1, 2)
    for node, steps in enumerate(chain.nodes):
        for step in steps:
            found[node, :, 3:] += turns[step.number]
    return np.ascontiguousarray(found.swapaxes(0, 1))


def _drive_stiffness(case: Case, frame: LinkageFrame) -> float | None:
    """Stiffness of what holds the linkage; None where it is rigid."""
    if frame.held is None or frame.held.stop or case.drive is None:
        return None
    if frame.held.idle:
        return 0.0
    return None if case.drive.stiffness is None else case.drive.stiffness.value


def _released(case: Case, frame: LinkageFrame, divided: FrameModel, held: FrameSolution) -> tuple[FrameModel, Floats]:
    """The divided model without what the drive holds, and the forces of its guides in the held state."""
    free = build_frame(case, frame.pose, frame.loads, held=None, spatial=True).model
    known = {_guide_key(guide): float(force) for guide, force in zip(divided.guides, held.guide_forces, strict=True)}
    assert frame.held is not None
    coarse = frame.reactions(held.joint_wrenches[: len(frame.model.nodes)], held.residual)
    on_pin = coarse.joints[frame.held.joint].wrench[:3]
    forces = [known.get(_guide_key(guide), -float(guide.normal @ on_pin)) for guide in free.guides]
    model = replace(divided, ties=free.ties, supports=free.supports, guides=free.guides)
    return model, np.array(forces)


def _guide_key(guide: Guide) -> tuple[int | None, int | None, tuple[float, ...], bool]:
    return guide.carrier, guide.pin, tuple(guide.normal), guide.axis is None


def _drive_way(frame: LinkageFrame, path: EquilibriumPath) -> Floats:
    """Turn of the driven joint, or way along its guide, by the unknowns of a path."""
    assert frame.held is not None
    name, chain = frame.held.joint, path.chain
    first, second = frame.pins[name]
    slides = frame.pose.linkage.joints[name].slides
    if name in frame.pin_ends:
        end = frame.pin_ends[name]
        first, second = (first, end) if frame.meets_first(name) else (end, second)
    way, axes = np.zeros(chain.count), chain.axes(path.state.rotations)
    along = vector(frame.pose.placement.along(name)) if slides else ALONG_PINS
    for node, sense in ((first, -1.0), (second, 1.0)):
        if node is None:
            continue
        if slides:
            places = chain.translations[node]
            np.add.at(way, places[places >= 0], sense * along[places >= 0])
        else:
            for step in chain.nodes[node]:
                way[step.number] += sense * float(axes[step.number] @ along)
    return way
