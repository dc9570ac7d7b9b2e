"""A linkage as other programs know it, points, links, joints and forces, and the case file that it makes."""

import cmath
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from alula.geometry.base.errors import CaseError
from alula.loads.text.explain import printable

GUIDED = 10.0
"""Distance of the second point of a sliding block from its pin [mm]; it only shows along what the block slides."""
MALFORMED = (ArithmeticError, AttributeError, LookupError, RecursionError, StopIteration, TypeError, ValueError)
"""What reading a file raises that is not of the form that it should have."""
_SAME = 1e-6
"""Points nearer than this are one [mm]."""


@dataclass(frozen=True, kw_only=True)
class Rider:
    """A pin that slides along a straight guide of the ground, in a block that keeps its direction.

    Attributes
    ----------
    point : str
        The pin.
    through : complex
        A point of the guide [mm].
    along : complex
        Direction of the guide.
    """

    point: str
    through: complex
    along: complex


@dataclass(frozen=True, kw_only=True)
class Push:
    """A force on a link.

    Attributes
    ----------
    link : str
    at : complex
        Where [mm].
    force : complex
        In global axes, in the pose of the sketch [N].
    turns : bool
        True where it turns with its link.
    """

    link: str
    at: complex
    force: complex
    turns: bool = False


@dataclass(frozen=True, kw_only=True)
class Sketch:
    """A linkage in one pose.

    Attributes
    ----------
    title, origin : str
        The title of its case, and the program and file that it comes from.
    points : mapping of str to complex
        Pins and other points by their names [mm].
    links : mapping of str to sequence of str
        Moving links and their points.
    ground : sequence of str
        Points of the ground.
    driven : tuple of (str, str)
        The link that the motor turns, and the pin on the ground about which it does.
    riders : sequence of Rider
        Pins that slide.
    pushes : sequence of Push
        Forces.
    """

    title: str
    origin: str
    points: Mapping[str, complex]
    links: Mapping[str, Sequence[str]]
    ground: Sequence[str]
    driven: tuple[str, str]
    riders: Sequence[Rider] = ()
    pushes: Sequence[Push] = ()


def case_text(sketch: Sketch) -> str:
    """Return the text of a case file: its linkage, pose and loads; parts are left to its reader.

    Parameters
    ----------
    sketch : Sketch

    Returns
    -------
    str

    Raises
    ------
    CaseError
        Where a link has fewer than two points or no length, or the driven link is none.
    """
    return "\n".join(_lines(sketch)) + "\n"


def plain_name(text: str, taken: Sequence[str] = ()) -> str:
    """Return a text as a name that a case file takes without quotes: letters, digits and hyphens.

    Parameters
    ----------
    text : str
    taken : sequence of str, optional
        Names that it must not have.

    Returns
    -------
    str
    """
    base = re.sub(r"[^A-Za-z0-9]+", "-", text).strip("-") or "x"
    name, count = base, 2
    while name in taken:
        name, count = f"{base}-{count}", count + 1
    return name


@dataclass(frozen=True, kw_only=True)
class _Body:
    """A moving link in its own frame: x from its first point to the farthest one."""

    origin: complex
    axis: complex
    points: Mapping[str, complex]

    def own(self, at: complex) -> complex:
        return (at - self.origin) / self.axis


def _lines(sketch: Sketch) -> Iterator[str]:
    bodies = {name: _body(name, points, sketch.points) for name, points in sketch.links.items()}
    for rider in sketch.riders:
        bodies[f"block-{rider.point}"] = _block(rider, sketch.points)
    loads = list(_loads(sketch, bodies))
    driven, pivot = sketch.driven
    yield f"# A linkage from {sketch.origin}: its links, joints, pose and forces. Parts are to be added (below)."
    yield "# Look at its joint forces with:  alula statics THIS_FILE"
    yield ""
    yield "schema_version = 1"
    yield f"title = {_quoted(sketch.title)}"
    yield f"source = {_quoted(sketch.origin)}"
    yield f"massless = {json.dumps(list(bodies))}   # without parts nothing has a mass"
    yield ""
    yield "[links.ground]"
    yield "ground = true"
    for point in sketch.ground:
        yield _point(point, sketch.points[point])
    for rider in sketch.riders:
        yield _point(f"guide-{rider.point}", rider.through)
    for name, body in bodies.items():
        yield ""
        yield f"[links.{name}]"
        for point, at in body.points.items():
            yield _point(point, at)
    yield ""
    yield "# A joint connects two links at the point that has its name on both, or at the two points that it names."
    yield "[joints]"
    yield from _joints(sketch)
    yield ""
    yield "[pose]"
    yield f"coordinate = {_quoted(driven)}"
    yield f'angle = "{_degrees(bodies[driven].axis)} deg"'
    near = ", ".join(f'{name} = "{_degrees(body.axis)} deg"' for name, body in bodies.items() if name != driven)
    yield f"near = {{ {near} }}"
    yield ""
    yield "[drive]"
    yield f"link = {_quoted(driven)}"
    yield f"joint = {_quoted(pivot)}"
    yield ""
    yield '# Parts: give each link one with part = "bar", take it from massless, and every joint a pin_diameter.'
    yield "# alula schema and the built-in cases (alula new --list) show all shapes. For example:"
    for line in ('[parts.bar]', 'shape = "bar"', 'material = "aluminium-6061-t6"', 'width = "8 mm"',
                 'thickness = "4 mm"', 'fillet_radius = "2 mm"'):  # fmt: skip
        yield f"# {line}"
    yield ""
    yield "[load_cases.load]"
    what = "the forces of the file" if sketch.pushes else "1 N down (assumed, since the file states no force)"
    yield f"title = {_quoted(what)}"
    yield from loads


