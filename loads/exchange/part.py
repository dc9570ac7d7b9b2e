"""A part from CAD: the entries of a case for it, and a whole case in which it is held and loaded, to be corrected."""

import cmath
import json
import math
import os
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from alula.geometry.base.errors import CaseError
from alula.geometry.imported.arrangement import LinkFrame, far_end, link_frame, single_frame
from alula.geometry.imported.facts import PartFacts, PartSurface
from alula.geometry.imported.read import part_surface
from alula.geometry.parts.mesh_part import UNITS
from alula.loads.case.case_file import validate
from alula.loads.exchange.sketch import plain_name
from alula.loads.text.explain import printable

ASSUMED_MATERIAL = "aluminium-6061-t6"
"""Material in the entries where none is named."""
LOAD = 10.0
"""Force of a case to begin with [N]."""
SAG = 0.01
"""Displacement that such a case allows where the force acts, as a share of its distance from the pivot."""
END = "P"
"""Point at the far end of a part with a single pin."""
HEAD = """\
# A case for {file}. Check it with:  alula check THIS_FILE -o out
# Bores and lengths are as they were found. What they are for is a guess: correct the lines marked GUESS.
# Found: one solid of {sizes} mm along x, y, z of its file.{left}

schema_version = 1
title = {title}
assumptions = [
  "Guessed from the bores of the part: what holds it, its load, its material, its largest displacement. Correct them.",
]
{massless}
{part}
{link_table}
# The ground: global axes, x to the right, y up.
[links.{ground}]
ground = true
points.{pivot} = ["0 mm", "0 mm"]
"""
DRIVEN = """
[joints]
{pivot} = {{ links = ["{ground}", {link}], pin_diameter = "{pin} mm" }}    # as wide as the bore

[pose]
coordinate = {link}
angle = "{angle} deg"    # GUESS: {pivot}-{loaded} lies level

[drive]    # GUESS: a torque about {pivot} holds the part
link = {link}
joint = "{pivot}"
"""
TIED = """points.R = {foot}    # GUESS: the rod stands square to {pivot}-{tied}

# A rod holds the part, from {tied} to the ground. It has no part of its own: its direction alone counts.
[links.{rod}]
points.{tied} = ["0 mm", "0 mm"]
points.R = {length}

[joints]
{pivot} = {{ links = ["{ground}", {link}], pin_diameter = "{pin} mm" }}    # as wide as the bore
{tied} = {{ links = ["{rod}", {link}], pin_diameter = "{tied_pin} mm" }}    # as wide as the bore
R = {{ links = ["{ground}", "{rod}"] }}

[pose]
near = {{ {key} = "{angle} deg", {rod} = "{lean} deg" }}    # GUESS: {pivot}-{loaded} lies level
"""
FOOT = """
[load_cases.load]
title = "a guessed force at {loaded}, and own weight"
own_weight = true    # down, along -y
[[load_cases.load.forces]]
link = {link}
at = "{loaded}"
force = ["0 N", "{force} N"]    # GUESS: along x and y

[checks.strength]    # stays elastic: first yield anywhere
type = "safety-factor"

[checks.collapse]    # does not break; leave it out of a part that is brittle or printed
type = "plastic-collapse"
minimum = 2.0    # GUESS

[checks.pins]
type = "pins"

[checks.stiffness]
type = "displacement"
at = "{loaded}"
maximum = "{sag} mm"    # GUESS: {share} of {pivot}-{loaded}
"""
Line = tuple[str, str]
"""An entry, and what is told behind it."""


