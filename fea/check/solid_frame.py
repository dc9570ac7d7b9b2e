"""Joint forces that depend on the links' stiffness: from a frame whose links are their solids, condensed to the pins.

Where a linkage is redundant, or bonded, or loaded out of its plane, its links share the load by their stiffness. A
frame of centre lines has it within the bounds of ``alula.fea.frame.displacement_band`` where links are like those that
were measured, and may be far off elsewhere: in short plates, and in parts that are no beams. ``centre_lines_do`` tries
these bounds. Where they matter, every link of the frame that can be meshed is the flexibility of its solid
(``alula.fea.solid.condensation``) on the first mesh. So it is where the bounds leave the displacement of a point open.

What remains open is tried cause by cause, since a frame takes milliseconds: the mesh of each link, by the estimated
error of its energy, and each pin under either pressure. The frame is linear; all causes count at their worst together.
Pins that sink into the sides they press, beyond the mean motion of their bores, are tried too, and told apart.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import asked
from alula.fea.beam.calibration import uncalibrated
from alula.fea.beam.cut_free import link_loads
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.plates import plates
from alula.fea.common.reason import reason, together
from alula.fea.common.source import PIN_PRESSURE, Source, SourceKind
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.elements.space import displacement_space
from alula.fea.frame.build import build_frame
from alula.fea.frame.condensed import LinkFlexibility
from alula.fea.frame.displacement_band import flexibility_ranges
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.point_displacement import point_outcome
from alula.fea.outcomes.point_shares import LoadedLinkage, condensable
from alula.fea.refine.error_estimate import estimate_error
from alula.fea.solid.condensation import CondensedSolid, Give, condense
from alula.fea.solid.stress import stress_field
from alula.fea.standing.case_statics import CaseStatics
from alula.fea.standing.joint_forces import LAYERED_FRAME, OF_SOLIDS, Deviation, JointForces, on_pins
from alula.geometry.meshing.mesh import MeshSettings, mesh_bodies
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.case.case import Case
from alula.loads.case.forks import apart
from alula.loads.records.applied import Load
from alula.loads.records.check_spec import DisplacementCheck
from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]

SAME = 0.02
"""Change of a joint force, over the largest one, below which centre lines do."""
UNMEASURED = (0.5, 2.0)
"""Flexibility, over that of its centre line, that is tried of a link for which hand calculation was not calibrated."""
ESTIMATE = 1.0 / 0.41
"""Largest true error over the estimated one, in the energy norm (``alula.fea.refine.error_estimate``)."""
ROUNDS = 8
"""In which the directions of pin forces, and with them how bores give, are found."""
SETTLED = 1e-4
MESH = Source(kind=SourceKind.DISCRETISATION, detail=reason("of_sharing_solids"))
EYES = Source(kind=SourceKind.EYES, detail=reason("of_beams_in_frame"))


def with_solids(
    statics: CaseStatics,
    moved: Mapping[str, LargeDisplacement],
    settings: MeshSettings,
    *,
    always: bool,
    threads: int | None = None,
) -> tuple[CaseStatics, dict[str, TaggedMesh]]:
    """Return the statics of a case with joint forces by the links' solids wherever their stiffness decides.

    A load case that was followed on its deformed shape keeps its centre lines. So does one in which layers alone make
    the frame: what pins leave open of the couples holds more than what stiffness does.

    Parameters
    ----------
    statics : CaseStatics
        With the joint forces of centre lines.
    moved : mapping of str to LargeDisplacement
        Load case -> what became of it.
    settings : MeshSettings
        Of the meshes.
    always : bool
        True where solids are asked for; else they are taken where centre lines do not do, or leave the check of a
        point open.
    threads : int or None, optional
        That may work at once.

    Returns
    -------
    tuple of CaseStatics and dict of str to TaggedMesh
        Statics, and the meshes that were made.
    """
    case, forces = statics.case, dict(statics.forces)
    open_cases = [
        name
        for name, found in forces.items()
        if found.frame is not None
        and found.model != LAYERED_FRAME
        and (always or not centre_lines_do(case, found) or _leave_a_point_open(case, name, moved[name], found))
    ]
    for name in open_cases:
        if moved[name].followed:
            why = together(forces[name].reason, reason("followed_with_centre_lines"))
            forces[name] = replace(forces[name], reason=why)
    wanted = [name for name in open_cases if not moved[name].followed]
    bodies = {link: case.body(link) for link in case.bending_links if wanted and condensable(case, link)}
    if not bodies:
        return replace(statics, forces=forces), {}
    meshes = mesh_bodies(bodies, settings, processes=threads)
    solids = {}
    for link, body in bodies.items():
        material = case.material_of(link)
        solids[link] = condense(
            displacement_space(meshes[link]),
            body,
            [
                plates(link_loads(name, link, body, forces[name].reactions, statics.loads[name]), apart(case, link))[0]
                for name in wanted
            ],
            E=material.youngs_modulus,
            nu=material.poissons_ratio,
            density=material.density,
            threads=threads,
        )
    for name in wanted:
        forces[name] = _Linkage(case, name, statics.loads[name], forces[name], solids).joint_forces()
    return replace(statics, forces=forces), meshes


def _leave_a_point_open(case: Case, load_case: str, moved: LargeDisplacement, forces: JointForces) -> bool:
    """Whether centre lines leave the check of a point open; what was followed on its deformed shape keeps them."""
    loaded = LoadedLinkage(case=case, load_case=load_case, moved=moved, links={}, free={}, forces=forces)
    return not moved.followed and any(
        point_outcome(loaded, one).verdict is Verdict.UNDECIDED
        for one in asked(case, DisplacementCheck, quantity=Quantity.DISPLACEMENT)
    )


def centre_lines_do(case: Case, forces: JointForces) -> bool:
    """Return whether no joint force of a frame changes much within what its links' stiffness may be.

    Parameters
    ----------
    case : Case
    forces : JointForces
        By a frame of centre lines.

    Returns
    -------
    bool
    """
    frame, solution = forces.frame, forces.solution
    assert frame is not None
    assert solution is not None
    ranges = flexibility_ranges(case, frame, solution)
    for link in case.bending_links:
        if uncalibrated(case.body(link), case.material_of(link).poissons_ratio):
            ranges[link] = UNMEASURED
    for link, ends in ranges.items():
        for end in ends:
            found = _solved(frame, {link: end})[1]
            if _change(found, forces.on_tight_pins) > SAME * _size(forces.on_tight_pins):
                return False
    return True


def _solved(frame: LinkageFrame, softer: Mapping[str, float]) -> tuple[FrameSolution, Reactions]:
    """Solve a frame with the beams of some links as many times as flexible."""
    elements = list(frame.model.elements)
    for i, beam in frame.beams.items():
        if beam.link in softer:
            elements[i] = replace(elements[i], young=elements[i].young / softer[beam.link])
    solution = solve_frame(replace(frame.model, elements=tuple(elements)))
    return solution, frame.reactions(solution.joint_wrenches, solution.residual)


def _size(reactions: Reactions) -> float:
    """Largest joint force, or moment over the longest link [N]."""
    wrenches = np.array([joint.wrench for joint in reactions.joints.values()])
    forces = np.linalg.norm(wrenches[:, :3], axis=1)
    moments = np.append(np.linalg.norm(wrenches[:, 3:], axis=1), abs(reactions.drive_torque))
    return float(max(forces.max(), moments.max() / reactions.pose.linkage.longest))


def _change(one: Reactions, other: Reactions) -> float:
    """Return the size of the difference of two sets of joint forces of one linkage [N]."""
    joints = {
        name: replace(joint, wrench=joint.wrench - other.joints[name].wrench) for name, joint in one.joints.items()
    }
    return _size(replace(one, joints=joints, drive_torque=one.drive_torque - other.drive_torque))


@dataclass(frozen=True, kw_only=True)
class _Answer:
    """One solution of a linkage."""

    frame: LinkageFrame
    solution: FrameSolution
    reactions: Reactions

    def by(self, source: Source | None) -> Deviation:
        """Return this answer as that with a cause of doubt at its end; None for a pin that sinks."""
        points = self.frame.at_points(self.solution.displacements)
        return Deviation(source=source, reactions=self.reactions, points=points)


class _Linkage:
    """A linkage under one load case, with links that are condensed solids."""

    def __init__(
        self,
        case: Case,
        load_case: str,
        loads: Sequence[Load],
        plain: JointForces,
        solids: Mapping[str, CondensedSolid],
    ) -> None:
        self.case, self.load_case, self.loads, self.plain, self.solids = case, load_case, loads, plain, solids

    def joint_forces(self) -> JointForces:
        """Return joint forces, and what the links' stiffness leaves open of them."""
        pressed: dict[tuple[str, str], tuple[Real, Give]] = {}
        found = self._answer({})
        for _ in range(ROUNDS):
            pressed, before = self._pressed(found.reactions), found
            found = self._answer({key: (force, give.value) for key, (force, give) in pressed.items()})
            if _change(found.reactions, before.reactions) <= SETTLED * _size(found.reactions):
                break
        tight = JointForces(
            reactions=found.reactions,
            model=OF_SOLIDS[self.plain.model],
            reason=self.plain.reason,
            frame=found.frame,
            solution=found.solution,
            solids=tuple(self.solids),
            deviations=tuple(self._deviations(found, pressed)),
            play=self.plain.play,
        )
        return on_pins(self.case, tight)

    def _answer(
        self, gives: Mapping[tuple[str, str], tuple[Real, float]], softer: Mapping[str, float] | None = None
    ) -> _Answer:
        """Solve with pins that give along their forces, and links that are as many times as flexible."""
        softer, flexible = softer or {}, {}
        for link, solid in self.solids.items():
            times, count = softer.get(link, 1.0), self.case.links[link].count
            matrix = times * solid.flexibility / count
            for k, name in enumerate(solid.places):
                if (link, name) in gives:
                    force, give = gives[link, name]
                    along = force / np.linalg.norm(force)
                    matrix[6 * k : 6 * k + 2, 6 * k : 6 * k + 2] += give / count * np.outer(along, along)
            moved = times * solid.moved.get(self.load_case, np.zeros(len(matrix)))
            flexible[link] = LinkFlexibility(places=solid.places, flexibility=matrix, moved=moved)
        assert self.plain.frame is not None
        frame = build_frame(
            self.case,
            self.plain.frame.pose,
            self.loads,
            held=self.plain.frame.held,
            solids=flexible,
        )
        solution, reactions = _solved(frame, softer)
        return _Answer(frame=frame, solution=solution, reactions=reactions)

    def _cut(self, link: str, reactions: Reactions) -> LinkLoads:
        loads = link_loads(self.load_case, link, self.case.body(link), reactions, self.loads)
        return plates(loads, apart(self.case, link))[0]

    def _bonded(self, link: str) -> set[str]:
        """Points of a link at which it is bonded to another."""
        assert self.plain.frame is not None
        linkage, bonded = self.case.linkage, self.plain.frame.bonded
        return {linkage.point_of(name, link) for name in linkage.joints_of(link) if name in bonded}

    def _pressed(self, reactions: Reactions) -> dict[tuple[str, str], tuple[Real, Give]]:
        """Force (2,) on every bore that a pin presses, in its link's axes, and how the bore gives.

        A bonded pin holds its bore all round, as the wrenches of the flexibility do.
        """
        least, found = SETTLED * _size(reactions), {}
        for link, solid in self.solids.items():
            held = self._bonded(link)
            for pin in self._cut(link, reactions).pins:
                force = pin.wrench[:2]
                if np.linalg.norm(force) > least and pin.name not in held:
                    found[link, pin.name] = (force, solid.give(pin.name, force))
        return found

    def _deviations(self, found: _Answer, pressed: Mapping[tuple[str, str], tuple[Real, Give]]) -> Iterator[Deviation]:
        """Yield answers with the mesh of one link, one pin, or one link that is a beam at the end of its bounds."""
        gives = {key: (force, give.value) for key, (force, give) in pressed.items()}
        for link in self.solids:
            softer = 1.0 + ESTIMATE**2 * self._estimate(link, found.reactions)
            for times in (softer, 1.0 / softer):
                yield self._answer(gives, {link: times}).by(MESH)
        for key, (force, give) in pressed.items():
            for end, source in ((give.narrow, PIN_PRESSURE), (give.sunk, None)):
                yield self._answer({**gives, key: (force, end)}).by(source)
        for link, ends in flexibility_ranges(self.case, found.frame, found.solution).items():
            for end in ends:
                yield self._answer(gives, {link: end}).by(EYES)

    def _estimate(self, link: str, reactions: Reactions) -> float:
        """Estimated error of a link's strain energy, relative; that of its flexibility under what acts on it."""
        solid, cut = self.solids[link], self._cut(link, reactions)
        wrenches = dict.fromkeys(solid.places, np.zeros(6))
        wrenches |= {pin.name: pin.wrench.copy() for pin in cut.pins} | {end.name: end.wrench for end in cut.ends}
        for couple in cut.couples:
            wrenches[couple.pin][5] += couple.torque
        moved = solid.under(np.concatenate([*wrenches.values()]), self.load_case)
        if not moved.any():
            return 0.0
        field = stress_field(solid.space, moved, E=solid.E, nu=solid.nu)
        return estimate_error(field, moved, E=solid.E, nu=solid.nu).relative ** 2
