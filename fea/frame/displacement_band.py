"""How far a point of the linkage may move beside the frame's answer: the bounds of what eyes, bores and holes do.

The displacement of a point is a sum over beams of internal forces times those of a unit load there times flexibility
(virtual work), and over bores of pin force times that of the unit load times how the bore gives. The frame of centre
lines takes every beam as plain from pin to pin. Each term stands between two ends:

low   eyes are rigid out to ``RIGID`` of their radius from the pin
high  beams are as soft in their eyes as elsewhere, and softer where a bore or a cross hole leaves less than the plain
      section; pins sink into their bores, turn and tilt in them (``bore_gives``); a slot's flanks are softer by
      ``FLANKS``, a disc is as wide as its narrowest chord

Terms of opposite sign are each taken at their worst. The constants hold the solids of 48 tubes and bars, clamped at one
bore and pulled or bent at another, with some margin; ``benchmarks/displacement_band.py`` tries them on others. Discs,
arms and slots were not among these. Lengths in mm, forces in N, moments in N·mm, moduli in MPa.
"""

import itertools
import math
from collections.abc import Collection, Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.deflection import flexibility
from alula.fea.beam.piecewise import values
from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.frame.model import FrameModel, NodeLoad
from alula.fea.frame.system import to_ends
from alula.geometry.bodies.body import Body, hand_section
from alula.geometry.bodies.features import Pin
from alula.geometry.bodies.section import Section
from alula.loads.case.case import Case

Real = NDArray[np.float64]
Stretch = tuple[float, float, Real]
"""Its ends [mm], and the factors on the flexibility between them."""

