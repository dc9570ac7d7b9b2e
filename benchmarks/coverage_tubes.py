"""Tubes with pins straight through their walls, drawn at random: bands are tried on them as on the other links.

Two to four pins, 0.2 to 0.5 of the tube's diameter, on the axis or off it as far as the rules allow; a bore of 0.5 to
0.9 of the diameter, with or without plugs or bushes; loads in the plane, of every third tube out of it as well.

python -m benchmarks.coverage_tubes SEED COUNT    their bands and truths, one line each, and the table
"""

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.meshing.mesh import check_body
from alula.geometry.parts.part import Body, Pin, Tube
from benchmarks.coverage_parts import Drawn

KIND = "pinned tube"
DIAMETER = 8.0
FORCE = 50.0


def drawn_tubes(seed: int, count: int) -> Iterator[Drawn]:
    """Draw so many tubes; what the rules for bodies refuse is drawn again."""
    rng, judged = np.random.default_rng(seed), np.random.default_rng([seed, 1])
    number = 0
    while number < count:
        inner, pin, pins = rng.uniform(0.5, 0.9), rng.uniform(0.2, 0.5), rng.integers(2, 5)
        off = rng.uniform(-1, 1, pins) * (0.88 - pin) * DIAMETER / 2.0 * rng.integers(0, 2, pins)
        nu = float(rng.uniform(0.2, 0.45))
        places = np.cumsum(np.r_[0.0, rng.uniform(2.0, 8.0, pins - 1) * DIAMETER * max(pin, 0.5)])
        fill, fills = _fill(rng, inner, pin)
        overhang = rng.uniform(0.8, 1.5) * pin * DIAMETER
        out = number % 3 == 0
        wrenches = rng.normal(size=(pins, 6)) * [1.0, 1.0, 0.4 * out, 2.0 * out, 2.0 * out, 0.0] * FORCE
        if fill == "bushed":
            off = off * 0.0
        sizes: dict[str, Any] = {"outer_diameter": DIAMETER, "inner_diameter": inner * DIAMETER, "overhang": overhang}
        part = Tube.model_validate(
            {"shape": "tube", "material": "any", "eyes": "none"}
            | {name: f"{size:.4f} mm" for name, size in (sizes | fills).items()}
        )
        at = [(round(float(x), 4), round(float(y), 4)) for x, y in zip(places, off, strict=True)]
        body = Body(
            part=part,
            pins=tuple(
                Pin(name=name, x=x, y=y, diameter=round(pin * DIAMETER, 4))
                for name, (x, y) in zip("ABCD", at, strict=False)
            ),
            ends=(),
            holes=(),
        )
        try:
            check_body(body)
        except CaseError:
            continue
        number += 1
        brittle = bool(judged.random() < 0.5)
        accuracy, limit = float(judged.choice([0.2, 0.1, 0.05, 0.03])), float(np.exp(judged.uniform(-1.2, 1.2)))
        yield Drawn(
            name=f"{number} tube, {fill}, " + ("out of the plane" if out else "in the plane"),
            kind=KIND,
            body=body,
            loads=_balanced(body, wrenches),
            nu=nu,
            brittle=brittle,
            accuracy=accuracy,
            limit=limit,
        )


def _fill(rng: np.random.Generator, inner: float, pin: float) -> tuple[str, dict[str, float]]:
    """Draw what is in the bore: nothing three times of five."""
    plug, choice = rng.uniform(1.0, 2.0) * DIAMETER, int(rng.integers(0, 5))
    if choice == 3:
        return "plugged", {"plug_length": plug, "fillet_radius": 0.05 * inner * DIAMETER}
    if choice == 4 and 1.25 * pin < 0.8 * inner:
        return "bushed", {"bush_diameter": 1.25 * pin * DIAMETER, "fillet_radius": 0.15}
    return "open", {}


def _balanced(body: Body, wrenches: np.ndarray) -> LinkLoads:
    """Balance the drawn wrenches by the force on the last pin and its torque about x, and by A's forces across."""
    centres = np.array([[pin.x, pin.y, 0.0] for pin in body.pins])

    def resultant(pin: int, wrench: np.ndarray) -> np.ndarray:
        return np.r_[wrench[:3], wrench[3:] + np.cross(centres[pin], wrench[:3])]

    last, unit = len(body.pins) - 1, np.eye(6)
    free = [(last, 0), (last, 1), (last, 2), (0, 1), (0, 2), (last, 3)]
    matrix = np.array([resultant(pin, unit[row]) for pin, row in free]).T
    missing = -sum(resultant(pin, wrench) for pin, wrench in enumerate(wrenches))
    for (pin, row), value in zip(free, np.linalg.solve(matrix, missing), strict=True):
        wrenches[pin, row] += value
    return LinkLoads(
        name="random",
        pins=tuple(
            PinLoad(name=pin.name, centre=centre, diameter=pin.diameter, wrench=wrench)
            for pin, centre, wrench in zip(body.pins, centres, wrenches, strict=True)
        ),
    )


def main() -> None:
    """Print what each tube's bands are after every mesh beside the truth, and count those that hold."""
    from benchmarks.coverage import series, true_peaks
    from benchmarks.coverage_table import HEADER, judged, rows

    seed, count = map(int, sys.argv[1:])
    links, found, known = [], {}, {}
    for link in drawn_tubes(seed, count):
        links.append(link)
        try:
            found[link.name], known[link.name] = series(link), true_peaks(link)
        except AlulaError as error:
            print(f"{link.name}: {error}")
            continue
        missed = {one.status for one in judged([link], found, known)[0] if not one.held}
        print(f"{link.name}: truth {known[link.name]}, missed by {', '.join(sorted(missed)) or 'none'}", flush=True)
    bands, left = judged(links, found, known)
    print(HEADER + "".join(rows(f"seed {seed}", bands)), left)


if __name__ == "__main__":
    main()
