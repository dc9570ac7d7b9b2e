"""Measures how solid models of links compare with hand calculation; writes the factors of ``fea/calibration.toml``.

    python -m benchmarks.calibration             solve every solid, keep what they say, and compare
    python -m benchmarks.calibration estimates   compare the solids that were kept with the estimates of today

What the solids say is kept in ``benchmarks/results/calibration.json``, so that a better estimate needs no new solid.
Every part is solved on one moderate mesh under some twenty load cases with every pin pressure and torque transfer.
The largest von Mises and principal stress at each critical location (``alula.fea.beam.critical_locations``) is divided
by the estimate there.
"""

import json
import math
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from alula.fea.beam.calibration import proportions
from alula.fea.beam.critical_locations import critical_locations, displacement_estimate
from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import BeamCheck, check_beam
from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.geometry.bodies.eyes import RIM
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.geometry.parts.part import Bar, Body, HoleRow, Pin, PlainEnd, Tube
from alula.reports.sentences import told
from benchmarks.record import RESULTS, circumstances

FILE = Path(__file__).resolve().parents[1] / "fea" / "calibration.toml"
KEPT = RESULTS / "calibration.json"
SETTINGS = MeshSettings(size=0.45, bore_elements=14, hole_elements=8, turn_elements=8, fillet_size=0.9, growth=0.8)
YOUNG = 2400.0
MARGIN = 1.15
"""By which the measured least and largest factors are widened: one mesh, and few parts."""
BEARS = 0.3
"""A location counts where it bears at least this share of the link's peak, by the solid or by hand."""
BEARS_AT_AN_END = 0.05
"""The same for loaded ends, which never bear much."""

# inner, eye, eye thickness, fillet, pin and hole diameters, over the outer diameter; Poisson's ratio; hole spacing
TUBES = (
    (0.5, 1.6, 1.4, 0.16, 0.3, 0.2, 0.38),
    (0.0, 2.0, 1.75, 0.2, 0.375, 0.25, 0.3),
    (0.75, 1.4, 1.3, 0.1, 0.25, 0.15, 0.34),
    (0.3, 1.4, 1.6, 0.25, 0.5, 0.3, 0.42),
    (0.65, 2.0, 1.4, 0.1, 0.55, 0.3, 0.28),
    (0.75, 1.8, 1.75, 0.25, 0.25, 0.3, 0.4),
    (0.0, 1.4, 1.3, 0.1, 0.5, 0.15, 0.4),
    (0.5, 1.6, 1.4, 0.16, 0.3, 0.2, 0.38),
)
# thickness, eye, fillet, pin, hole over the width
BARS = (
    (0.5, 1.5, 0.25, 0.375, 0.25, 0.33),
    (0.83, 1.39, 0.11, 0.556, 0.2, 0.4),
    (0.5, 1.3, 0.2, 0.3, 0.15, 0.33),
    (1.0, 1.6, 0.15, 0.45, 0.25, 0.28),
    (0.4, 1.6, 0.11, 0.6, 0.15, 0.42),
    (1.0, 1.3, 0.3, 0.3, 0.2, 0.38),
    (0.7, 1.4, 0.2, 0.68, 0.2, 0.36),
)
LINKS = ((0.0, 9.0, 15.0, 21.0), (0.0, 4.0, 9.0, 13.0), (0.0, 14.0, 18.0, 30.0))
"""Pins at the first three and a plain end at the last, in widths; the parts take them in turn."""
SIZE = 10.0
"""Width of all sections [mm]: factors depend on proportions alone."""
GAP = 0.7
"""Least distance of holes from eyes, in widths."""
GAP_AT_AN_END = 0.4
"""The same from the loaded patch of an end."""


