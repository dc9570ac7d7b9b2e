"""Structure-aware mutation of cases: of their tables and of their text."""

import datetime
import json
import math
import random
import re
import string
from copy import deepcopy
from typing import Any

HOSTILE_TEXT = (
    "",
    " ",
    "../x",
    "..\\x",
    "/etc/passwd",
    "a/b",
    "'",
    '"',
    "<script>alert(1)</script>",
    "&amp;",
    "{{7*7}}",
    "%s",
    "{0}",
    "\x00",
    "\x1b[2J",
    "a\nb",
    "\r",
    "\u202ex",
    "\ud7ff",
    "\U0010ffff",
    "é" * 70,
    "x" * 5000,
    "__class__",
    "__import__('os')",
    "A",
    "G",
    "pi",
    "nan",
    "inf",
    "1",
    "1 mm",
    "-1 mm",
    "0 mm",
    "1e308 km",
    "1e-320 mm",
    "1e400 mm",
    "1 mm/0",
    "1 mm**9",
    "٣ mm",
    "1 degC",
    "30 deg",
    "1e17 rad",
    "1e300 deg",
    "0.25 N",
    "1e-12 N",
    "1e300 N",
    "2.4 GPa",
    "1450 kg/m^3",
    "3500 rpm",
    "1e6 rpm",
    "10 year",
    "1e300 m/s",
    "6 V",
    "0.9 N/m",
    "1 N*mm",
    "9.81 m/s^2",
    "1e-9 deg",
    "steel-wire",
    "open",
    "yes",
)
HOSTILE_NUMBERS = (
    0,
    1,
    -1,
    2,
    3,
    5,
    100,
    1000,
    100_001,
    2**31,
    2**63,
    2**64,
    10**300,
    -(10**30),
    0.0,
    -0.0,
    0.5,
    1.0,
    1.5,
    1e-9,
    1e-320,
    1e9,
    1e150,
    1.7e308,
    -1e308,
    math.inf,
    -math.inf,
    math.nan,
    True,
    False,
)
_UNITS = (
    "mm m km um inch deg rad turn N mN kN MPa GPa Pa kg g tonne s ms year rpm rad/s Hz N/mm N*mm kg/m^3 mm^2 m/s "
    "m/s^2 W degC kelvin V A mA percent parsec yottameter dB octet mm*deg mm^-4 N*m*s"
)
UNITS = tuple(_UNITS.split(" "))
LENGTHS = string.digits + string.ascii_uppercase + string.ascii_lowercase
"""Letters by which a link of PMKS+ tells its length."""
QUANTITY = re.compile(r"([+-]?[\d.]+(?:[eE][+-]?\d+)?)\s*(.*)", re.DOTALL)
_TOKENS = (
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ".",
    ",",
    '"',
    "'",
    '"""',
    "'''",
    "#",
    "\n",
    "\r\n",
    "\t",
    " ",
    "true",
    "false",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "0x10",
    "1_000",
    "1979-05-27T07:32:00Z",
    "\\u0000",
    "\\ud800",
    "\\x",
    "[links.",
    "[joints.",
    "[[claims]]\n",
    "[motion]\n",
    "[parts.",
    "[load_cases.",
    "schema_version = 1\n",
    "ground = true\n",
    'type = "slider"\n',
    'type = "pin-in-slot"\n',
    'coordinate = "AB"\n',
    'shape = "bar"\n',
    "poses = 100000\n",
    "count = 200\n",
    'tolerance = "1 %"\n',
    'stated = "1 N"\n',
)


def any_value(rng: random.Random, depth: int = 0) -> Any:
    """Return some value that TOML can hold."""
    kind = rng.randrange(9 if depth < 3 else 6)
    if kind <= 1:
        return rng.choice(HOSTILE_TEXT)
    if kind <= 3:
        return rng.choice(HOSTILE_NUMBERS)
    if kind == 4:
        return quantity(rng)
    if kind == 5:
        return rng.choice((datetime.date(1979, 5, 27), datetime.time(7, 32), datetime.datetime(1979, 5, 27, 7, 32)))
    if kind == 6:
        return {rng.choice(HOSTILE_TEXT): any_value(rng, depth + 1) for _ in range(rng.randrange(4))}
    return [any_value(rng, depth + 1) for _ in range(rng.randrange(5))]


def quantity(rng: random.Random) -> str:
    """Return text like a quantity, of any size and unit."""
    number = rng.choice(
        (f"{rng.uniform(-200, 200):.6g}", f"{10.0 ** rng.uniform(-30, 30):.3g}", "0", "1e308", "1e-308", "-1")
    )
    return f"{number} {rng.choice(UNITS)}"


def tables(rng: random.Random, seed: dict[str, Any]) -> dict[str, Any]:
    """Return a case's tables with one to four of their entries changed."""
    found = deepcopy(seed)
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        _change(rng, found)
    return found


def places(node: Any) -> list[tuple[Any, Any]]:
    """Return (table or array, key) of every entry at any depth."""
    entries = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    found: list[tuple[Any, Any]] = []
    for key, value in entries:
        found.append((node, key))
        found += places(value)
    return found


