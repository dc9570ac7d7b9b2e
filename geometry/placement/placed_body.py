"""From a part that a case imports to the body of a link: placed by its bores, with sections between its pins."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.features import FlatFace, Pin, Ring
from alula.geometry.imported.facts import Bore, PartFacts
from alula.geometry.imported.read import part_facts
from alula.geometry.meshing.mesh import sections_and_rings
from alula.geometry.parts.mesh_part import MeshedPart
from alula.geometry.parts.step import FilePart, ImportedPart
from alula.geometry.placement.fit import Fit, Wanted
from alula.geometry.placement.load_faces import load_faces
from alula.geometry.placement.match import place, with_loaded_bores

EXACT = 1e-6
"""Share of its diameter by which the centre of a bore may lie off its point."""
STATIONS = 16
"""Sections between the outermost pins, for hand calculation and frames."""
_bodies: dict[tuple[object, ...], Body] = {}


def bores_of(part: FilePart) -> tuple[Bore, ...]:
    """Return the bores of a part's file.

    Parameters
    ----------
    part : FilePart
        The part, as the case states it.

    Returns
    -------
    tuple of Bore
        In the file's frame.

    Raises
    ------
    CaseError
        Where the file is no single solid.
    CannotRunError
        Where the kernel fails.
    """
    return part_facts(Path(part.file), part.mesh_unit).bores


def faces_of(part: FilePart, body: Body) -> dict[str, FlatFace]:
    """Return the faces that a part names for load points, where it was placed.

    Parameters
    ----------
    part : FilePart
        The part, as the case states it.
    body : Body
        What ``placed_body`` gave of it.

    Returns
    -------
    dict of str to FlatFace
        By point, in the link's frame.
    """
    placed = body.part
    assert isinstance(placed, ImportedPart)
    return load_faces(part, np.array(placed.turn), np.array(placed.shift))


def placed_body(
    part: FilePart, wanted: tuple[Wanted, ...], others: tuple[tuple[str, tuple[float, float]], ...] = ()
) -> Body:
    """Place an imported part in its link.

    Parameters
    ----------
    part : FilePart
        The part, as the case states it.
    wanted : tuple of Wanted
        The pinned points of the link.
    others : tuple of (str, (float, float))
        Name and (x, y) of its points without a joint [mm].

    Returns
    -------
    Body
        The link's body, its part an ``ImportedPart``, with a pin for each point that stands in a bore, joints first and
        last. Equal requests are answered once.

    Raises
    ------
    CaseError
        Where the file is no single solid, or its bores do not fit the points.
    CannotRunError
        Where the kernel fails.
    """
    facts = part_facts(Path(part.file), part.mesh_unit)
    key = facts.digest, part.model_dump_json(), wanted, others
    if key not in _bodies:
        try:
            _bodies[key] = _placed(part, facts, wanted, dict(others))
        except AlulaError as error:
            raise type(error)(f"{Path(part.file).name}: {error}") from None
    return _bodies[key]


def _placed(
    part: FilePart, facts: PartFacts, wanted: tuple[Wanted, ...], others: Mapping[str, tuple[float, float]]
) -> Body:
    bored = {name: at for name, at in others.items() if name not in part.faces}
    placement = with_loaded_bores(part, place(part, facts.bores, wanted, bored), facts.bores, bored)
    loaded = [
        Wanted(name=name, place=bored[name], diameter=bore.diameter)
        for name, bore in placement.bores.items()
        if name in bored
    ]
    corners = np.array(np.meshgrid(*zip(facts.low, facts.high, strict=True))).reshape(3, -1).T
    bounds = corners @ placement.turn.T + placement.shift
    kind = ImportedPart if part.mesh_unit is None else partial(MeshedPart, file_unit=part.mesh_unit)
    solid = kind(
        material=part.material,
        build_direction=part.build_direction,
        file=part.file,
        digest=facts.digest,
        turn=tuple(map(tuple, placement.turn.tolist())),
        shift=tuple(placement.shift.tolist()),
        thickness=min(3.0 * facts.volume / facts.surface, *(facts.high[i] - facts.low[i] for i in range(3))),
        low=tuple(bounds.min(axis=0).tolist()),
        high=tuple(bounds.max(axis=0).tolist()),
    )
    body = Body(
        part=solid, pins=tuple(_pin(placement, one) for one in (*wanted[:1], *loaded, *wanted[1:])), ends=(), holes=()
    )
    reach = [x for pin in body.pins for x in pin.span]
    if max(reach) == min(reach):  # a single pin: as far as loads reach
        reach += [x for x, _ in others.values()]
    first, last = min(reach), max(reach)
    stations = tuple(first + (last - first) * (i + 0.5) / STATIONS for i in range(STATIONS if last > first else 0))
    sections, rings = sections_and_rings(body, stations)
    return Body(
        part=solid.model_copy(update={"stations": tuple(sections)}),
        pins=tuple(_with_ring(pin, ring) for pin, ring in zip(body.pins, rings, strict=True)),
        ends=(),
        holes=(),
    )


def _with_ring(pin: Pin, diameter: float) -> Pin:
    assert pin.ring is not None
    return replace(pin, ring=replace(pin.ring, diameter=diameter))


def _pin(placement: Fit, one: Wanted) -> Pin:
    """Return the pin hole or slot of a point, which stands at its bore."""
    bore, (x, y, middle) = placement.bores[one.name], placement.middle(one.name).tolist()
    if math.hypot(x - one.place[0], y - one.place[1]) > EXACT * bore.diameter:
        raise CaseError(
            f"the point {one.name} does not stand at {bore.name}; read the case by read_case, which moves it there"
        )
    if bore.slot and math.dist(placement.turn[1:] @ bore.slot_axis, (0.0, 0.0)) * bore.slot > EXACT * bore.diameter:
        raise CaseError(f"the slot at {one.name} does not run along x of the link as another of its slots does")
    along = 1.0 if np.dot(placement.turn[2], bore.axis) > 0.0 else -1.0
    walls = sorted(tuple(sorted(middle + along * end for end in span)) for span in bore.spans)
    return Pin(
        name=one.name,
        x=one.place[0],
        y=one.place[1],
        diameter=bore.diameter,
        slot=bore.slot,
        clearance=bore.diameter - one.diameter,
        ring=Ring(
            diameter=0.0,
            low=walls[0][0],
            high=walls[-1][1],
            share=bore.share,
            gaps=tuple((below[1], above[0]) for below, above in itertools.pairwise(walls)),
        ),
    )
