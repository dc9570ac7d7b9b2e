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
import math
from collections.abc import Callable, Collection, Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.source import COUPLES
from alula.fea.frame.deviation import Sharing
from alula.fea.frame.linear import FactorisedFrame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.geometry.linkage.linkage import Linkage

SOFT = 1e5
"""Flexibility of a hinge, over the greatest of the frame in hinges' angles."""
BORNE = 1e-3
"""Share of the largest moment of the tight frame above which hinges bear what nothing else can."""
MOST_STATES = 64
"""Sets of holes up to which all are tried; of more, those that a search finds to be the worst ones."""
_NOTHING = 1e-9
"""Moment that a unit angle of a hinge makes, over E I/h of the pin, below which it makes none but by rounding."""
_BENDING = {True: (1, 3), False: (2, 4)}
"""Natural rows of the bending of a pin at its root (True), and at its far end."""
Real = NDArray[np.float64]
Hinge = tuple[str, str]
"""Joint, and the one of its links in which the pin may tilt."""


def choices(linkage: Linkage, pins: Collection[str]) -> list[tuple[tuple[Hinge, ...], ...]]:
    """Return, link by link, the holes of which each of its pins may tilt in one.

    Parameters
    ----------
    linkage : Linkage
        With what joints state of their pins.
    pins : collection of str
        Joints between layers.

    Returns
    -------
    list of tuple of tuple of Hinge
        Of every link that has any: pin by pin its holes that are not tight, in its first link or its second. A pin that
        is tight in both has none, and is left out.
    """
    found = []
    for link in linkage.links:
        own = [name for name in pins if link in linkage.joints[name].links]
        holes = [tuple((name, x) for x in linkage.joints[name].links if x not in linkage.joints[name].tight_in)
                 for name in own]  # fmt: skip
        found.append(tuple(one for one in holes if one))
    return [one for one in found if one]


def hinges_tried(linkage: Linkage, pins: Collection[str]) -> tuple[frozenset[Hinge], ...]:
    """Return the sets of holes in which pins may tilt.

    For each link, its pins are tight in it or in their other link, in all combinations, while pins elsewhere are tight
    in both; and all together tilt in every hole that is not stated tight.

    Parameters
    ----------
    linkage, pins
        As of ``choices``.

    Returns
    -------
    tuple of frozenset of Hinge
    """
    every = choices(linkage, pins)
    found = [frozenset(one) for of_link in every for one in itertools.product(*of_link)]
    return tuple(dict.fromkeys([*found, *_all_open(every)]))


def _all_open(every: Sequence[tuple[tuple[Hinge, ...], ...]]) -> list[frozenset[Hinge]]:
    opened = frozenset(hole for of_link in every for holes in of_link for hole in holes)
    return [opened] if opened else []


def sharings(frame: LinkageFrame) -> tuple[Sharing, ...]:
    """Return the answers of a linkage in layers with pins that tilt in one of their holes.

    Parameters
    ----------
    frame : LinkageFrame
        With pins that are tight in both links.

    Returns
    -------
    tuple of Sharing
        One for each set of ``hinges_tried``; of more than ``MOST_STATES`` those that a search finds to be the worst.

    Raises
    ------
    CannotRunError
        Where forces do not balance.
    """
    linkage = frame.pose.linkage
    beams = {n: i for n, i in frame.pin_beams.items() if linkage.joints[n].pivots and n not in frame.bonded}
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

    def moments(loose: frozenset[Hinge]) -> tuple[NDArray[np.bool_], Real]:
        """Which rows of hinges are open, and the moments that they bear all the same."""
        chosen = np.repeat(np.array([hinge in loose for hinge in hinges]), 2)
        flexible = np.eye(chosen.sum()) - soft * by_angle[np.ix_(chosen, chosen)]
        return chosen, np.linalg.solve(flexible, tight[chosen])

    def couples(loose: frozenset[Hinge]) -> Real:
        """Moments at all hinges."""
        chosen, borne = moments(loose)
        return np.asarray(tight + by_angle[:, chosen] @ (soft * borne))

    on_tight_pins = frame.at_points(solved.solved().displacements)
    found = []
    for loose in _worst(linkage, hinges, couples):
        chosen, borne = moments(loose)
        answer = solved.solved(opened[:, chosen] @ (soft * borne))
        reactions = frame.reactions(answer.joint_wrenches, answer.residual)
        bears = np.abs(borne).max(initial=0.0) > BORNE * np.abs(tight).max()
        points = on_tight_pins if bears else frame.at_points(answer.displacements)
        found.append(Sharing(source=COUPLES[0], reactions=reactions, points=points, hinges=loose))
    return tuple(found)


def _worst(
    linkage: Linkage, hinges: Sequence[Hinge], couples: Callable[[frozenset[Hinge]], Real]
) -> tuple[frozenset[Hinge], ...]:
    """Return the sets of holes that count: all of ``hinges_tried``, or of too many those that a search finds.

    The search goes link by link. For each of the couples at the link's pins, upwards and downwards, it starts with all
    pins tilting in their first links and with all in their second, and moves pin after pin to its other hole while that
    makes the couple larger. What it ends with counts, and so does the state with all holes open.
    """
    pins = tuple(dict.fromkeys(name for name, _ in hinges))
    every = choices(linkage, pins)
    if sum(math.prod(map(len, of_link)) for of_link in every) < MOST_STATES:
        return hinges_tried(linkage, pins)
    found: dict[frozenset[Hinge], None] = {}
    known = cache(couples)
    for of_link in every:
        own = {name for holes in of_link for name, _ in holes}
        rows = [2 * i + side for i, (name, _) in enumerate(hinges) if name in own for side in (0, 1)]
        for row, sign, start in itertools.product(rows, (1.0, -1.0), (0, -1)):
            best = tuple(holes[start] for holes in of_link)
            improved = True
            while improved:
                improved = False
                for i, holes in enumerate(of_link):
                    for hole in holes:
                        other = (*best[:i], hole, *best[i + 1 :])
                        gain = sign * (known(frozenset(other))[row] - known(frozenset(best))[row])
                        if gain > _NOTHING * float(np.abs(known(frozenset(best))).max()):
                            best, improved = other, True
            found[frozenset(best)] = None
    return (*found, *(one for one in _all_open(every) if one not in found))