@dataclass(frozen=True, kw_only=True)
class FoundPart:
    """What is found in the file of a part.

    Attributes
    ----------
    path : Path
        The file.
    facts : PartFacts
        What is found in it.
    material : str or None
        Name of the material; None where none is named.
    unit : str or None
        Unit of length of a mesh; None of a STEP file, which states its own.
    """

    path: Path
    facts: PartFacts
    material: str | None = None
    unit: str | None = None

    @cached_property
    def frame(self) -> LinkFrame | None:
        """The frame of the link that the part may be; None where no two of its bores are parallel."""
        return link_frame(self.facts.bores)

    @property
    def mesh_unit(self) -> float | None:
        """Unit of length of a mesh [mm]; None of a STEP file."""
        return None if self.unit is None else UNITS[self.unit]

    @cached_property
    def surface(self) -> PartSurface:
        """Triangles of its surface."""
        return part_surface(self.path, self.mesh_unit)

    @property
    def name(self) -> str:
        """Name of part and link in the entries: that of the file, as far as it is one."""
        kept = "".join(c if c.isalnum() or c in "-_+ " else "-" for c in self.path.stem).strip("-_+ ")
        while len(kept.encode()) > 60:
            kept = kept[:-1].rstrip("-_+ ")
        return kept or "part"


def part_entries(found: FoundPart) -> str:
    """Return the entries of a case file for a part and its link, as TOML.

    Parameters
    ----------
    found : FoundPart

    Returns
    -------
    str
        Empty where the part has no bore that may be a pin's.
    """
    frame = found.frame or single_frame(found.facts)
    if frame is None:
        return ""
    return (
        f"{_written(_part(found, frame, found.path.name, 'beside the case file'))}\n{_written(_link(found, frame, {}))}"
    )


def part_case(found: FoundPart, case: Path) -> str:
    """Return the text of a case in which a part is held and loaded, as may be guessed from its bores.

    Of three bores the one opposite the longest side is the pivot, the farther one of the others bears a force across
    its arm, and a rod holds the nearer one. Of two, or more than three, a drive holds the first of the two that lie
    farthest apart, and the other one is loaded; of one, the far end is.

    Parameters
    ----------
    found : FoundPart
    case : Path
        Where the case is to stand.

    Returns
    -------
    str

    Raises
    ------
    CaseError
        For a part without a bore, and for one that makes no case.
    """
    rounds = [bore for bore in found.facts.bores if not bore.slot]
    frame = link_frame(rounds) or single_frame(found.facts)
    if frame is None:
        raise CaseError(
            f"'{printable(found.path.name)}': no round bore was found, and pins hold a part by its bores; give it the "
            "bore of its pivot in the CAD program, and export it anew"
        )
    if found.unit and len(frame.bores) == 1:
        raise CaseError(
            f"'{printable(found.path.name)}': it is a mesh, which takes loads in its bores alone, and it has one bore; "
            "give the part as a STEP file"
        )
    text = _case(found, frame, beside(found.path, case))
    validate(tomllib.loads(text), str(case.parent)).solve_pose()
    return text


def beside(file: Path, case: Path) -> str:
    """Return the path of a file as a case states it: relative to the folder of the case.

    Parameters
    ----------
    file, case : Path

    Returns
    -------
    str
    """
    folder = os.path.relpath(os.path.realpath(file.parent), os.path.realpath(case.parent))
    return (Path(folder) / file.name).as_posix()


def _case(found: FoundPart, frame: LinkFrame, file: str) -> str:
    places = {name: complex(*at) for name, at in frame.points.items()}
    if len(places) == 1:
        places[END] = complex(*far_end(found.surface, frame))
    pivot, loaded, *more = places
    tied = ""
    if len(more) == 1:
        tied, loaded = sorted((pivot, loaded), key=lambda name: abs(places[name] - places[more[0]]))
        [pivot] = more
    arm = places[loaded] - places[pivot]
    level = abs(arm) / arm
    link = _quoted(found.name)
    words = {
        "file": printable(found.path.name),
        "sizes": " x ".join(_short(high - low) for low, high in zip(found.facts.low, found.facts.high, strict=True)),
        "left": _left(found, frame),
        "title": _quoted(f"{found.name}: a first case, guessed from its bores"),
        "part": _written(_part(found, frame, file, "relative to this file")),
        "link_table": _written(
            _link(
                found,
                frame,
                {pivot: "GUESS: the pivot", tied: "GUESS: held here", loaded: "GUESS: the force acts here"},
            )
        ),
        "link": link,
        "key": _key(found.name),
        "ground": plain_name("base", [found.name]),
        "rod": plain_name("rod", [found.name]),
        "pivot": pivot,
        "tied": tied,
        "loaded": loaded,
        "pin": _short(frame.bores[pivot].diameter),
        "angle": _degrees(level),
        "force": _exact(-LOAD),
        "sag": f"{float(f'{SAG * abs(arm):.2g}'):g}",
        "share": f"{SAG:.0%}",
    }
    words["massless"] = ""
    if tied:
        short = places[tied] - places[pivot]
        foot = short * level * (1.0 + 1j)
        words |= {
            "massless": f'massless = ["{words["rod"]}"]\n',
            "tied_pin": _short(frame.bores[tied].diameter),
            "foot": _at(foot),
            "length": _at(complex(abs(short))),
            "lean": _degrees(short * level * 1j),
        }
    return ((HEAD + TIED if tied else HEAD + DRIVEN) + FOOT).format_map(words)


