"""What every link adds to how far a point of the linkage moves, and which model tells it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from alula.fea.beam.cut_free import beam_loads, link_loads
from alula.fea.beam.deflection import virtual_work as plain_work
from alula.fea.beam.theory import internal_forces
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.source import CONTACT, Source, SourceKind, pin_sources
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.fea.solid.solution import LARGEST_POISSON_RATIO
from alula.fea.solid.virtual_work import Work, virtual_work
from alula.fea.standing.joint_forces import JointForces, solved_frame
from alula.geometry.bodies.body import clamped_end
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.records.applied import PointLoad
from alula.loads.statics.statics import Drive, Reactions, solve_statics

NOTHING = 1e-9
"""Share of the unit load that is rounding: in what a link bears of it, and in what is left over of its balance."""
MESHES = Source(kind=SourceKind.DISCRETISATION, detail=reason("as_largest_displacement_of_solids"))


@dataclass(frozen=True, kw_only=True)
class Shares:
    """Which model tells what every link adds to the displacement of a point.

    Attributes
    ----------
    solids : dict of str to tuple of Work
        Link, and what its solid adds along x and y, and between layers along z [mm].
    carried : dict of str to tuple of float
        The same of its plain beam, where the solid bears the loads of the deformed shape [mm].
    beams : tuple of str
        Links that add something by their beams in the frame.
    unsolved : tuple of str
        Those of them whose solid would tell more, if it were solved.
    driven : bool
        Whether a drive torque acts on one of the solids.
    framed : JointForces or None
        Where the frame that gives the joint forces has condensed solids, which tells all but what ``beams`` add.
    """

    solids: Mapping[str, tuple[Work, ...]] = field(default_factory=dict)
    carried: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    beams: tuple[str, ...] = ()
    unsolved: tuple[str, ...] = ()
    driven: bool = False
    framed: JointForces | None = None

    @property
    def model(self) -> Reason:
        """Which model gives the displacement."""
        if self.framed is not None:
            return reason("frame_of_solids")
        return reason("solids_and_beams", solids=tuple(self.solids), beams=self.beams if self.solids else ())

    @property
    def sources(self) -> tuple[Source, ...]:
        """What makes it uncertain."""
        if self.framed is not None:
            return self.framed.sources
        eyes = (Source(kind=SourceKind.EYES),) if self.beams or not self.solids else ()
        if not self.solids:
            return eyes
        pins = (source for source in pin_sources(driven=self.driven) if source != CONTACT)
        return (MESHES, *pins, *eyes)

    @property
    def missing(self) -> dict[str, float]:
        """How much of the displacement the mesh of each solid leaves open [mm]."""
        return {link: max(work.missing for work in works) for link, works in self.solids.items()}

    def bands(self, *, meshes: float = 1.0, sunk: bool = False) -> dict[str, tuple[Band, ...]]:
        """Return what every solid adds along each axis.

        Parameters
        ----------
        meshes : float, optional
            Share of what meshes leave open that the bands hold.
        sunk : bool, optional
            Whether pins may sink into their bores.

        Returns
        -------
        dict of str to tuple of Band
            Link -> its bands [mm].
        """
        every = self.solids.items()
        return {link: tuple(work.band(meshes=meshes, sunk=sunk) for work in works) for link, works in every}


@dataclass(frozen=True, kw_only=True)
class LoadedLinkage:
    """A load case with what tells how far points of the linkage move.

    Attributes
    ----------
    case : Case
    load_case : str
    moved : LargeDisplacement
        The frame's answer.
    links : mapping of str to LinkResult
        Whose solids tell it, where these were solved.
    free : mapping of str to LinkLoads
        Loads of every link cut free; empty where equilibrium alone does not give the joint forces.
    forces : JointForces or None
        Joint forces; a frame of solids that gave them tells how far points move.
    """

    case: Case
    load_case: str
    moved: LargeDisplacement
    links: Mapping[str, LinkResult]
    free: Mapping[str, LinkLoads]
    forces: JointForces | None = None


def shares_of(loaded: LoadedLinkage, link: str, point: str) -> Shares:
    """Return the work that unit loads at a point do on every link, by its solid where one was solved.

    Parameters
    ----------
    loaded : LoadedLinkage
        With a frame.
    link, point : str

    Returns
    -------
    Shares
    """
    case, moved, forces = loaded.case, loaded.moved, loaded.forces
    assert moved.frame is not None
    if forces is not None and forces.solids:
        return Shares(beams=tuple(other for other in case.checked_links if other not in forces.solids), framed=forces)
    if not loaded.free:
        return Shares(beams=case.checked_links)
    pose, held = moved.frame.pose, moved.frame.held
    longest = pose.linkage.longest
    axes = 3 if forces is not None and forces.frame is not None else 2  # links in layers move out of the plane as well
    units = [PointLoad(link=link, point=point, wrench=unit) for unit in np.eye(6)[:axes]]
    reactions = [_virtual(case, pose, held, unit, forces) for unit in units]
    solids: dict[str, tuple[Work, ...]] = {}
    carried: dict[str, tuple[float, ...]] = {}
    beams: list[str] = []
    unsolved: list[str] = []
    driven = False
    for name, real in loaded.free.items():
        every = zip(reactions, units, strict=True)
        virtual = [link_loads("unit", name, case.body(name), forces, (unit,)) for forces, unit in every]
        if real.size(longest) == 0.0 or max(loads.size(longest) for loads in virtual) <= NOTHING:
            continue
        # A load along a slot, at the pin in it, balances on no solid.
        left = max(np.abs(loads.resultant() / np.repeat([1.0, longest], 3)).max() for loads in virtual)
        result, body = loaded.links[name], case.body(name)
        plain = all(pin.foot is None and pin.slot == 0.0 for pin in body.pins) and has_centre_line(case, name)
        # The plates of a pair between layers bear differently, and one of them does not tell what both give.
        alike = case.links[name].count == 1 or forces is None or forces.pins is None
        known = left <= NOTHING and alike and (moved.state == "small" or plain)
        if not (known and isinstance(result, SolidResult) and not result.displacement_max.unknowable):
            beams.append(name)
            if known and not isinstance(result, SolidResult):
                unsolved.append(name)
            continue
        if moved.state != "small":
            carried[name] = tuple(beam_work(case, name, real, loads) for loads in virtual)
        error = result.discretisation.displacement.index
        solids[name] = virtual_work(result.solution, real, virtual, transfer=case.torque_transfer, error=error)
        driven = driven or any(loads.couples for loads in (real, *virtual))
    return Shares(solids=solids, carried=carried, beams=tuple(beams), unsolved=tuple(unsolved), driven=driven)


def _virtual(case: Case, pose: Pose, held: Drive | None, unit: PointLoad, forces: JointForces | None) -> Reactions:
    """Joint forces under a unit load: by equilibrium, which between layers is that of a frame."""
    if forces is not None and forces.frame is not None:
        frame, solution = solved_frame(case, pose, (unit,), held)
        return frame.reactions(solution.joint_wrenches, solution.residual)
    return solve_statics(pose, held, (unit,))


def has_centre_line(case: Case, link: str) -> bool:
    """Return whether a frame bounds how far a link gives; it does not know the ground's part.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    bool
    """
    return link != case.linkage.ground and case.part_of(link).has_centre_line(case.body(link))


def condensable(case: Case, link: str) -> bool:
    """Return whether a link can be an element of a frame as its solid, condensed to bores and patches.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    bool
        It carries no slot, is not clamped, and has two or more points. A clamp's surface bends as a whole under
        condensed wrenches, where its mouth stays.
    """
    if clamped_end(case.body(link)) is not None:
        return False
    carries = any(joint.carrier == link for joint in case.joints.values())
    meshable = case.material_of(link).poissons_ratio <= LARGEST_POISSON_RATIO
    return not carries and meshable and len(case.links[link].points) > 1


def beam_work(case: Case, link: str, real: LinkLoads, virtual: LinkLoads) -> float:
    """Return the work of virtual loads on the plain beam that a link is in a frame.

    Parameters
    ----------
    case : Case
    link : str
    real, virtual : LinkLoads
        Each a set that balances.

    Returns
    -------
    float
        [N mm]
    """
    body, material = case.body(link), case.material_of(link)
    first, second = (internal_forces(beam_loads(loads, body, material.density)) for loads in (real, virtual))
    section, young, poisson = body.part.frame_section(body), material.youngs_modulus, material.poissons_ratio
    return plain_work(first, second, section, young=young, poisson=poisson)