RIGID = 1.0
"""Share of an eye's radius from its pin within which the stiffest link does not give."""
SINK = (1.3, 1.55)
"""How far a pin sinks into its bore at the most, over F/(E t): a + b (R/h)³, as the ring about the bore bends.

R is the mean radius of the ring from bore to rim and h its height."""
TILT = 0.5
"""The same along the pin, and where it tilts with 12/t² about the bore's middle, over that of a push across.

Where the pin bears on several walls, t/I with the second moment I of their length takes the place of 12/t²."""
TURN = (1.6, 0.25)
"""How far a pin turns in its bore at the most: a times the shear of a free ring, b (R/h)³ M/(E t R²) as it bends."""
HOLE = 2.0
"""Length of the net section that stands for a cross hole, over its diameter."""
FLANKS = 0.15
"""Share by which the flanks of a slot may be softer, or stiffer, than beams."""
STIFFEST = 0.01
"""Least flexibility of a link over its beam's: eyes may leave nothing of it."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True, kw_only=True, eq=False)
class Zone:
    """A stretch of a beam, and the least and largest factor on its flexibility.

    Attributes
    ----------
    start : float
        Place along the beam [mm].
    end : float
        Place beyond ``start`` [mm].
    least : ndarray, shape (6,)
        Least factor, for N, V_y, V_z, T, M_y, M_z.
    most : ndarray, shape (6,)
        Largest factor.
    """

    start: float
    end: float
    least: Real
    most: Real


def zones(body: Body, start: float, end: float, *, arm: Pin | None = None, flank: bool = False) -> tuple[Zone, ...]:
    """Return the zones of a link's beam between two places.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    start : float
        Place: x along the link's axis, or along an arm from its foot on [mm].
    end : float
        Place beyond ``start`` [mm].
    arm : Pin or None, optional
        Pin at the end of the arm; None for the link's axis.
    flank : bool, optional
        True for a flank of a slot.

    Returns
    -------
    tuple of Zone
        From start to end.
    """
    rigid: list[tuple[float, float]] = []
    soft: list[Stretch] = []
    if arm is not None:
        assert arm.foot is not None
        reach = math.hypot(arm.x - arm.foot[0], arm.y - arm.foot[1])
        foot = body.foot(arm)
        holes = ([] if foot is None else [(0.0, foot)]) + [(reach, arm)]
    else:
        holes = [(pin.x, pin) for pin in body.pins if pin.foot is None and pin.slot == 0.0]
        soft += [_at_hole(body.section_at(x), row.diameter, row.along, x) for row in body.holes for x in row.positions]
    for x, pin in holes:
        reach = RIGID * body.ring(pin).diameter / 2.0
        rigid.append((x - reach, x + reach))  # nothing where the hole has no eye
        soft.append(_at_bore(body, pin, x))
    edges = [x for low, high in (*rigid, *(stretch[:2] for stretch in soft)) for x in (low, high)]
    marks = sorted({start, end, *(x for x in edges if start < x < end)})
    everywhere = _narrowest(body)
    found = []
    for a, b in itertools.pairwise(marks):
        middle, least, most = (a + b) / 2.0, np.ones(6), everywhere
        if flank:
            least, most = least * (1.0 - FLANKS), most * (1.0 + FLANKS)
        if any(low < middle < high for low, high in rigid):
            least = np.zeros(6)
        for low, high, factor in soft:
            if low < middle < high:
                most = np.maximum(most, factor)
        found.append(Zone(start=a - start, end=b - start, least=least, most=most))
    return tuple(found)


def bore_gives(body: Body, young: float, poisson: float) -> dict[str, Real]:
    """Return how far every pin moves at the most in its bore or slot per unit of what it bears.

    It sinks by ``SINK`` F/(E t), tilts as that along its length lets it, and turns about itself as the ring bends and,
    held at its rim, shears: M/(4πG t) (1/r² - 1/R²), from τ = M/(2π r² t). The ring is that of the hole, the widest
    that the case allows, and r the pin's, as in the narrowest.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    young : float
        Young's modulus [MPa].
    poisson : float
        Poisson's ratio.

    Returns
    -------
    dict of str to ndarray
        Pin and its give (6,) [mm/N, 1/(N·mm)].
    """
    shear = young / (2.0 + 2.0 * poisson)
    found = {}
    for pin in body.pins:
        ring, inner = body.ring(pin), pin.diameter / 2.0
        thick, outer = ring.thickness, body.part.wall(body, pin)
        mean = (outer + inner) / 2.0
        slender = (mean / (outer - inner)) ** 3
        sink = (SINK[0] + SINK[1] * slender) / (young * thick)
        tilt = TILT * sink * thick / ring.second
        turn = TURN[0] * (4.0 / pin.pin_diameter**2 - 1.0 / outer**2) / (4.0 * math.pi * shear * thick)
        turn += TURN[1] * slender / (young * thick * mean**2)
        found[pin.name] = np.array([sink, sink, TILT * sink, tilt, tilt, turn])
    return found


def bounds(
    loaded: FrameSolution,
    unit: FrameSolution,
    beams: Mapping[int, Sequence[Zone]],
    bores: Sequence[tuple[int, Real]],
    *,
    without: Container[int] = (),
    pins: Container[int] = (),
) -> Band:
    """Return the displacement along a unit load between its bounds.

    Parameters
    ----------
    loaded : FrameSolution
        The frame under the loads.
    unit : FrameSolution
        The frame under the unit load.
    beams : dict of int to sequence of Zone
        Element and its zones; those that are left out are as the frame has them.
    bores : sequence of tuple of int and ndarray
        Node and give (6,) of every pin in a bore, for what acts on the node's link there.
    without : container of int, optional
        Elements that are left out of the sum.
    pins : container of int, optional
        Elements that are pins between layers, built into the link at their first node.

    Returns
    -------
    Band
        The frame's displacement, the least and the largest [mm].
    """
    found = works(loaded, unit, beams, bores, pins=pins)
    return found.band([i for i in range(len(loaded.model.elements)) if i not in without], range(len(bores)))


@dataclass(frozen=True, kw_only=True, eq=False)
class Works:
    """Work of a frame's internal forces under a unit load on its strains under loads, term by term.

    Attributes
    ----------
    beams : ndarray, shape (m, 3, 6)
        Of every element and internal force: of the frame, with the least flexibility, with the largest.
    bores : ndarray, shape (b, 6)
        Of every pin in its bore, at most.
    """

    beams: Real
    bores: Real

    def band(self, elements: Sequence[int], bores: Sequence[int]) -> Band:
        """Return the work of some elements and bores between its bounds, each term at its worst.

        Parameters
        ----------
        elements, bores : sequence of int
            Their numbers.

        Returns
        -------
        Band
        """
        terms, sunk = self.beams[list(elements)], self.bores[list(bores)]
        low = terms.min(axis=1).sum() + np.minimum(sunk, 0.0).sum()
        high = terms.max(axis=1).sum() + np.maximum(sunk, 0.0).sum()
        return Band(value=float(terms[:, 0].sum()), low=float(low), high=float(high))


def works(
    loaded: FrameSolution,
    unit: FrameSolution,
    beams: Mapping[int, Sequence[Zone]],
    bores: Sequence[tuple[int, Real]],
    *,
    pins: Container[int] = (),
) -> Works:
    """Return the work of internal forces, term by term.

    Parameters
    ----------
    loaded, unit, beams, bores, pins
        As of ``bounds``.

    Returns
    -------
    Works
    """
    model, terms = loaded.model, np.zeros((len(loaded.model.elements), 3, 6))
    lengths = [model.length(i) for i in range(len(model.elements))]
    plain = Zone(start=0.0, end=np.inf, least=np.ones(6), most=np.ones(6))
    every = [(i, zone) for i in range(len(lengths)) for zone in beams.get(i) or (plain,)]
    numbers = np.array([i for i, _ in every], dtype=np.int64)
    ends = np.minimum([(zone.start, zone.end) for _, zone in every], np.take(lengths, numbers)[:, None])
    start, end = ends.reshape(-1, 2).T
    half = (end - start)[:, None] / 2.0
    xs, dx = (start + end)[:, None] / 2.0 + half * _NODES, half * _WEIGHTS
    each = [flexibility(one.section, one.young, one.poisson) for one in model.elements]
    factors = [(each[i], zone.least, zone.most) for i, zone in every]
    flexible, least, most = np.array(factors).reshape(-1, 3, 6).swapaxes(0, 1)
    real, virtual = (values(one.forces_along[numbers, None], xs[..., None]) for one in (loaded, unit))
    work = flexible * np.einsum("zq,zqi->zi", dx, real * virtual)
    np.add.at(terms, numbers, np.stack([work, least * work, most * work], axis=1))
    acting = [_on_links(solution, pins) for solution in (loaded, unit)]
    sunk = [give * acting[0][node] * acting[1][node] for node, give in bores]
    return Works(beams=terms, bores=np.array(sunk).reshape(-1, 6))


@dataclass(frozen=True, kw_only=True)
class OneModulus:
    """Links of one material, whose modulus may be off.

    Attributes
    ----------
    links : collection of str
    low, high : float
        Least and largest factor on their flexibility.
    """

    links: Collection[str]
    low: float
    high: float


def point_bounds(
    case: Case,
    frame: LinkageFrame,
    solution: FrameSolution,
    link: str,
    point: str,
    solids: Mapping[str, Sequence[Band]] | None = None,
    carried: Mapping[str, Sequence[float]] | None = None,
    *,
    moduli: Sequence[OneModulus] = (),
    others: Sequence[tuple[LinkageFrame, FrameSolution]] = (),
) -> Band:
    """Return the least and largest distance by which a point of a linkage moves in its linear frame.

    Where the frame is redundant, forces are those of the plain beams: exact to first order in what eyes and bores do.

    Parameters
    ----------
    case : Case
        The case.
    frame : LinkageFrame
        Of the linkage.
    solution : FrameSolution
        In small displacements.
    link : str
        On which the point lies.
    point : str
        Its name.
    solids : dict of str to sequence of Band, optional
        Link whose solid tells what it adds, and its share of the displacement along x, y and, where anything moves out
        of the plane, z [mm], which takes the place of its beams and bores.
    carried : dict of str to sequence of float, optional
        Of links whose solids bear other loads than the frame has: what plain beams would add under these [mm]. Of such
        a solid what it adds beyond its beam counts, beside the frame's plain beam.
    moduli : sequence of OneModulus, optional
        Links whose modulus is in doubt. What the materials add may cancel, so that each counts by itself.
    others : sequence of tuple of (LinkageFrame, FrameSolution), optional
        The frame under other loads that may be, which the ends hold as well.

    Returns
    -------
    Band
        How far the point moves, by the beams and these solids [mm].
    """
    solids, carried = solids or {}, carried or {}
    every = [_along_axes(case, *one, (link, point), solids, carried, moduli) for one in ((frame, solution), *others)]
    count = max(map(len, every))
    found = np.array([np.pad(one, ((0, count - len(one)), (0, 0))) for one in every])
    low, high = found[..., 1].min(axis=0), found[..., 2].max(axis=0)
    ends = found[0, :, 0], np.maximum(np.maximum(low, -high), 0.0), np.maximum(abs(low), abs(high))
    value, least, largest = (float(np.linalg.norm(end)) for end in ends)
    return Band(value=value, low=least, high=largest)


def _along_axes(
    case: Case,
    frame: LinkageFrame,
    solution: FrameSolution,
    at: tuple[str, str],
    solids: Mapping[str, Sequence[Band]],
    carried: Mapping[str, Sequence[float]],
    moduli: Sequence[OneModulus],
) -> Real:
    """Return how far a point moves along x, y and, where anything moves out of the plane, z: value, least, largest."""
    node = frame.points[at]
    beams, bores = give_of_links(case, frame, solids)
    left_out = {i for i, beam in frame.beams.items() if beam.link in solids and beam.link not in carried}
    of_link = {i: beam.link for i, beam in frame.beams.items()}
    others = {"", *of_link.values(), *solids, *(link for link, _, _ in bores)}
    others -= {link for one in moduli for link in one.links}
    own_of = [of_link.get(i, "") for i in range(len(frame.model.elements))]
    sinking = [(node, give) for _, node, give in bores]
    planar = not np.any(solution.displacements[:, 2:5])
    found = []
    for axis in range(2 if planar else 3):
        unit = _under_unit_force(frame.model, node, axis)

        found_works = works(solution, unit, beams, sinking, pins=frame.pin_beams.values())

        def share(own: Collection[str], low: float, high: float, terms: Works = found_works, axis: int = axis) -> Real:
            plain = terms.band(
                [i for i, link in enumerate(own_of) if link in own and i not in left_out],
                [i for i, (link, _, _) in enumerate(bores) if link in own],
            )
            every = [plain, *(bands[axis] for link, bands in solids.items() if link in own)]
            taken = sum(works[axis] for link, works in carried.items() if link in own)
            value, least, most = (sum(getattr(one, end) for one in every) - taken for end in ("value", "low", "high"))
            return np.array([value, min(low * least, high * least), max(low * most, high * most)])

        parts = [share(others, 1.0, 1.0), *(share(one.links, one.low, one.high) for one in moduli)]
        found.append(np.sum(parts, axis=0))
    return np.array(found)


@lru_cache(maxsize=64)
def _under_unit_force(model: FrameModel, node: int, axis: int) -> FrameSolution:
    """Return a frame's answer to a unit force alone; bands of a point ask for it again."""
    bare = tuple(replace(e, load_first=np.zeros(3), load_last=np.zeros(3)) for e in model.elements)
    return solve_frame(replace(model, elements=bare, loads=(NodeLoad(node=node, wrench=np.eye(6)[axis]),)))


