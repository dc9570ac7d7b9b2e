"""Mutation that keeps to the grammar: most of what it makes is valid, so that inputs come past the front door.

Numbers move a little, units change for others of their dimension, names for others of their table, arrays are swapped.
"""

import json
import random
import re
from copy import deepcopy
from typing import Any

from fuzz import mutate

_ALIKE = (
    ("mm", "cm", "m", "inch"), ("deg", "rad", "turn"), ("N", "mN", "kN"), ("MPa", "GPa", "Pa", "N/mm^2"),
    ("kg", "g", "tonne"), ("s", "ms", "minute", "year"), ("rpm", "rad/s", "Hz"), ("N*mm", "N*m", "N·mm"),
    ("kg/m^3", "g/cm^3"), ("m/s", "km/hour", "mm/s"), ("m/s^2", "mm/s^2"), ("N/m", "N/mm"), ("%", ""),
    ("degC", "kelvin"),
)  # fmt: skip
_TOKEN = re.compile(r"[0-9]+\.?[0-9]*(?:[eE][+-]?[0-9]+)?|[A-Za-z_.°µ%]+|\*\*|[^\sA-Za-z0-9]|\s+")
_FUNCTIONS = ("sqrt", "abs", "sin", "cos", "tan", "asin", "acos", "atan", "radians", "degrees")
_OPERATORS = ("+", "-", "*", "/")


def tables(rng: random.Random, seed: dict[str, Any]) -> dict[str, Any]:
    """Return a case's tables with one to six entries changed for others of their kind."""
    found = deepcopy(seed)
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        places = mutate.places(found)
        holder, key = rng.choice(places)
        names = [k for h, k in places if isinstance(k, str) and h is not found]
        holder[key] = value(rng, holder[key], [*names, *(v for h, k in places if isinstance(v := h[k], str))])
    return found


def value(rng: random.Random, old: Any, names: list[str]) -> Any:
    """Return an entry changed for one of its kind; of ``names`` one may take the place of another."""
    if isinstance(old, bool):
        return not old
    if isinstance(old, int):
        return max(0, old + rng.choice((-1, 1, 1, 2)))
    if isinstance(old, float):
        return old * rng.gauss(1.0, 0.2)
    if isinstance(old, str):
        if mutate.QUANTITY.fullmatch(old):
            return quantity(rng, old)
        if " " in old:  # a title, a source, a claim's expression
            return text(rng, old)
        return rng.choice(names) if names and rng.random() < 0.5 else old
    if isinstance(old, list):
        return rng.sample(old, len(old)) if rng.random() < 0.7 else [*old, *deepcopy(old[-1:])]
    if isinstance(old, dict) and len(old) > 1:
        if rng.random() < 0.5:  # the order of entries
            return dict(rng.sample(list(old.items()), len(old)))
        left = rng.choice(list(old))
        return {key: entry for key, entry in old.items() if key != left}
    return old


def quantity(rng: random.Random, old: str) -> str:
    """Return a quantity moved a little, or in another unit of its dimension."""
    match = mutate.QUANTITY.fullmatch(old)
    try:
        number, unit = float(match[1]), match[2]  # type: ignore[index]
    except (TypeError, ValueError):  # no quantity, or a number such as 1.2.3
        return old
    alike = next((units for units in _ALIKE if unit in units), (unit,))
    if rng.random() < 0.3:
        unit = rng.choice(alike)
    elif rng.random() < 0.8:
        number *= rng.choice((rng.gauss(1.0, 0.05), rng.gauss(1.0, 0.3), -1.0, 0.0, 1.0 + 1e-12))
    else:
        number *= 10.0 ** rng.uniform(-6, 6)
    return f"{number!r} {unit}".rstrip()


def text(rng: random.Random, old: str) -> str:
    """Return text with one of its tokens changed for one of its kind: number, unit or name, operator."""
    tokens = _TOKEN.findall(old)
    if not tokens:
        return old
    i = rng.randrange(len(tokens))
    token = tokens[i]
    if token[0] in "0123456789":
        tokens[i] = f"{float(token[:300]) * rng.choice((rng.gauss(1.0, 0.3), 2.0, 10.0, 1.0 + 1e-12)):.12g}"
    elif token in _OPERATORS:
        tokens[i] = rng.choice(_OPERATORS)
    elif token in _FUNCTIONS:
        tokens[i] = rng.choice(_FUNCTIONS)
    elif alike := next((units for units in _ALIKE if token in units), None):
        tokens[i] = rng.choice(alike)
    elif rng.random() < 0.5:
        tokens[i] = token + rng.choice(("", " + 1", "*2", " N", " mm", " ", "²"))
    else:
        first, second = sorted((i, rng.randrange(len(tokens))))
        tokens[first], tokens[second] = tokens[second], tokens[first]
    return "".join(tokens)


def override(rng: random.Random, seed: dict[str, Any]) -> str:
    """Return the text behind ``--set`` that changes an entry of a case for one of its kind."""
    paths: list[tuple[str, Any]] = []

    def walk(path: str, node: Any) -> None:
        entries = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
        for key, entry in entries:
            inner = f"{path}.{key}".lstrip(".")
            paths.append((inner, entry))
            walk(inner, entry)

    walk("", seed)
    path, old = rng.choice(paths)
    names = [entry for _, entry in paths if isinstance(entry, str)]
    return f"{path}={written(value(rng, old, names))}"


def written(entry: Any) -> str:
    """Return an entry as TOML, on one line."""
    if isinstance(entry, dict):
        return "{" + ", ".join(f"{json.dumps(str(key))} = {written(inner)}" for key, inner in entry.items()) + "}"
    if isinstance(entry, list):
        return "[" + ", ".join(map(written, entry)) + "]"
    if isinstance(entry, float):
        return repr(entry)
    return json.dumps(entry, default=str)


def case(rng: random.Random, seed: dict[str, Any]) -> bytes:
    """Return the text of a case with entries changed for others of their kind."""
    return "\n".join(f"{json.dumps(key)} = {written(entry)}" for key, entry in tables(rng, seed).items()).encode()
