"""Measures how far solids of links lie from the plain beam, against the bounds of ``fea/frame/displacement_band.py``.

    python -m benchmarks.displacement_band [SEED [COUNT]]
    python -m benchmarks.displacement_band solids [SEED [COUNT]]

Random bars and tubes, clamped at one bore and pulled, bent in the plane and bent out of it at another, under every pin
pressure and torque transfer: the bores' mean motion apart, and what the load's work makes of it. Links that were drawn
like these, but none of these, set the constants. Prints each link and how many lie within their band.

With ``solids``: bands of one coarse mesh by virtual work (``fea/solid/virtual_work.py``) against values of a fine one.
"""

import random
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from alula.fea.common.band import Band
from alula.fea.common.link_loads import DriveCouple, LinkLoads, PinLoad
from alula.fea.frame.displacement_band import bore_gives, bounds, zones
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support
from alula.fea.refine.level import level_of
from alula.fea.refine.link_series import precision
from alula.fea.solid.solution import SolidSolution, solve_solid
from alula.fea.solid.virtual_work import virtual_work
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.meshing.mesh import MeshSettings, mesh_body
from alula.geometry.parts.part import Bar, Body, HoleRow, Pin, Tube

FORCE = 100.0
WAYS = {0: "pulled", 1: "bent", 2: "bent out of the plane"}
SIZE = 10.0
"""Width of all sections [mm]: ratios depend on proportions alone."""
YOUNG = 2000.0


@dataclass(frozen=True, kw_only=True)
class Link:
    """A link clamped at its first bore and loaded at its last, in N and mm."""

    body: Body
    young: float
    poisson: float

    @property
    def length(self) -> float:
        """Distance of the two bores [mm]."""
        return self.body.pins[-1].x

    def frame(self, direction: int, force: float) -> FrameSolution:
        """Return the plain beam under a force at its end."""
        xs = [pin.x for pin in self.body.pins]
        section = self.body.part.section
        return solve_frame(
            FrameModel(
                nodes=np.array([[x, 0.0, 0.0] for x in xs]),
                elements=tuple(
                    FrameElement(nodes=(i, i + 1), section=section, young=self.young, poisson=self.poisson)
                    for i in range(len(xs) - 1)
                ),
                supports=(Support(node=0),),
                loads=(NodeLoad(node=len(xs) - 1, wrench=force * np.eye(6)[direction]),),
            )
        )

    def band(self, direction: int) -> tuple[float, float, float]:
        """Displacement of the plain beam, and its bounds [mm]."""
        loaded, pins = self.frame(direction, FORCE), self.body.pins
        gives = bore_gives(self.body, self.young, self.poisson)
        found = bounds(
            loaded,
            self.frame(direction, 1.0),
            {i: zones(self.body, pins[i].x, pins[i + 1].x) for i in range(len(pins) - 1)},
            [(i, gives[pin.name]) for i, pin in enumerate(pins)],
        )
        return found.value, found.low, found.high

    def loads(self, direction: int) -> LinkLoads:
        """Force at the last bore, balanced at the first."""
        force = FORCE * np.eye(3)[direction]
        moment = np.cross([self.length, 0.0, 0.0], force)
        wrenches = [np.zeros(6) for _ in self.body.pins]
        wrenches[0] = np.array([*-force, *-moment[:2], 0.0])
        wrenches[-1] = np.array([*force, 0.0, 0.0, 0.0])
        return LinkLoads(
            name=WAYS[direction],
            pins=tuple(
                PinLoad(name=pin.name, centre=np.array([pin.x, 0.0, 0.0]), diameter=pin.diameter, wrench=wrench)
                for pin, wrench in zip(self.body.pins, wrenches, strict=True)
            ),
            couples=(DriveCouple(pin=self.body.pins[0].name, torque=-moment[2]),) if moment[2] else (),
        )

    def solids(self, directions: tuple[int, ...], size: float) -> dict[int, list[float]]:
        """Direction -> displacements by each pin pressure and transfer [mm], on meshes of a size."""
        ends = self.body.pins[0], self.body.pins[-1]
        solution: SolidSolution = solve_solid(
            mesh_body(self.body, MeshSettings().scaled(size)),
            E=self.young,
            nu=self.poisson,
            density=1e-9,
            loads=[self.loads(direction) for direction in directions],
            line=(f"bore:{ends[0].name}", f"bore:{ends[1].name}"),
            threads=1,
        )
        found: dict[int, list[float]] = {direction: [] for direction in directions}
        for case in solution.cases:
            a, b = (_motion(solution.space.nodes, case.displacement, pin) for pin in ends)
            apart = b[:3] - a[:3] - np.cross(a[3:], [self.length, 0.0, 0.0])
            direction = next(k for k, name in WAYS.items() if name == case.load)
            found[direction] += [float(apart[direction]), 2.0 * case.strain_energy / FORCE]
        return found

    def by_virtual_work(self, size: float) -> dict[int, Band]:
        """Direction in the plane -> displacement on one mesh of a size, in its band [mm]."""
        ends, body = (self.body.pins[0], self.body.pins[-1]), self.body
        cases = [replace(self.loads(direction), name=WAYS[direction]) for direction in (0, 1)]
        mesh = mesh_body(body, MeshSettings().scaled(size))
        solution = solve_solid(
            mesh,
            E=self.young,
            nu=self.poisson,
            density=1e-9,
            loads=cases,
            line=(f"bore:{ends[0].name}", f"bore:{ends[1].name}"),
            threads=1,
        )
        found = precision([level_of(solution, mesh.volume)], (), section=body.part.size, eyes=())
        bands = {}
        for direction, loads in enumerate(cases):
            index = max(
                one.displacement.index
                for one, case in zip(found, solution.cases, strict=True)
                if case.load == loads.name
            )
            (work,) = virtual_work(solution, loads, [loads], transfer="eye-faces", error=index)
            bands[direction] = work.band().times(1.0 / FORCE)
        return bands