def compliance_range(case: Case, frame: LinkageFrame, solution: FrameSolution) -> Scatter:
    """Return how soft a linkage may be under its loads, over its frame of plain beams.

    Parameters
    ----------
    case, frame, solution
        As of ``flexibility_ranges``.

    Returns
    -------
    Scatter
        Least and largest ratio of the work of all loads; 1 where they do none.
    """
    found = softness(case, frame, solution, {})
    return Scatter(low=found.low, high=found.high, sources=found.sources)


def softness(case: Case, frame: LinkageFrame, solution: FrameSolution, known: Mapping[str, Band]) -> Band:
    """Return how soft a linkage is under its loads over its frame of plain beams, where that of some links is known.

    Parameters
    ----------
    case, frame, solution
        As of ``flexibility_ranges``.
    known : mapping of str to Band
        Link, and how soft it is over its plain beam.

    Returns
    -------
    Band
        Ratio of the work of all loads; 1 where they do none.
    """
    without = {i for i, beam in frame.beams.items() if beam.link in known}
    band = bounds(solution, solution, *_links(case, frame, known), without=without, pins=frame.pin_beams.values())
    plain = {link: work.value for link, work in works_of_links(case, frame, solution) if link in known}
    whole = band.value + sum(plain.values())
    if whole <= 0.0:
        return Band.exact(1.0)
    value, low, high = (
        (end + sum(work * getattr(known[link], name) for link, work in plain.items())) / whole
        for name, end in (("value", band.value), ("low", band.low), ("high", band.high))
    )
    others = any(beam.link not in known for beam in frame.beams.values())
    sources = (Source(kind=SourceKind.EYES),) if others else ()
    return Band(value=value, low=max(low, STIFFEST), high=high, sources=sources)


