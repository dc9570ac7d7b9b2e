"""How far pins that run in their holes let a point move, in the plane and across it.

A straight pin touches its hole at the two rims, where its axis may stand anywhere in a circle of half the play. Both
rims shifted alike are the play of the joint, shifted against each other they tilt the link, by up to c/t. By virtual
work a shift v of a rim moves a point by R · v along a unit force there, with the force R that this unit force makes at
the rim: so the point may move by

    Σ c/2 |R|

over all rims, to first order. It holds whatever loads act: in a redundant linkage the links give where the tilts do
not fit together, which the frame's own R has in it. With rigid links the free motion is the least of that sum over all
forces in equilibrium, and so no larger.

Where heads keep the places at both rims of a hole within ρ of each other, they may take any part f of its rims' forces,
and the hole lets the point move by the least of

    c/2 |R1 + f| + c/2 |R2 - f| + ρ |f| ,

of which f = 0, -R1 and R2 are tried: exact where both forces lie on one line, else a little more.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.reason import Reason, reason
from alula.fea.frame.linear import solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import NodeLoad
from alula.fea.pins.clearances import apart_at_rims, furthest, loose_holes
from alula.fea.pins.holes import known_hole, rims_of, shortest
from alula.geometry.linkage.play import Reach
from alula.loads.case.case import Case
from alula.loads.records.applied import shifted

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class RimReach(Reach):
    """Where a vector may end by the play at rims, of which each of some groups has its play in any one hole.

    Its ``axes`` (groups, holes, rims, 2) are those of every rim's ellipse, its ``joints`` those of each group.

    Attributes
    ----------
    apart : array (groups, holes)
        How far a pin's places at both rims of a hole may be apart, over c/2.
    """

    apart: Real

    def support(self, direction: NDArray[np.complex128]) -> Real:
        """Return how far the vector may go in directions.

        Parameters
        ----------
        direction : complex array (n,)
            Unit vectors.

        Returns
        -------
        array (n,)
        """
        along = (np.conj(direction)[:, None, None, None, None] * self.axes).real
        return np.asarray(furthest(along, self.apart).max(axis=-1).sum(axis=-1))


@dataclass(frozen=True, kw_only=True, eq=False)
class FreeMotion:
    """How far a point may move by the play of pins at the rims of their holes.

    Attributes
    ----------
    plane : RimReach
        In the plane [mm].
    across : float
        To either side of it [mm].
    """

    plane: RimReach
    across: float


def free_motion(case: Case, frame: LinkageFrame, link: str, point: str) -> FreeMotion:
    """Return how far a point of a linkage may move by the play of pins.

    Parameters
    ----------
    case : Case
        With play.
    frame : LinkageFrame
        Of the linkage, held by its drive.
    link, point : str
        Their names.

    Returns
    -------
    FreeMotion
    """
    node = frame.points[link, point]
    at_rims = rim_forces(case, frame, [NodeLoad(node=node, wrench=unit) for unit in np.eye(6)[:3]])
    groups = [(name, group) for name in case.joints for group in loose_holes(case, name)]
    shape = (len(groups), max((len(group) for _, group in groups), default=0), 2)
    axes, across = np.zeros((*shape, 2), dtype=complex), np.zeros((*shape, 2))
    apart = np.full(shape[:2], 2.0)
    for i, (name, group) in enumerate(groups):
        for k, (held, play) in enumerate(group):
            x, y, z = (play / 2.0 * found[name, held] for found in at_rims)
            axes[i, k] = x + 1j * y
            across[i, k] = z
            if len(group) == 1:  # of two that share a clearance, where either may have any part of it, only rims count
                apart[i, k] = apart_at_rims(case, name, held, play) / (play / 2.0)
    plane = RimReach(joints=tuple(name for name, _ in groups), axes=axes, apart=apart)
    return FreeMotion(plane=plane, across=float(furthest(across, apart).max(axis=-1, initial=0.0).sum()))


def unknown_lengths(case: Case) -> tuple[Reason, ...]:
    """Say how long holes with play are taken to be whose length no part and no thickness tells.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of Reason
        One, or none.
    """
    holes = {(joint, link) for joint in case.joints for group in loose_holes(case, joint) for link, _ in group}
    unknown = [link for link in case.links if any(on == link and not known_hole(case, j, on) for j, on in holes)]
    if not unknown:
        return ()
    return (reason("holes_as_long_as_shortest", links=unknown, length=shortest(case)),)


def rim_forces(case: Case, frame: LinkageFrame, loads: Sequence[NodeLoad]) -> list[dict[tuple[str, str], Real]]:
    """Return the forces on the rims of every hole with play, under each of some loads and nothing else.

    Parameters
    ----------
    case : Case
        With play.
    frame : LinkageFrame
        Of the linkage, held by its drive.
    loads : sequence of NodeLoad

    Returns
    -------
    list of dict of (str, str) to ndarray
        Of each load, (joint, link) -> (rims, 2) along x and y [N].
    """
    bare = tuple(replace(e, load_first=np.zeros(3), load_last=np.zeros(3)) for e in frame.model.elements)
    holes = [(name, link) for name in case.joints for group in loose_holes(case, name) for link, _ in group]
    rims = {hole: rims_of(case, *hole) for hole in holes}
    found = []
    for load in loads:
        solved = solve_frame(replace(frame.model, elements=bare, loads=(load,)))
        joints = frame.reactions(solved.joint_wrenches, solved.residual).joints
        found.append(dict[tuple[str, str], Real]())
        for (name, link), (low, high) in rims.items():
            wrench = joints[name].wrench
            if link == case.joints[name].links[0]:
                wrench = shifted(-wrench, np.array([0.0, 0.0, case.linkage.rise(name)]))
            force, turned = wrench[:2], np.array([wrench[4], -wrench[3]])  # the sum of z R over both rims
            found[-1][name, link] = np.array([high * force - turned, turned - low * force]) / (high - low)
    return found