def _motion(nodes: np.ndarray, moved: np.ndarray, pin: Pin) -> np.ndarray:
    """Rigid motion (6,) about a bore's middle that is nearest to that of its nodes."""
    on = np.abs(np.hypot(nodes[:, 0] - pin.x, nodes[:, 1]) - pin.diameter / 2.0) < 2e-3 * pin.diameter
    arms = nodes[on] - np.array([pin.x, 0.0, 0.0])
    rows = np.zeros((3 * len(arms), 6))
    for k in range(3):
        rows[k::3, k] = 1.0
        rows[:, 3 + k] = np.cross(np.eye(3)[k], arms).ravel()
    return np.asarray(np.linalg.lstsq(rows, moved[on].ravel(), rcond=None)[0])


def links(seed: int) -> Iterator[Link]:
    """Random links that can be built, bars and tubes in turn, some with a pin between and rows of holes."""
    rng, number = random.Random(seed), 0
    while True:
        number += 1
        yield _link(rng, tube=number % 2 == 0)


def _link(rng: random.Random, *, tube: bool) -> Link:
    while True:
        poisson, fillet = rng.uniform(0.28, 0.42), rng.uniform(0.08, 0.3)
        eye = rng.uniform(1.35, 2.2) if tube else rng.uniform(1.03, 1.8)
        length = rng.uniform(eye + 2.0 * fillet + 0.8, 18.0)
        shape = {"material": "any", "eye_diameter": _mm(eye), "fillet_radius": _mm(fillet)}
        part: Bar | Tube
        if tube:
            sizes = {
                "outer_diameter": _mm(1.0),
                "inner_diameter": _mm(rng.choice([0.0, rng.uniform(0.3, 0.8)])),
                "eye_thickness": _mm(max(rng.uniform(1.3, 1.9), 1.001 + 2.1 * fillet)),
            }
            part = Tube.model_validate({"shape": "tube"} | shape | sizes)
        else:
            thick = _mm(rng.uniform(0.2, 1.0))
            sizes = {"width": _mm(1.0), "thickness": thick, "eye_thickness": thick}
            part = Bar.model_validate({"shape": "bar"} | shape | sizes)
        places = [0.0, length]
        if length > 8.0 and rng.random() < 0.4:
            places.insert(1, rng.uniform(0.35, 0.65) * length)
        hole = rng.uniform(0.2, 0.6) * eye * SIZE
        pins = tuple(Pin(name=n, x=x * SIZE, y=0.0, diameter=hole) for n, x in zip("ABC", places, strict=False))
        row = _row(rng, places[1], eye / 2.0 + fillet + 0.7, tube or part.section.half_z > 3.5)
        body = Body(part=part, pins=pins, ends=(), holes=row if rng.random() < 0.5 else ())
        try:
            check_body(body)
        except CaseError:
            continue
        return Link(body=body, young=YOUNG, poisson=poisson)