def flexibility_ranges(case: Case, frame: LinkageFrame, solution: FrameSolution) -> dict[str, tuple[float, float]]:
    """Return how flexible each link may be under what acts on it, over its beam.

    Parameters
    ----------
    case : Case
        The case.
    frame : LinkageFrame
        Of the linkage.
    solution : FrameSolution
        In small displacements.

    Returns
    -------
    dict of str to tuple of 2 float
        Link that is a beam in the frame, and the least and largest ratio of its strain energy; those that bear nothing
        are left out.
    """
    return {
        link: (max(band.low / band.value, STIFFEST), band.high / band.value)
        for link, band in works_of_links(case, frame, solution)
    }


def shares_of_work(case: Case, frame: LinkageFrame, solution: FrameSolution) -> dict[str, float]:
    """Return which share of the work of all loads each link takes up, as strain energy of its beams.

    Parameters
    ----------
    case, frame, solution
        As of ``flexibility_ranges``.

    Returns
    -------
    dict of str to float
        Of the links that bear something; they sum to 1.
    """
    works = {link: band.value for link, band in works_of_links(case, frame, solution)}
    return {link: work / sum(works.values()) for link, work in works.items()}


def works_of_links(case: Case, frame: LinkageFrame, solution: FrameSolution) -> Iterator[tuple[str, Band]]:
    """Yield each link that bears something, and twice the strain energy of its beams between its bounds.

    Parameters
    ----------
    case, frame, solution
        As of ``flexibility_ranges``.

    Yields
    ------
    tuple of str and Band
        Work of what acts on the link, on its deformation [N mm].
    """
    beams, bores = _links(case, frame, ())
    found = works(solution, solution, beams, bores, pins=frame.pin_beams.values())
    for link in dict.fromkeys(beam.link for beam in frame.beams.values()):
        nodes = {node for (name, _), node in frame.points.items() if name == link}
        band = found.band(
            [i for i, beam in frame.beams.items() if beam.link == link],
            [i for i, (node, _) in enumerate(bores) if node in nodes],
        )
        if band.value > 0.0:
            yield link, band


