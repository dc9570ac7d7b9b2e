"""The frame of one link by itself: its beams out of the frame of the linkage, held as its joints hold it."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.frame.build import build_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import Dof, FrameModel, Guide, Support
from alula.fea.vibration.link_holding import HeldPlace, LinkHolding
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case

Real = NDArray[np.float64]
ACROSS: frozenset[Dof] = frozenset({"rx", "ry"})
TURNS: frozenset[Dof] = frozenset({"rx", "ry", "rz"})


def link_frame(case: Case, link: str, pose: Pose, holding: LinkHolding) -> LinkageFrame:
    """Return the frame of a link in a pose.

    Parameters
    ----------
    case : Case
    link : str
        That moves and has a part.
    pose : Pose
        The linkage's pose.
    holding : LinkHolding
        How joints hold the link there.

    Returns
    -------
    LinkageFrame
        Of that link alone, in global axes; joints have their nodes on the link, and none elsewhere.
    """
    whole = build_frame(case, pose, (), held=None)
    elements, nodes = _own(whole, link)
    number = {node: i for i, node in enumerate(nodes)}
    pins = {
        name: tuple(
            number[node] if owner == link and node is not None else None
            for owner, node in zip(case.joints[name].links, ends, strict=True)
        )
        for name, ends in whole.pins.items()
    }
    turn = pose.placement.axes(link)
    supports: list[Support] = []
    guides: list[Guide] = []
    for place in holding.places:
        at = whole.points[link, place.point] if not place.joint else whole.pins[place.joint][0]
        assert at is not None
        for one in _held(number[at], place, turn):
            (supports if isinstance(one, Support) else guides).append(one)  # type: ignore[arg-type]
    model = whole.model
    return replace(
        whole,
        loads=(),
        held=None,
        model=FrameModel(
            nodes=model.nodes[nodes],
            elements=tuple(
                replace(
                    model.elements[i], nodes=(number[model.elements[i].nodes[0]], number[model.elements[i].nodes[1]])
                )
                for i in elements
            ),
            supports=tuple(supports),
            guides=tuple(guides),
            names=tuple(model.name(node) for node in nodes),
        ),
        points={key: number[node] for key, node in whole.points.items() if key[0] == link},
        pins={name: (ends[0], ends[1]) for name, ends in pins.items()},
        pin_ends={},
        pin_beams={},
        pin_eyes={},
        stations={link: tuple((x, number[node]) for x, node in whole.stations[link])},
        arms={number[node]: arm for node, arm in whole.arms.items() if node in number},
        beams={new: whole.beams[old] for new, old in enumerate(elements) if old in whole.beams},
        notes=(),
    )


def _own(frame: LinkageFrame, link: str) -> tuple[list[int], list[int]]:
    """Numbers of a link's elements, rigid ones between its points included, and of their nodes."""
    model, pins = frame.model, set(frame.pin_beams.values())
    nodes = {node for _, node in frame.stations[link]}
    elements: set[int] = set()
    while True:
        more = {
            i
            for i, element in enumerate(model.elements)
            if i not in elements and i not in pins and nodes & set(element.nodes)
        }
        if not more:
            return sorted(elements), sorted(nodes)
        elements |= more
        nodes |= {node for i in more for node in model.elements[i].nodes}


def _held(node: int, place: HeldPlace, turn: Real) -> Iterator[Support | Guide]:
    """What holds a node, in global axes: supports where they follow these, guides to the ground elsewhere."""
    moves, turns = place.moves @ turn.T, place.turns @ turn.T
    if len(moves) == 3:
        yield Support(node=node, dofs=frozenset({"ux", "uy", "uz"}))
    else:
        for normal in moves:
            yield Guide(carrier=None, pin=node, normal=normal)
    if len(turns) == 3:
        yield Support(node=node, dofs=TURNS)
    elif len(turns) == 2 and np.abs(turns[:, 2]).max() < 1e-9:
        yield Support(node=node, dofs=ACROSS)
    else:
        for about in turns:
            axis = np.linalg.svd(about[None])[2][1]
            yield Guide(carrier=None, pin=node, normal=np.cross(about, axis), axis=axis)
