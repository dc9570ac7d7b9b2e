"""Mechanisms of PMKS+: the link that its "copy URL" gives, after the question mark.

The format is that of ``string-transcoder.ts`` in PMKS-Web/PMKSWeb (2026): settings, joints, links, forces and the
selected object, apart by full stops; numbers in base 64, a thousand times as large, after a 0 where they are negative;
the last character tells the length of the rest, less multiples of 62.
"""

import cmath
import string
from collections.abc import Sequence
from dataclasses import dataclass
from urllib.parse import unquote

from alula.geometry.base.errors import CaseError
from alula.loads.exchange.sketch import MALFORMED, Push, Rider, Sketch, plain_name
from alula.loads.text.explain import printable

_LETTERS = string.digits + string.ascii_uppercase + string.ascii_lowercase
_DIGITS = _LETTERS + "_-"
_PRISMATIC, _INPUT, _GROUNDED, _WELDED = 1, 2, 4, 8
_LOCAL, _OUTWARD = 1, 2
"""Of a force: it turns with its link; its arrow leads from where it acts, and else to there."""
_LENGTHS = {0: 25.4, 1: 10.0, 2: 1000.0}
"""Inch, cm, m [mm]."""
_FORCES = {0: 4.4482216152605, 1: 1.0}
"""Pound-force, newton [N]."""


@dataclass(frozen=True, kw_only=True)
class _Joint:
    flags: int
    at: complex
    angle: float
    carrier: str

    def has(self, flag: int) -> bool:
        return bool(self.flags & flag)


def read_pmks(text: str, name: str) -> Sketch:
    """Read a mechanism of PMKS+.

    Parameters
    ----------
    text : str
        The link, or what follows its question mark.
    name : str
        Of the file that holds it, for sentences.

    Returns
    -------
    Sketch
        Masses and colours are left out.

    Raises
    ------
    CaseError
        For a text that is no such link, or one that was cut short, and for what cannot be taken over: an input that is
        no pin on the ground, a block that slides on a moving link or is welded to its pin.
    """
    code = unquote(text.strip()).rpartition("?")[2]
    if len(code) < 2 or _LETTERS[(len(code) - 1) % len(_LETTERS)] != code[-1]:
        raise CaseError(f"'{name}': it is no whole link of PMKS+; copy it anew")
    try:
        return _read(code[:-1], name)
    except MALFORMED as error:
        raise CaseError(f"'{name}': it is no link of PMKS+ ({printable(repr(error))}); copy it anew") from None


def _read(code: str, name: str) -> Sketch:
    _, _, _, units, *rest = code.split(".")
    length, force = _LENGTHS[_integer(units[0])], _FORCES[_integer(units[2])]
    blocks = _blocks(rest)
    joints = dict(_joint(text, length) for text in blocks[0])
    ids: dict[str, str] = {}
    for one in joints:
        ids[one] = plain_name(one, list(ids.values()))
    links: dict[str, list[str]] = {}
    called: dict[str, str] = {}
    pistons: list[list[str]] = []
    for text in blocks[1]:
        root, kind, (one, own, welded) = text[0] == "Y", text[1], _link(text[2:])
        if kind == "P":
            pistons.append(own)
        elif root:
            called[one] = plain_name(one, ["ground", *links])
            called |= dict.fromkeys(
                filter(None, welded), called[one]
            )  # older ones name the part of a link that a force is on
            links[called[one]] = [ids[joint] for joint in own]
    riders = [_rider(own, joints, ids, name) for own in pistons]
    pins = {ids[one]: joint.at for one, joint in joints.items() if not joint.has(_PRISMATIC)}
    ground = [ids[one] for one, joint in joints.items() if joint.has(_GROUNDED) and not joint.has(_PRISMATIC)]
    return Sketch(
        title=f"Mechanism of PMKS+, {name}",
        origin=f"PMKS+, {name}",
        points=pins,
        links=links,
        ground=ground,
        driven=_driven(joints, ids, links, name),
        riders=riders,
        pushes=[_push(text, called, length, force) for text in blocks[2]],
    )


def _blocks(parts: Sequence[str]) -> list[list[str]]:
    """Split joints, links and forces, each list of which ends with an empty text."""
    blocks: list[list[str]] = [[], [], []]
    place = 0
    for part in parts:
        if not part:
            place += 1
        elif place < len(blocks):
            blocks[place].append(part)
    return blocks


def _joint(text: str, length: float) -> tuple[str, _Joint]:
    flags, (one, _, x, y, angle, *slot) = _digit(text[0]), text[1:].split(",")
    at = complex(_decimal(x), _decimal(y)) * length
    return one, _Joint(flags=flags, at=at, angle=_decimal(angle), carrier=slot[0] if slot else "")


def _link(text: str) -> tuple[str, list[str], list[str]]:
    """Return the name of a link, its joints, which an empty text ends, and the links of which it is welded."""
    one, _, _, _, _, _, _, *own = text.split(",")
    end = own.index("")
    return one, own[:end], own[end + 1 :]


def _push(text: str, called: dict[str, str], length: float, force: float) -> Push:
    flags, (_, link, _, *numbers) = _digit(text[0]), text[1:].split(",")
    x, y, end_x, end_y, size = (_decimal(number) for number in numbers[:5])
    along = complex(end_x - x, end_y - y) * (1.0 if flags & _OUTWARD else -1.0)
    return Push(
        link=called[link],
        at=complex(x, y) * length,
        force=size * force * along / abs(along),
        turns=bool(flags & _LOCAL),
    )


def _rider(own: Sequence[str], joints: dict[str, _Joint], ids: dict[str, str], name: str) -> Rider:
    pin, guide = sorted(own, key=lambda one: joints[one].has(_PRISMATIC))
    if not joints[guide].has(_GROUNDED) or joints[guide].carrier:
        raise CaseError(
            f"'{name}': joint {printable(guide)} slides on a moving link, which is not taken over; leave it out, and "
            "state it in the case as a joint of type pin-in-slot"
        )
    if any(joints[one].has(_WELDED) for one in own):
        raise CaseError(
            f"'{name}': pin {printable(pin)} is welded to its block, which is not taken over; take the weld off, and "
            "let the link slide itself in the case by a joint of type slider"
        )
    return Rider(point=ids[pin], through=joints[guide].at, along=cmath.rect(1.0, joints[guide].angle))


def _driven(joints: dict[str, _Joint], ids: dict[str, str], links: dict[str, list[str]], name: str) -> tuple[str, str]:
    inputs = [one for one, joint in joints.items() if joint.has(_INPUT)]
    turning = [one for one in inputs if joints[one].has(_GROUNDED) and not joints[one].has(_PRISMATIC)]
    if len(inputs) != 1 or not turning:
        found = printable(", ".join(inputs)) or "none"
        raise CaseError(
            f"'{name}': the input has to be one pin on the ground, and here it is {found}; change it in PMKS+"
        )
    pivot = ids[turning[0]]
    return next(link for link, points in links.items() if pivot in points), pivot


def _digit(letter: str) -> int:
    return _DIGITS.index(letter)


def _integer(text: str) -> int:
    """Return a number in base 64; a 0 before it makes it negative."""
    sign, digits = (-1, text[1:]) if text.startswith("0") else (1, text)
    value = 0
    for letter in digits:
        value = value * len(_DIGITS) + _digit(letter)
    return sign * value


def _decimal(text: str) -> float:
    return _integer(text) / 1000.0