def _change(rng: random.Random, root: dict[str, Any]) -> None:
    there = places(root)
    if not there:
        root["schema_version"] = 1
        return
    holder, key = rng.choice(there)
    value = holder[key]
    kind = rng.randrange(10)
    if kind == 0:
        del holder[key]
    elif kind == 1:
        holder[key] = any_value(rng)
    elif kind == 2 and isinstance(holder, dict):
        holder[rng.choice((*HOSTILE_TEXT, *(k for h, k in there if isinstance(k, str))))] = holder.pop(key)
    elif kind == 3:
        other, place = rng.choice(there)
        holder[key], other[place] = deepcopy(other[place]), deepcopy(value)
    elif kind == 4:
        holder[key] = deepcopy(_value(rng.choice(there)))
    elif kind == 5 and isinstance(holder, list):
        holder.insert(rng.randrange(len(holder) + 1), deepcopy(_value(rng.choice(there))))
    elif kind == 6 and isinstance(value, dict):
        value[rng.choice(HOSTILE_TEXT)] = deepcopy(_value(rng.choice(there)))
    elif isinstance(value, str) and (match := QUANTITY.fullmatch(value)):
        number, unit = match.groups()
        if rng.random() < 0.8:
            scale = rng.choice((-1.0, 0.0, 0.5, 2.0, 1.0 + 1e-12, 10.0 ** rng.uniform(-12, 12), rng.gauss(1.0, 0.3)))
            holder[key] = f"{float(number) * scale!r} {unit}" if number.strip("+-.") else value
        else:
            holder[key] = f"{number} {rng.choice(UNITS)}"
    elif isinstance(value, str):
        holder[key] = rng.choice((*HOSTILE_TEXT, *(v for p in there if isinstance(v := _value(p), str))))
    elif isinstance(value, bool):
        holder[key] = not value
    elif isinstance(value, int | float):
        holder[key] = rng.choice((*HOSTILE_NUMBERS, value + 1, value - 1, value * 1.1))
    else:
        holder[key] = any_value(rng)


def _value(place: tuple[Any, Any]) -> Any:
    holder, key = place
    return holder[key]


def text(rng: random.Random, source: bytes) -> bytes:
    """Return the text of a case with one to four places changed: lines, words or bytes."""
    data = source
    for _ in range(rng.choice((1, 1, 2, 3, 4))):
        kind = rng.randrange(8)
        lines = data.split(b"\n")
        i = rng.randrange(len(lines))
        if kind == 0:
            del lines[i]
        elif kind == 1:
            lines.insert(rng.randrange(len(lines) + 1), lines[i])
        elif kind == 2:
            j = rng.randrange(len(lines))
            lines[i], lines[j] = lines[j], lines[i]
        elif kind == 3:
            lines[i] = lines[i][: rng.randrange(len(lines[i]) + 1)]
        elif kind == 4:
            cut = rng.randrange(len(lines[i]) + 1)
            lines[i] = lines[i][:cut] + rng.choice(_TOKENS).encode() + lines[i][cut:]
        elif kind == 5:
            cut = rng.randrange(len(lines[i]) + 1)
            lines[i] = lines[i][:cut] + rng.randbytes(rng.choice((1, 1, 2, 8))) + lines[i][cut:]
        elif kind == 6:
            key, sign, _ = lines[i].partition(b"=")
            value = rng.choice((quantity(rng), *HOSTILE_TEXT))
            lines[i] = key + sign + b' "' + value.encode() + b'"' if sign else key
        else:
            key, sign, _ = lines[i].partition(b"=")
            lines[i] = key + sign + f" {rng.choice(HOSTILE_NUMBERS)!r}".lower().encode() if sign else key
        data = b"\n".join(lines)
    return data


def json_text(rng: random.Random, source: str) -> str:
    """Return the text of a JSON file with entries changed, or one time in four with bytes changed."""
    if rng.random() < 0.25:
        return text(rng, source.encode()).decode("utf-8", "replace")
    found = json.dumps(tables(rng, json.loads(source)), default=str)
    if rng.random() < 0.1:  # what JSON escapes and TOML does not hold, at the beginning of a text
        parts = found.split('"')
        i = rng.randrange(len(parts))
        parts[i] = rng.choice(("\\ud800", "\\u007f", "\\u0000", "\\n", "\\u2028")) + parts[i]
        found = '"'.join(parts)
    return found


def code(rng: random.Random, source: str) -> str:
    """Return a link of PMKS+ with one to four of its fields changed; its last letter mostly tells its length anew."""
    parts = [part.split(",") for part in source.strip()[:-1].split(".")]
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        part = rng.choice(parts)
        i, kind = rng.randrange(len(part)), rng.randrange(9)
        other = rng.choice(rng.choice(parts))
        if kind == 0:
            del part[i]
            part += [] if part else [""]
        elif kind == 1:
            part.insert(i, other)
        elif kind == 2:
            part[i] = rng.choice((*HOSTILE_TEXT, "0", "0" * 40, "_" * rng.randrange(1, 60)))
        elif kind == 3:
            parts.insert(rng.randrange(len(parts) + 1), list(rng.choice(parts)))
        elif kind == 4 and len(parts) > 1:
            parts.remove(part)
        elif kind <= 6:
            part[i] = other
        else:
            at = rng.randrange(len(part[i]) + 1)
            part[i] = part[i][:at] + rng.choice("0159AKYRPZaz_-,.?%\x7f") + part[i][at + rng.randrange(2) :]
    whole = ".".join(",".join(part) for part in parts)
    told = LENGTHS[len(whole) % len(LENGTHS)]
    return whole + (told if rng.random() < 0.95 else rng.choice(LENGTHS))