def give_of_links(
    case: Case, frame: LinkageFrame, solids: Container[str] = ()
) -> tuple[dict[int, tuple[Zone, ...]], list[tuple[str, int, Real]]]:
    """Return how far the links of a frame may give beside plain beams.

    Parameters
    ----------
    case : Case
        The case.
    frame : LinkageFrame
        Of the linkage.
    solids : container of str, optional
        Links that are left out.

    Returns
    -------
    tuple of dict of int to tuple of Zone, and list of tuple of str, int and ndarray
        Zones of every element that is part of a link; link, node and give (6,) of every pin in a bore.
    """
    bodies = {link: case.body(link) for link in case.bending_links if link not in solids}
    beams = {}
    for i, beam in frame.beams.items():
        if beam.link not in bodies:
            continue
        body = bodies[beam.link]
        arm = next((pin for pin in body.pins if beam.arm and pin.name == beam.arm), None)
        beams[i] = zones(body, beam.start, beam.end, arm=arm, flank=beam.flank)
    gives = {}
    for link, body in bodies.items():
        material = case.material_of(link)
        gives[link] = bore_gives(body, case.links[link].count * material.youngs_modulus, material.poissons_ratio)
    bores: dict[int, tuple[str, int, Real]] = {}
    for name, nodes in frame.pins.items():
        for link, point, node in zip(case.joints[name].links, case.linkage.joint_points(name), nodes, strict=True):
            if node is not None and point in gives.get(link, {}):
                bores[node] = link, node, gives[link][point]
    return beams, list(bores.values())


