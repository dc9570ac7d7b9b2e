"""A case's linkage as the mechanism of a source: which of its joints the closed forms speak of."""

import math

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.mechanisms.flapping import FlappingWing

SYMMETRY = 1e-6
"""Share of the longest link by which a crank's pivot may miss the origin."""


class FlappingWingSpec(CaseModel):
    """The right side's four joints; the left side is its mirror."""

    crank_pivot: Name
    """Joint of crank and ground, at the origin."""
    crank_pin: Name
    """Joint of crank and coupler."""
    rocker_pin: Name
    """Joint of coupler and rocker."""
    rocker_pivot: Name
    """Joint of rocker and ground."""

    def wing(self, linkage: Linkage) -> FlappingWing:
        """Return the flapping wing whose lengths are the distances between these joints on their links.

        Parameters
        ----------
        linkage : Linkage
            The linkage of the case.

        Returns
        -------
        FlappingWing
            Its lengths [mm].

        Raises
        ------
        CaseError
            For a joint that is unknown, for joints that share no link, and for a crank pivot off the origin.
        """
        crank, coupler, rocker = (
            _distance(linkage, *pair)
            for pair in (
                (self.crank_pivot, self.crank_pin),
                (self.crank_pin, self.rocker_pin),
                (self.rocker_pin, self.rocker_pivot),
            )
        )
        foot, pivot = (_on_ground(linkage, name) for name in (self.crank_pivot, self.rocker_pivot))
        if math.hypot(*foot) > SYMMETRY * linkage.longest:
            raise CaseError(
                f"flapping_wing.crank_pivot: '{self.crank_pivot}' lies at ({foot[0]:g}, {foot[1]:g}) mm, but the two "
                "sides are mirrored about the origin's y axis; put the crank's pivot at the origin"
            )
        return FlappingWing(crank=crank, coupler=coupler, rocker=rocker, width=pivot[0], height=pivot[1])


def _known(linkage: Linkage, name: str) -> None:
    if name not in linkage.joints:
        raise CaseError(f"flapping_wing: there is no joint '{name}'; the joints are {', '.join(linkage.joints)}")


def _distance(linkage: Linkage, first: str, second: str) -> float:
    """Return the distance of two joints on the moving link that has both [mm]."""
    for name in (first, second):
        _known(linkage, name)
    shared = [link for link in linkage.joints[first].links if link in linkage.joints[second].links]
    shared = [link for link in shared if link != linkage.ground]
    if not shared:
        raise CaseError(f"flapping_wing: joints '{first}' and '{second}' share no moving link; name neighbours")
    points = linkage.links[shared[0]].points
    return math.dist(*(points[linkage.point_of(joint, shared[0])] for joint in (first, second)))


def _on_ground(linkage: Linkage, joint: str) -> tuple[float, float]:
    _known(linkage, joint)
    if linkage.ground not in linkage.joints[joint].links:
        raise CaseError(f"flapping_wing: joint '{joint}' is no joint of the ground link; name one that is")
    return linkage.links[linkage.ground].points[linkage.point_of(joint, linkage.ground)]