def _body(name: str, points: Sequence[str], places: Mapping[str, complex]) -> _Body:
    at = [places[point] for point in points]
    far = max(at, key=lambda place: abs(place - at[0]), default=0j)
    if len(at) < 2 or abs(far - at[0]) <= _SAME:
        shown = printable(name)
        raise CaseError(f"link '{shown}': it has no two points that lie apart; give it a length, or leave it out")
    axis = (far - at[0]) / abs(far - at[0])
    return _Body(
        origin=at[0], axis=axis, points={point: (place - at[0]) / axis for point, place in zip(points, at, strict=True)}
    )


def _block(rider: Rider, places: Mapping[str, complex]) -> _Body:
    """Return the block of a pin that slides; it stands as the ground does."""
    end = GUIDED * rider.along / abs(rider.along)
    return _Body(origin=places[rider.point], axis=1.0 + 0j, points={rider.point: 0j, f"end-{rider.point}": end})


def _joints(sketch: Sketch) -> Iterator[str]:
    """Yield one joint fewer than links at every pin; the ground, or else the first link, is the one that all share."""
    sliding = {rider.point for rider in sketch.riders}
    for point in sketch.points:
        at = ["ground"] if point in sketch.ground else []
        at += [name for name, points in sketch.links.items() if point in points]
        at += [f"block-{point}"] if point in sliding else []
        for k, link in enumerate(at[1:]):
            name = point if k == 0 else f"{point}-{link}"
            both = "" if k == 0 else f", points = {json.dumps([point, point])}"
            yield f"{name} = {{ links = {json.dumps([at[0], link])}{both} }}"
    for rider in sketch.riders:
        yield (
            f'slide-{rider.point} = {{ links = ["ground", "block-{rider.point}"], type = "slider", '
            f'points = ["guide-{rider.point}", "{rider.point}"], direction = "{_degrees(rider.along)} deg" }}'
        )


def _loads(sketch: Sketch, bodies: dict[str, _Body]) -> Iterator[str]:
    """Yield the forces, and add the points at which they act to their links."""
    pushes = sketch.pushes or [_assumed(sketch)]
    for k, push in enumerate(pushes, 1):
        body = bodies[push.link]
        own = body.own(push.at)
        point = next((name for name, at in body.points.items() if abs(at - own) <= _SAME), None)
        if point is None:
            point = plain_name(f"F{k}", list(sketch.points))
            bodies[push.link] = _Body(origin=body.origin, axis=body.axis, points={**body.points, point: own})
        yield "[[load_cases.load.forces]]"
        yield f"link = {_quoted(push.link)}"
        yield f"at = {_quoted(point)}"
        force = push.force / body.axis if push.turns else push.force
        yield f'force = ["{_number(force.real)} N", "{_number(force.imag)} N"]'
        if push.turns:
            yield 'axes = "link"'


def _assumed(sketch: Sketch) -> Push:
    """Return a load to begin with: 1 N down at the last point of the last link."""
    link, points = list(sketch.links.items())[-1]
    free = [point for point in points if point not in sketch.ground] or list(points)
    return Push(link=link, at=sketch.points[free[-1]], force=-1j)


def _point(name: str, at: complex) -> str:
    return f'points.{name} = ["{_number(at.real)} mm", "{_number(at.imag)} mm"]'


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _degrees(direction: complex) -> str:
    return _number(math.degrees(cmath.phase(direction)))


def _number(value: float) -> str:
    """Twelve digits, and no negative zero: lengths of links stay what they are to 1e-12."""
    return f"{value:.12g}" if abs(value) > 1e-12 else "0"