def _mm(widths: float) -> str:
    return f"{widths * SIZE:.6g} mm"


def _row(rng: random.Random, gap: float, reach: float, thick: bool) -> tuple[HoleRow, ...]:
    """Return a row of up to eight cross holes between two pins, as many as there is room for."""
    hole = rng.uniform(0.15, 0.35)
    count = min(8, int((gap - 2.0 * reach) / (1.6 * hole)))
    if count < 2:
        return ()
    along = rng.choice("yz") if thick else "z"
    entry = {"count": count, "diameter": _mm(hole), "first": _mm(reach), "last": _mm(gap - reach), "along": along}
    return (HoleRow.model_validate(entry),)


def main(seed: int = 5, count: int = 20) -> None:
    """Measure ``count`` links of a seed and print how many displacements lie in their bands."""
    inside = total = 0
    for number, link in zip(range(count), links(seed), strict=False):
        try:
            solids = link.solids((0, 1, 2), 1.6)
        except (CannotRunError, CaseError) as error:
            print(f"link {number} is left out: {error}")
            continue
        for direction, found in solids.items():
            plain, low, high = link.band(direction)
            held = low <= min(found) and max(found) <= high
            inside, total = inside + held, total + 1
            print(
                f"{link.body.part.shape} {number} {WAYS[direction]}: solid {min(found) / plain:.3f} to "
                f"{max(found) / plain:.3f} of the plain beam, band {low / plain:.3f} to {high / plain:.3f}"
                f"{'' if held else ', outside'}",
                flush=True,
            )
    print(f"{inside} of {total} displacements lie in their bands")


def solids(seed: int = 5, count: int = 12) -> None:
    """Measure how many bands of one coarse mesh hold the mean motions of a fine one, and how wide they are."""
    inside, widths = 0, []
    for number, link in zip(range(count), links(seed), strict=False):
        try:
            coarse, fine = (link.by_virtual_work(size) for size in (3.0, 1.2))
        except (CannotRunError, CaseError) as error:
            print(f"link {number} is left out: {error}")
            continue
        for direction, band in coarse.items():
            truth = fine[direction]
            held = band.low <= truth.value <= band.high
            inside, widths = inside + held, [*widths, (band.high - band.low) / truth.value]
            print(
                f"{link.body.part.shape} {number} {WAYS[direction]}: coarse {band.value / truth.value:.4f} of the fine "
                f"mesh's, band {band.low / truth.value:.4f} to {band.high / truth.value:.4f}, the fine mesh's band "
                f"{truth.low / truth.value:.4f} to {truth.high / truth.value:.4f}{'' if held else ', outside'}",
                flush=True,
            )
    print(f"{inside} of {len(widths)} bands hold the fine mesh's value; median width {np.median(widths):.1%}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["solids"]:
        solids(*map(int, sys.argv[2:]))
    else:
        main(*map(int, sys.argv[1:]))
