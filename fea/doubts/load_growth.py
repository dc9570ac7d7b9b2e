"""What grows out of proportion to the load: bending under compression, and the forces in a linkage that moves.

The deformed shape of a linkage of linear material depends on the ratio of load to modulus alone. So the case is
calculated again with all moduli divided by the least and by the largest value of that ratio. The forces found, times
the load's scatter, are those under the scattered load.

Where displacements are small, numbers are those of the undeformed pose, and what they become on the deformed shape is
growth. There it goes with scattered loads no faster than a shallow toggle's (``alula.fea.nonlinear.stability.growth``),
which bounds it as well where no deformed shape was found.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter, load_over_modulus
from alula.fea.common.source import Source, SourceKind
from alula.fea.links.link_by_hand import LinkByHand, cut_link, plates_by_hand
from alula.fea.nonlinear.large_displacement import LargeDisplacement, examine, with_growth
from alula.fea.nonlinear.stability import growth
from alula.fea.standing.joint_forces import joint_forces
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.records.applied import Load
from alula.loads.statics.statics import Reactions

SOURCES = (Source(kind=SourceKind.GROWTH, detail=reason("growth_of_bending")),)
LEAST = 1e-3
"""Growth below which it is left out."""
NOTHING = 1e-9
"""Share of the largest number of its kind below which one is rounding."""


@dataclass(frozen=True, kw_only=True)
class Growths:
    """Growth out of proportion to the load; that of displacements out of proportion to load over modulus.

    A link or joint in proportion is left out. The upper end is infinite where nothing holds the scattered load.

    Attributes
    ----------
    stress, displacement : mapping of str to Scatter
        Link -> growth of its stress, and of its displacement.
    joints : mapping of str to Scatter
        Joint -> growth of its force.
    torques : mapping of str to Scatter
        Joint -> growth of the torque that goes through it (``alula.fea.judging.connections``).
    pins : mapping of str to Scatter
        Joint -> growth of the stress of its pin, beside that of the joint's force.
    columns : mapping of str to Scatter
        Link -> growth of the inverse of its buckling factor, where that is known beside the forces of its joints.
    """

    stress: Mapping[str, Scatter] = field(default_factory=dict)
    displacement: Mapping[str, Scatter] = field(default_factory=dict)
    joints: Mapping[str, Scatter] = field(default_factory=dict)
    torques: Mapping[str, Scatter] = field(default_factory=dict)
    pins: Mapping[str, Scatter] = field(default_factory=dict)
    columns: Mapping[str, Scatter] = field(default_factory=dict)

    def of_pin(self, joint: str) -> Scatter:
        """Return the growth of the stress of a joint's pin.

        Parameters
        ----------
        joint : str

        Returns
        -------
        Scatter
        """
        return self.joints.get(joint, Scatter()).times(self.pins.get(joint, Scatter()))

    def through(self, joint: str) -> Scatter:
        """Return the growth of all that goes through a joint: its force, its torque, or both.

        Parameters
        ----------
        joint : str

        Returns
        -------
        Scatter
        """
        return self.joints.get(joint, Scatter()).either(self.torques.get(joint, Scatter()))

    def times(self, other: "Growths") -> "Growths":
        """Return what both make together.

        Parameters
        ----------
        other : Growths

        Returns
        -------
        Growths
        """
        found = {}
        for kind in ("stress", "displacement", "joints", "torques", "pins", "columns"):
            one, two = getattr(self, kind), getattr(other, kind)
            found[kind] = {name: one.get(name, Scatter()).times(two.get(name, Scatter())) for name in {**one, **two}}
        return Growths(**found)


def telling(found: Mapping[str, Scatter]) -> dict[str, Scatter]:
    """Return the growths that are wide enough to be told.

    Parameters
    ----------
    found : mapping of str to Scatter

    Returns
    -------
    dict of str to Scatter
    """
    return {name: one for name, one in found.items() if one.high - one.low > LEAST}


Numbers = tuple[dict[str, float], dict[str, float], dict[str, float], dict[str, float]]
"""Stress and displacement of links, forces and torques of joints."""


def growths(
    case: Case,
    load_case: str,
    pose: Pose,
    loads: Sequence[Load],
    moved: LargeDisplacement,
    reactions: Reactions,
    hands: Mapping[str, LinkByHand],
) -> Growths:
    """Return what the load, with its scatter and that of the modulus, makes of numbers beyond proportion, by hand.

    Parameters
    ----------
    case : Case
    load_case : str
    pose : Pose
    loads : sequence of Load
        Of the load case, in that pose.
    moved : LargeDisplacement
        The frame's answer.
    reactions : Reactions
        In the undeformed pose.
    hands : mapping of str to LinkByHand
        Link -> its hand calculation.

    Returns
    -------
    Growths
    """
    low, high = load_over_modulus(case, load_case, hands)
    plain = by_hand_numbers(hands, moved.reactions or reactions)
    stated = _Stated(case=case, load_case=load_case, loads=loads, reactions=reactions)
    found = Growths()
    if moved.state == "small":
        found = stated.of_small(moved, plain, high)
    elif low < high and moved.state in ("deformed", "off", "unknown"):
        found = stated.between(pose, plain, low, high)
    return found


def beyond_undeformed(
    case: Case,
    load_case: str,
    pose: Pose,
    loads: Sequence[Load],
    moved: LargeDisplacement,
    reactions: Reactions,
    hands: Mapping[str, LinkByHand],
) -> Growths:
    """Return what the deformed shape makes of numbers of the undeformed pose, whatever became of it.

    Those are told over a motion. Bands hold them too, and what the largest load over modulus makes of them.

    Parameters
    ----------
    case : Case
    load_case : str
    pose : Pose
    loads : sequence of Load
        Of the load case, in that pose.
    moved : LargeDisplacement
        The frame's answer (``with_growth``).
    reactions : Reactions
        In the undeformed pose.
    hands : mapping of str to LinkByHand
        Link -> its hand calculation there.

    Returns
    -------
    Growths
        With upper ends that are infinite where the linkage gives way.
    """
    high, plain = load_over_modulus(case, load_case, hands)[1], by_hand_numbers(hands, reactions)
    stated = _Stated(case=case, load_case=load_case, loads=loads, reactions=reactions)
    if moved.state == "small":
        return stated.of_small(moved, plain, high)
    if moved.gives_way:
        return _told([dict.fromkeys(kind, (1.0, math.inf)) for kind in plain])
    plain = plain if moved.reactions is None else stated.on_tight_pins(moved, plain)
    every: list[Numbers | None] = [stated.by_hand(moved)]
    if high > 1.0:
        every.append(stated.at(pose, high))
    found = []
    for i, before in enumerate(plain):
        least = NOTHING * max(before.values(), default=0.0)
        found.append(
            {
                name: (
                    min(1.0, *(after[i][name] / value for after in every if after is not None)),
                    max(1.0, *(math.inf if after is None else after[i][name] / value for after in every)),
                )
                for name, value in before.items()
                if value > least
            }
        )
    return _told(found)


def _told(ends: Sequence[Mapping[str, tuple[float, float]]]) -> Growths:
    stress, displacement, joints, torques = (
        {
            name: Scatter(low=low, high=high, sources=SOURCES)
            for name, (low, high) in kind.items()
            if low < 1.0 - LEAST or high > 1.0 + LEAST
        }
        for kind in ends
    )
    return Growths(stress=stress, displacement=displacement, joints=joints, torques=torques)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Stated:
    """A load case as stated, and what becomes of its numbers by hand."""

    case: Case
    load_case: str
    loads: Sequence[Load]
    reactions: Reactions

    def of_small(self, moved: LargeDisplacement, plain: Numbers, high: float) -> Growths:
        """Growth of the numbers of the undeformed pose, at the largest load over modulus."""
        nominal, most = (growth(moved.factor / times) - 1.0 if moved.factor else 0.0 for times in (1.0, high))
        if moved.grown is None:
            return _told([dict.fromkeys(kind, (1.0 / (1.0 + most), 1.0 + most)) for kind in plain])
        rise = max(most / nominal if nominal > 0.0 else high, 1.0)
        found = []
        for before, after in zip(self.on_tight_pins(moved, plain), self.by_hand(moved.grown), strict=True):
            least = NOTHING * max(before.values(), default=0.0)
            over = {n: rise * (after[n] / value - 1.0) if value > least else 0.0 for n, value in before.items()}
            found.append({name: (max(1.0 + min(x, 0.0), 0.0), 1.0 + max(x, 0.0)) for name, x in over.items()})
        return _told(found)

    def between(self, pose: Pose, plain: Numbers, low: float, high: float) -> Growths:
        """Growth of the numbers of the load case from the least to the largest load over modulus."""
        least, most = (self.at(pose, factor) for factor in (low, high))
        found = []
        for i, kind in enumerate(plain):
            # Displacement is in proportion to load over modulus, which its own scatter holds.
            over = (low, high) if i == 1 else (1.0, 1.0)
            ends = {
                name: (
                    1.0 if least is None or value <= 0.0 else min(1.0, least[i][name] / value / over[0]),
                    1.0 if value <= 0.0 else math.inf if most is None else max(1.0, most[i][name] / value / over[1]),
                )
                for name, value in kind.items()
            }
            found.append(ends)
        return _told(found)

    def on_tight_pins(self, moved: LargeDisplacement, plain: Numbers) -> Numbers:
        """Numbers on the undeformed shape with pins as they are on the deformed one.

        Frames that deform have tight pins. What pins that run make of couples between layers is no growth, and has a
        band of its own (``alula.fea.doubts.force_doubt``). Numbers of a motion hold no bending that grows.
        """
        if moved.pins is None or moved.frame is None or moved.solution is None:
            return plain
        found = moved.frame.reactions(moved.solution.joint_wrenches, moved.solution.residual)
        flat = replace(moved, state="small", links={}, reactions=None)
        tight, running = (replace(self, reactions=one).by_hand(flat) for one in (found, self.reactions))
        numbers = zip(plain, tight, running, strict=True)
        stress, displacement, joints, torques = (
            {name: value * (one[name] / two[name] if two[name] > 0.0 else 1.0) for name, value in own.items()}
            for own, one, two in numbers
        )
        return stress, displacement, joints, torques

    def by_hand(self, moved: LargeDisplacement) -> Numbers:
        """Numbers of the load case on a shape."""
        case, name = self.case, self.load_case
        cut = {link: cut_link(case, link, name, moved, self.reactions, self.loads) for link in case.checked_links}
        hands = {link: plates_by_hand(case, link, borne)[0][1] for link, borne in cut.items()}
        return by_hand_numbers(hands, moved.reactions or self.reactions)

    def at(self, pose: Pose, factor: float) -> Numbers | None:
        """Numbers of the load case where load over modulus is ``factor`` times its own; None where nothing holds it.

        In the undeformed pose the joint forces are the same.
        """
        soft, name = replace(self, case=_softened(self.case, self.load_case, factor)), self.load_case
        try:
            forces = joint_forces(soft.case, pose, self.loads)
            shape = examine(soft.case, name, forces, self.loads)
            moved = with_growth(soft.case, name, shape, self.loads)
            return None if moved.gives_way else soft.by_hand(moved.grown or moved)
        except (CaseError, CannotRunError):
            return None


def by_hand_numbers(hands: Mapping[str, LinkByHand], reactions: Reactions) -> Numbers:
    """Return the numbers that grow.

    Parameters
    ----------
    hands : mapping of str to LinkByHand
        Link -> its hand calculation.
    reactions : Reactions

    Returns
    -------
    tuple of 4 dict of str to float
        Link -> stress [MPa], of a link without beam its largest joint force [N]; link -> displacement [mm];
        joint -> force [N]; joint that passes a torque on -> that torque [N mm].
    """
    forces = {name: float(np.linalg.norm(joint.wrench[:3])) for name, joint in reactions.joints.items()}
    linkage, drive = reactions.pose.linkage, reactions.drive
    joints = linkage.joints_of
    torques = {
        name: abs(float(joint.wrench[5])) for name, joint in reactions.joints.items() if linkage.joints[name].fixed
    }
    if drive is not None and drive.joint not in torques:
        torques[drive.joint] = abs(float(reactions.driving[0]))
    return (
        {
            link: max((forces[name] for name in joints(link)), default=0.0)
            if hand.check.without
            else hand.worst[1].equivalent
            for link, hand in hands.items()
        },
        {link: hand.displacement for link, hand in hands.items()},
        forces,
        torques,
    )


def _softened(case: Case, load_case: str, factor: float) -> Case:
    """Return the case with all moduli divided by a factor and no range of them, and no scatter of the load."""
    materials = {
        name: material.model_copy(
            update={
                "youngs_modulus": material.youngs_modulus / factor,
                "youngs_modulus_range": None,
                "sustained_modulus": None
                if material.sustained_modulus is None
                else material.sustained_modulus / factor,
            }
        )
        for name, material in case.all_materials.items()
    }
    plain = case.load_cases[load_case].model_copy(update={"scatter": (1.0, 1.0)})
    load_cases = {**case.load_cases, load_case: plain}
    return case.model_copy(update={"materials": materials, "load_cases": load_cases})