def _left(found: FoundPart, frame: LinkFrame) -> str:
    used = {bore.name for bore in frame.bores.values()}
    left = ", ".join(bore.told for bore in found.facts.bores if bore.name not in used)
    return f" Not used: {left}." if left else ""


def _part(found: FoundPart, frame: LinkFrame, file: str, where: str) -> Iterator[Line]:
    """Yield the table of the part."""
    yield f"[parts.{_key(found.name)}]", ""
    yield 'shape = "mesh"' if found.unit else 'shape = "step"', ""
    if found.unit:
        yield f'unit = "{found.unit}"', "GUESS: the file states none"
    yield f"file = {_quoted(file)}", where
    yield f'material = "{found.material or ASSUMED_MATERIAL}"', "" if found.material else "GUESS: state the part's own"
    for point, bore in frame.bores.items():
        yield f'bores.{point} = "{bore.name}"', ""
    if len(frame.bores) == 1:
        along = ", ".join(_exact(value) for value in frame.axes[0])
        yield f"along = [{along}]", "GUESS: x of the link in the file"


def _link(found: FoundPart, frame: LinkFrame, told: Mapping[str, str]) -> Iterator[Line]:
    """Yield the table of the link, with what is told of its points."""
    yield f"[links.{_key(found.name)}]", ""
    yield f"part = {_quoted(found.name)}", ""
    for point, at in frame.points.items():
        kind = "slot" if point in frame.slots else "bore"
        size = f"{kind} of {_short(frame.bores[point].diameter)} mm"
        yield f"points.{point} = {_at(complex(*at))}", f"{size}; {told[point]}" if point in told else size
    if len(frame.bores) == 1 and not found.unit:
        end = complex(*far_end(found.surface, frame))
        yield f"points.{END} = {_at(end)}", f"the far end; {told.get(END, 'GUESS: a load point')}"
    for point, (first, last) in frame.slots.items():
        ends = f'{{ first = "{_exact(first)} mm", last = "{_exact(last)} mm" }}'
        yield f"slots.{point} = {ends}", 'for a joint of type "pin-in-slot", this link first'


def _written(table: Iterable[Line]) -> str:
    """Return the lines of a table, with what is told of them below each other."""
    lines = list(table)
    wide = max(len(line) for line, told in lines if told)
    return "".join(f"{line:<{wide}}  # {told}\n" if told else f"{line}\n" for line, told in lines)


def _at(place: complex) -> str:
    return f'["{_exact(place.real)} mm", "{_exact(place.imag)} mm"]'


def _degrees(direction: complex) -> str:
    return _exact(math.degrees(cmath.phase(direction)))


def _short(value: float) -> str:
    return _exact(value, 4)


def _exact(value: float, digits: int = 6) -> str:
    text = f"{round(value, digits) + 0.0:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _key(text: str) -> str:
    """Return a text as a key of TOML, bare where it may be."""
    return text if text.isascii() and all(c.isalnum() or c in "-_" for c in text) else _quoted(text)


def _quoted(text: str) -> str:
    return json.dumps(text.encode(errors="replace").decode(), ensure_ascii=False).replace("\x7f", "\\u007f")