def _links(
    case: Case, frame: LinkageFrame, solids: Container[str]
) -> tuple[dict[int, tuple[Zone, ...]], list[tuple[int, Real]]]:
    """Zones of every element that is part of a link without solid, and these links' bores with the nodes in them."""
    beams, bores = give_of_links(case, frame, solids)
    return beams, [(node, give) for _, node, give in bores]


def _on_links(solution: FrameSolution, pins: Container[int]) -> Real:
    """What acts on the link at each node (n, 6), global axes: joints, loads and the pins that are built into it."""
    model, found = solution.model, np.zeros((len(solution.model.nodes), 6))
    for i, element in enumerate(model.elements):
        if i not in pins:
            wrenches = (to_ends(model, i).T @ solution.end_forces[i].ravel()).reshape(2, 6)
            for node, wrench in zip(element.nodes, wrenches, strict=True):
                found[node] += wrench
    return found


def _factors(area: float, i_y: float, i_z: float) -> Real:
    """Flexibility (6,) over the plain section's, from what is left of its A, I_y, I_z as shares."""
    worst = max(1.0 / area, 1.0 / i_y, 1.0 / i_z)
    return np.array([1.0 / area, 1.0 / area, 1.0 / area, worst, 1.0 / i_y, 1.0 / i_z])


def _at_hole(section: Section, d: float, to: Literal["y", "z"], x: float) -> Stretch:
    """Factors about a cross hole: the plain section less the hole's strip through its middle, a tube's bore apart."""
    across, depth = section.width, section.height
    if to == "z":
        across, depth = depth, across
    inner = section.radius_ratio * section.width
    area = 1.0 - d * (across - inner) / section.area
    along, aside = d * (across**3 - inner**3) / 12.0, d**3 * (across - inner) / 12.0
    left = {"y": (aside, along), "z": (along, aside)}[to]
    shares = [
        max(area, 0.05),
        *(max(1.0 - lost / i, 0.05) for lost, i in zip(left, (section.i_y, section.i_z), strict=True)),
    ]
    return x - HOLE * d / 2.0, x + HOLE * d / 2.0, _factors(*shares)


def _at_bore(body: Body, pin: Pin, x: float) -> Stretch:
    """Factors at a pin's bore, where the eye's net section stands for the plain one; never below 1."""
    if body.ring(pin).diameter == 0.0:
        return _at_hole(body.section_at(pin.x), pin.diameter, "z", x)
    wide, thick, diameter = body.ring(pin).diameter, body.ring(pin).thickness, pin.diameter
    section = body.section_at(pin.x) if pin.foot is None else body.part.arm_section
    area = (wide - diameter) * thick / section.area
    i_z = thick * (wide**3 - diameter**3) / 12.0 / section.i_z
    i_y = (wide - diameter) * thick**3 / 12.0 / section.i_y
    return x - diameter / 2.0, x + diameter / 2.0, np.asarray(np.maximum(_factors(area, i_y, i_z), 1.0))


def _narrowest(body: Body) -> Real:
    """Factors all along: 1, but of a disc those of its narrowest chord between its holes instead of its diameter."""
    chord, full = hand_section(body), body.part.section
    return _factors(chord.area / full.area, chord.i_y / full.i_y, chord.i_z / full.i_z)
