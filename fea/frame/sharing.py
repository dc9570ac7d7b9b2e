"""How the couples between layers are shared: equilibria with pins that are tight in the one link and tilt in the other.

A joint force F goes from one mid-plane to the other, a height h apart, and with it goes a couple F h, which the two
links share. A pin that fits tightly in both carries a moment into either, by the stiffness of links and pins: the
frame's own answer. A pin with play in one of its two holes tilts there, and the other link bears the whole couple.
Which it is, nobody states; the truth lies between these equilibria.

A hole in which a pin may tilt is a hinge at that end of the pin's beam. Its angle θ is a further deformation of the
beam, of which the frame's answer follows from one factorisation; with a hinge of flexibility f, θ = f q, so that

    (1 - f Q) q = q0,

where q0 are the moments at the hinges in the tight frame, and Q those that unit angles of the hinges make in it
(Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapter 8: structural modification by the force method). A
finite f, far softer than all links, keeps a link from spinning freely that has hinges all about: it shares what must be
borne evenly. Then the pins lie against their holes, tilted by no more than their play, so that such an answer tells
forces and no displacements: the tight frame's stand for them.
"""

import itertools
from collections.abc import Iterator

import numpy as np

from fea.common.source import COUPLES
from fea.frame.deviation import Sharing
from fea.frame.linear import FactorisedFrame
from fea.frame.linkage_frame import LinkageFrame
from geometry.linkage.linkage import Linkage

SOFT = 1e5
"""Flexibility of a hinge, over the greatest of the frame in hinges' angles."""
BORNE = 1e-3
"""Share of the largest moment of the tight frame above which hinges bear what nothing else can."""
MOST_PINS = 4
"""Pins of a link of which all combinations are tried; of more, all together and each alone."""
_NOTHING = 1e-9
"""Moment that a unit angle of a hinge makes, over E I/h of the pin, below which it makes none but by rounding."""
_BENDING = {True: (1, 3), False: (2, 4)}
"""Natural rows of the bending of a pin at its root (True), and at its far end."""
Hinge = tuple[str, str]
"""Joint, and the one of its links in which the pin may tilt."""


def hinges_tried(linkage: Linkage, pins: tuple[str, ...]) -> Iterator[frozenset[Hinge]]:
    """Yield the sets of holes in which pins may tilt.

    For each link, its pins are tight in it or in their other link, in all combinations; pins elsewhere are tight in
    both.

    Parameters
    ----------
    linkage : Linkage
        With what joints state of their pins.
    pins : tuple of str
        Joints between layers.

    Yields
    ------
    frozenset of Hinge
    """
    seen: set[frozenset[Hinge]] = set()
    for link in linkage.links:
        own = [name for name in pins if link in linkage.joints[name].links]
        choices = []
        for name in own:
            joint = linkage.joints[name]
            choices.append([(name, other) for other in joint.links if other != joint.tight_in])
        if len(own) <= MOST_PINS:
            tried = [frozenset(found) for found in itertools.product(*choices)]
        else:
            tried = [frozenset(one for choice in choices for one in choice[side : side + 1]) for side in (0, -1)]
            tried += [frozenset([one]) for choice in choices for one in choice]
        for found in tried:
            if found and found not in seen:
                seen.add(found)
                yield found


def sharings(frame: LinkageFrame) -> tuple[Sharing, ...]:
    """Return the answers of a linkage in layers with pins that tilt in one of their holes.

    Parameters
    ----------
    frame : LinkageFrame
        With pins that are tight in both links.

    Returns
    -------
    tuple of Sharing
        One for each set of ``hinges_tried``.

    Raises
    ------
    CannotRunError
        Where forces do not balance.
    """
    linkage = frame.pose.linkage
    revolute = {name for name, joint in linkage.joints.items() if joint.type == "revolute"}
    beams = {name: i for name, i in frame.pin_beams.items() if name in revolute - frame.bonded}
    if not beams:
        return ()
    hinges = [(name, link) for name in beams for link in linkage.joints[name].links]
    rows = np.array(
        [6 * beams[name] + row for name, link in hinges for row in _BENDING[link == linkage.joints[name].links[0]]]
    )
    solved = FactorisedFrame(frame.model)
    opened = solved.opened(rows)
    tight, by_angle = solved.natural_forces(rows, solved.own), solved.natural_forces(rows, opened)
    largest, pins = float(np.abs(by_angle).max()), [frame.model.elements[i] for i in beams.values()]
    alone = max(pin.young * pin.section.i_y / abs(linkage.rise(name)) for name, pin in zip(beams, pins, strict=True))
    if largest <= _NOTHING * alone:
        return ()  # as of an open chain, whose pins bear what equilibrium says
    soft = SOFT / largest
    on_tight_pins = frame.at_points(solved.solved().displacements)
    found = []
    for loose in hinges_tried(linkage, tuple(beams)):
        chosen = np.repeat(np.array([hinge in loose for hinge in hinges]), 2)
        moments = np.linalg.solve(np.eye(chosen.sum()) - soft * by_angle[np.ix_(chosen, chosen)], tight[chosen])
        answer = solved.solved(opened[:, chosen] @ (soft * moments))
        reactions = frame.reactions(answer.joint_wrenches, answer.residual)
        bears = np.abs(moments).max(initial=0.0) > BORNE * np.abs(tight).max()
        points = on_tight_pins if bears else frame.at_points(answer.displacements)
        names = frozenset(name for name, _ in loose)
        found.append(Sharing(source=COUPLES[0], reactions=reactions, points=points, joints=names))
    return tuple(found)