def bodies(shape: str) -> Iterator[tuple[Body, float]]:
    """Parts and their Poisson's ratios."""
    for number, row in enumerate(TUBES if shape == "tube" else BARS):
        if shape == "tube":
            inner, eye, thick, fillet, pin, hole, nu = row
            part: Tube | Bar = Tube.model_validate(
                {
                    "shape": "tube",
                    "material": "any",
                    "outer_diameter": _mm(1.0),
                    "inner_diameter": _mm(inner),
                    "eye_diameter": _mm(eye),
                    "eye_thickness": _mm(max(thick, 1.0 + RIM * fillet)),
                    "fillet_radius": _mm(fillet),
                }
            )
        else:
            thick, eye, fillet, pin, hole, nu = row
            part = Bar.model_validate(
                {
                    "shape": "bar",
                    "material": "any",
                    "width": _mm(1.0),
                    "thickness": _mm(thick),
                    "eye_diameter": _mm(eye),
                    "eye_thickness": _mm(thick),
                    "fillet_radius": _mm(fillet),
                }
            )
        a, b, c, end = LINKS[number % len(LINKS)]
        off = eye / 2.0 + fillet + hole / 2.0 + GAP
        patch = 0.8 + 0.4 * (number % 3)
        near = GAP_AT_AN_END + hole / 2.0 + patch
        rows = [_row(hole, a + off, b - off, "y"), _row(hole, min(c + off, end - near), end - near, "y")]
        if c - b > 2.0 * off:
            rows.append(_row(hole, (b + c) / 2.0, (b + c) / 2.0, "z"))
        rows = [r for r in rows if shape == "tube" or r.along == "z" or hole < 0.6 * thick]
        yield (
            Body(
                part=part,
                pins=tuple(
                    Pin(name=n, x=x * SIZE, y=0.0, diameter=pin * SIZE) for n, x in (("A", a), ("B", b), ("C", c))
                ),
                ends=(PlainEnd(name="H", x=end * SIZE, patch=patch * SIZE),),
                holes=tuple(rows),
            ),
            nu,
        )


def _mm(widths: float) -> str:
    return f"{widths * SIZE:.6g} mm"


def _row(hole: float, first: float, last: float, along: str) -> HoleRow:
    count = 2 if last > first + hole + GAP else 1
    return HoleRow.model_validate(
        {"count": count, "diameter": _mm(hole), "first": _mm(first), "last": _mm(max(first, last)), "along": along}
    )


def load_cases(body: Body) -> Iterator[LinkLoads]:
    """Balanced load cases: pulls, bending in and out of the plane, torques, the drive's couple, and mixtures."""
    a, b, c = (np.array([p.x, 0.0, 0.0]) for p in body.pins)
    h = np.array([body.ends[0].x, 0.0, 0.0])
    unit, length = 100.0, float(c[0])
    ex, ey, ez = np.eye(3)

    def case(name, forces, moments=None, end=None, couple=0.0):
        """Forces at pins by name; the rest is balanced by pins A and C in the plane, C alone along x."""
        wrenches = {p.name: np.zeros(6) for p in body.pins}
        for pin, force in forces.items():
            wrenches[pin][:3] += force
        for pin, moment in (moments or {}).items():
            wrenches[pin][3:] += moment
        places = {"A": a, "B": b, "C": c}
        force = sum((w[:3] for w in wrenches.values()), np.zeros(3))
        moment = sum((np.cross(places[n], w[:3]) + w[3:] for n, w in wrenches.items()), np.zeros(3))
        moment = moment + couple * ez
        if end is not None:
            force, moment = force + end[:3], moment + np.cross(h, end[:3]) + end[3:]
        # moment about A: C takes ey, ez forces; the torque about x goes to A
        at_c = np.array([0.0, -moment[2] / length, moment[1] / length])
        wrenches["C"][:3] += at_c
        wrenches["A"][:3] -= force + at_c
        wrenches["A"][3] -= moment[0]
        return LinkLoads(
            name=name,
            pins=tuple(
                PinLoad(name=p.name, centre=places[p.name], diameter=p.diameter, wrench=wrenches[p.name])
                for p in body.pins
            ),
            couples=(DriveCouple(pin="A", torque=couple),) if couple else (),
            ends=(EndLoad(name="H", point=h, wrench=np.asarray(end)),) if end is not None else (),
        )

    yield case("pull", {"C": unit * ex})
    yield case("push", {"C": -unit * ex})
    yield case("pull to B", {"B": unit * ex})
    yield case("push from B", {"B": -unit * ex})
    yield case("bend by B", {"B": unit * ey})
    yield case("bend and pull", {"B": unit * ey, "C": 3.0 * unit * ex})
    yield case("bend and push", {"B": 0.3 * unit * (ey - ex), "C": -3.0 * unit * ex})
    yield case("slanted", {"B": unit * (ey + 2.0 * ex), "C": -unit * ex})
    yield case("tip in the plane", {}, end=np.array([0, unit, 0, 0, 0, 0.0]))
    yield case("tip in the plane and pull", {"B": 2 * unit * ex}, end=np.array([unit, -unit, 0, 0, 0, 0.0]))
    yield case("tip out of the plane", {}, end=np.array([0, 0, unit, 0, 0, 0.0]))
    yield case("tip slanted", {"B": unit * ex}, end=np.array([0, unit, unit / 2, 0, 0, 0.0]))
    yield case("twisted tip", {}, end=np.array([0, 0, 0, unit * 10, 0, 0.0]))
    yield case("twist between pins", {}, {"C": 10 * unit * ex})
    yield case("twist and bend", {"B": 0.5 * unit * ey}, {"C": 10 * unit * ex})
    yield case("out of the plane with moments", {}, {"C": 10 * unit * ey, "A": -10 * unit * ey})
    yield case("drive", {}, couple=unit * 10)
    yield case("drive and pull", {"C": unit * ex}, couple=unit * 10)
    yield case("drive onto the tip", {"B": unit * ex}, end=np.array([0, unit, 0, 0, 0, 0.0]), couple=-h[0] * unit)
    yield case("drive by B", {"B": 5 * unit * ey + unit * ex}, couple=-b[0] * unit * 5)


def solids(body: Body, nu: float) -> dict[str, dict[str, list[float]]]:
    """What the solid model alone says: load case -> location -> its share of the peak, its least and largest stresses.

    The five numbers of a location are the largest share over the variants, then least and largest von Mises stress,
    then least and largest principal stress [MPa]; those of "displacement" least and largest [mm].
    """
    mesh = mesh_body(body, SETTINGS)
    cases = list(load_cases(body))
    line = ("bore:A", "bore:C")
    solution = solve_solid(mesh, E=YOUNG, nu=nu, density=1e-9, loads=cases, line=line, threads=1)
    print(len(mesh.cells), "elements", flush=True)
    nodes = solution.space.nodes
    kept: dict[str, dict[str, list[float]]] = {}
    for loads in cases:
        found = [s for s in solution.cases if s.load == loads.name]
        moved = [float(s.displacement_max) for s in found]
        row = kept[loads.name] = {"displacement": _rounded(min(moved), max(moved))}
        fields = [stress_field(solution.space, s.displacement, E=YOUNG, nu=nu) for s in found]
        peaks = [f.von_mises.max() for f in fields]
        other = np.ones(len(nodes), dtype=bool)
        for location in critical_locations(body, loads.chosen(None), _beam(body, loads, nu).forces.state(None), nu):
            near = (nodes[:, 0] >= location.low) & (nodes[:, 0] <= location.high)
            inside = other if location.kind == "section" else near
            other = other & ~inside
            von = [float(f.von_mises[inside].max()) for f in fields]
            first = [float(f.principal[inside, 0].max()) for f in fields]
            share = max(v / p for v, p in zip(von, peaks, strict=True))
            row[told(location.name)] = _rounded(share, min(von), max(von), min(first), max(first))
    return kept


def compare(body: Body, nu: float, kept: dict[str, dict[str, list[float]]]) -> list[dict]:
    """Every location of every load case: its share of the peak, and least and largest ratio of solid to estimate."""
    rows = []
    for loads in load_cases(body):
        beam, solid = _beam(body, loads, nu), kept[loads.name]
        places = [
            location
            for location in critical_locations(body, loads.chosen(None), beam.forces.state(None), nu)
            if location.estimate > 0.0
        ]
        hand = max(location.estimate for location in places)
        line = (body.pins[0].x, body.pins[-1].x)
        acting, forces = loads.chosen(None), beam.forces.state(None)
        (moved,) = displacement_estimate(body, acting, forces, beam.section, young=YOUNG, poisson=nu, line=line)
        of_all = {"case": loads.name, "kind": "displacement", "share": 1.0, "by_hand": 1.0}
        rows.append(of_all | {"von_mises": [value / moved for value in solid["displacement"]]})
        for location in places:
            share, *stresses = solid[told(location.name)]
            ratios = [value / location.estimate for value in stresses]
            row = {"case": loads.name, "kind": location.kind, "share": share, "by_hand": location.estimate / hand}
            rows.append(row | {"von_mises": ratios[:2], "principal": ratios[2:]})
    return rows


def _beam(body: Body, loads: LinkLoads, nu: float) -> BeamCheck:
    return check_beam(beam_loads(loads, body, 1e-9), body.part.section, 1.0, nu)


def _rounded(*values: float) -> list[float]:
    return [float(f"{value:.5g}") for value in values]


def factors(rows: list[dict], quantity: str) -> list[float]:
    """Least, median and largest ratio of the locations that bear, the outer two widened by the margin."""
    bears = BEARS_AT_AN_END if rows[0]["kind"] == "end" else BEARS
    borne = [r for r in rows if r["share"] >= bears]
    by_hand = [r for r in rows if r["by_hand"] >= bears]
    least = min(min(r[quantity]) for r in by_hand)
    most = max(max(r[quantity]) for r in borne)
    middle = float(np.clip(np.median([max(r[quantity]) for r in borne]), least, most))
    return [_down(max(least, 0.0) / MARGIN), round(middle, 3), _up(most * MARGIN)]


def _down(value: float) -> float:
    return math.floor(1000.0 * value) / 1000.0


def _up(value: float) -> float:
    return math.ceil(1000.0 * value) / 1000.0


def table(shape: str, date: str, found: list[dict]) -> str:
    """Return one shape's measurements, by parts, as TOML."""
    rows = [row for part in found for row in part["rows"]]
    ratios = [part["proportions"] for part in found]
    lines = [
        f"[{shape}]",
        f'measured = "{date}"',
        f"parts = {len(ratios)}",
        f"cases = {len({(number, r['case']) for number, part in enumerate(found) for r in part['rows']})}",
        f"margin = {MARGIN}",
        f"displacement = {factors([r for r in rows if r['kind'] == 'displacement'], 'von_mises')}",
        f"[{shape}.ranges]",
    ]
    for name in dict.fromkeys(name for ratio in ratios for name in ratio):
        values = [ratio[name] for ratio in ratios if name in ratio]
        high = "inf" if name.startswith("gap") else f"{_up(max(values))}"
        lines.append(f'"{name}" = [{_down(min(values))}, {high}]')
    for quantity in ("von_mises", "principal"):
        lines.append(f"[{shape}.{quantity}]")
        lines += [
            f"{kind} = {factors([r for r in rows if r['kind'] == kind], quantity)}"
            for kind in ("eye", "hole", "end", "section")
        ]
    return "\n".join(lines) + "\n"


HEADER = """\
# Largest stress and displacement of solids over the estimates of hand calculation (fea/beam/critical_locations.py):
# [least, median, largest] per kind of place, the outer two widened by the margin; and the proportions measured.
# Written by benchmarks/calibration.py; do not edit.

"""


SHAPES = {"tube": TUBES, "bar": BARS}


def written(kept: dict[str, dict]) -> str:
    """Return the whole table: the solids that were kept over the estimates of today."""
    tables = []
    for shape, parts in SHAPES.items():
        found = []
        for number, (body, nu) in enumerate(bodies(shape)):
            part = kept[shape]["parts"][number]
            if tuple(part["proportions"]) != parts[number]:
                raise SystemExit(f"{shape} {number} was solved with other proportions; solve every solid again")
            found.append({"proportions": proportions(body, nu), "rows": compare(body, nu, part["solid"])})
        tables.append(table(shape, kept["date"][:10], found))
    return HEADER + "\n".join(tables)


def main() -> None:
    """Measure every part of both shapes, or take what was kept, and write the table."""
    if sys.argv[1:] == ["estimates"]:
        kept = json.loads(KEPT.read_text())
    else:
        kept = circumstances("calibration")
        for shape, parts in SHAPES.items():
            kept[shape] = {"parts": []}
            for number, (body, nu) in enumerate(bodies(shape)):
                print(f"{shape} {number}: ", end="", flush=True)
                kept[shape]["parts"].append({"proportions": parts[number], "solid": solids(body, nu)})
        KEPT.write_text(json.dumps(kept, indent=None, separators=(",", ":")).replace('},"', '},\n"') + "\n")
    FILE.write_text(written(kept))


if __name__ == "__main__":
    main()
