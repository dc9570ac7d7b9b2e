"""Clearances drawn at random against the bands of what they were drawn from, over random linkages in layers.

    python -m benchmarks.draws [--linkages 20] [--draws 10000] [--first 0] [--cases six-bar ...]

Each linkage has four, six or eight links in layers of their own; of each hole is stated a range of its clearance, a
press, one range for both of a joint's holes, a fit, or nothing. Each draw takes a clearance for every hole from what is
stated of it, at its ends as often as between them. Told are the draws outside the bands: of thrusts, of pins' stress,
of links' stress by hand, of the displacement of a point, and of the lowest frequency.

Of built-in cases the draws are of the clearances that these state, and told is how far they spread as well: by what a
band is wider the search is not sharp, the rest is what pins do that stand anywhere in such holes.
"""

import argparse
import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.verdict import Quantity
from alula.fea.doubts.force_doubt import sharing_answers
from alula.fea.frame.build import build_frame
from alula.fea.links.link_by_hand import HandStates, on_plates
from alula.fea.links.second_order import on_tilting_pins
from alula.fea.outcomes.pins import shared_stress, stresses_between
from alula.fea.pins.states import PinStates, unstated
from alula.fea.standing.case_statics import CaseStatics, solve_case_statics
from alula.fea.standing.thrust import thrusts
from alula.fea.vibration.linkage_modes import LinkageModes, linkage_modes, on_rims
from alula.loads.case.case import Case
from alula.loads.case.case_file import built_in_cases, read_case, validate
from alula.loads.states.actions import acting_loads, placed
from alula.loads.states.masses import part_masses
from benchmarks.record import save

Real = NDArray[np.float64]
BY_COUPLES = 1.5
"""Ratio of its ends from which on a band is told beside the spread of its draws."""
SAME = 2e-3
"""Share of a band's larger end by which a draw may lie outside without being told."""
TRIED = 5
"""Draws that are looked at: so many in which an end of a link's beam bears most, and in which the link bears least."""
VIBRATING = 20
"""Draws of which the frequency is found."""


def linkage(seed: int) -> Case:
    """Return a random linkage in layers: a four-bar, with up to two dyads more, under a force at its last link.

    Parameters
    ----------
    seed : int

    Returns
    -------
    Case
    """
    return validate(tables(seed))


def tables(seed: int) -> dict[str, Any]:
    """Return the tables of a random linkage.

    Parameters
    ----------
    seed : int

    Returns
    -------
    dict
    """
    draw = np.random.default_rng(seed)
    dyads = int(draw.integers(3))
    a, angle = float(draw.uniform(25, 40)), math.radians(draw.uniform(40, 110))
    places = {"O2": 0j, "A": cmath.rect(a, angle), "O4": complex(draw.uniform(90, 110), draw.uniform(-10, 10))}
    places["B"] = places["O4"] + cmath.rect(draw.uniform(60, 80), math.radians(draw.uniform(75, 120)))
    chains = {"crank": ["O2", "A"], "coupler": ["A", "B"], "rocker": ["O4", "B", "P"]}
    joints = {"O2": ("base", "crank"), "A": ("crank", "coupler"), "B": ("coupler", "rocker"), "O4": ("base", "rocker")}
    rocker = places["B"] - places["O4"]
    places["P"] = places["O4"] + rocker * draw.uniform(1.4, 1.6)
    ground, last, tip = ["O2", "O4"], "rocker", "P"
    layers = {"base": 0, "crank": 1, "coupler": int(draw.choice([2, 0])), "rocker": 1}
    for k in range(dyads):
        one, other, foot, knee, end = (f"{name}{k}" for name in ("rod", "arm", "F", "K", "T"))
        places[foot] = places[tip] + complex(draw.uniform(60, 90), draw.uniform(-60, -30))
        places[knee] = places[tip] + complex(draw.uniform(40, 70), draw.uniform(10, 40))
        places[end] = places[foot] + (places[knee] - places[foot]) * draw.uniform(1.35, 1.6)
        chains |= {one: [tip, knee], other: [foot, knee, end]}
        joints |= {tip: (last, one), knee: (one, other), foot: ("base", other)}
        layers[one] = layers[last] + int(draw.choice([-1, 1]))
        layers[other] = layers[one] + (1 if layers[one] != -1 else -1)
        ground, last, tip = [*ground, foot], other, end
    data = _tables(draw, places, chains, joints, layers, ground)
    turn = draw.uniform(0.0, 2.0 * math.pi)
    force = cmath.rect(draw.uniform(2.0, 20.0), turn)
    data["load_cases"] = {"l": {"forces": [{"link": last, "at": tip, "force": [f"{force.real} N", f"{force.imag} N"]}]}}
    data["checks"] = {"point": {"type": "displacement", "link": last, "at": tip, "maximum": "1 mm"}}
    return {"schema_version": 1, "title": f"linkage {seed}", "large_displacement": "off", **data}


def _tables(
    draw: np.random.Generator,
    places: Mapping[str, complex],
    chains: Mapping[str, list[str]],
    joints: Mapping[str, tuple[str, str]],
    layers: Mapping[str, int],
    ground: list[str],
) -> dict[str, Any]:
    def mm(x: float) -> str:
        return f"{float(x)!r} mm"

    links: dict[str, Any] = {
        "base": {"ground": True, "layer": 0, "points": {n: [mm(places[n].real), mm(places[n].imag)] for n in ground}}
    }
    links["base"] |= {"thickness": "5 mm"} if draw.integers(2) else {}
    near = {}
    for name, points in chains.items():
        first, along = places[points[0]], places[points[1]] - places[points[0]]
        own = {p: [mm(abs(places[p] - first)), "0 mm"] for p in points}
        links[name] = {"part": "bar", "layer": layers[name], "points": own}
        near[name] = f"{cmath.phase(along)!r} rad"
    stated: dict[str, Any] = {}
    for name, pair in joints.items():
        d = float(draw.uniform(2.5, 4.0))
        stated[name] = {"links": list(pair), "pin_diameter": mm(d)}
        ends = sorted(d * 10.0 ** draw.uniform(-3.0, -1.0, 2))
        kind = draw.choice(["ranges", "press", "both", "fit", "nothing"])
        if kind == "ranges":
            pairs = zip(pair, (ends, sorted(d * 10.0 ** draw.uniform(-3.0, -1.0, 2))), strict=True)
            stated[name]["clearance"] = {link: [mm(x) for x in own] for link, own in pairs}
        elif kind == "press":
            stated[name] |= {"tight_in": pair[int(draw.integers(2))], "clearance": [mm(x) for x in ends]}
        elif kind == "both":
            stated[name]["clearance"] = [mm(x) for x in ends]
        elif kind == "fit":
            stated[name]["fit"] = dict.fromkeys(pair, str(draw.choice(["H8/f7", "H9/d9"])))
    young = 10.0 ** float(draw.uniform(3.3, 4.9))
    entries = ("youngs_modulus", "poissons_ratio", "density", "yield_strength")
    material = {"title": "drawn", "youngs_modulus": f"{young} MPa", "poissons_ratio": 0.35, "density": "1200 kg/m^3"}
    material |= {"strength": "yield", "yield_strength": "100 MPa"}
    material |= {table: dict.fromkeys(entries, "assumed") for table in ("sources", "status")}
    bar = {"shape": "bar", "material": "drawn", "width": "9 mm", "thickness": "4 mm", "fillet_radius": "2 mm"}
    crank = near.pop("crank")
    return {
        "layer_spacing": "4.6 mm",
        "links": links,
        "joints": stated,
        "pose": {"coordinate": "crank", "angle": crank, "near": near},
        "drive": {"link": "crank", "joint": "O2"},
        "parts": {"bar": bar},
        "materials": {"drawn": material},
    }


def shares(pins: PinStates, count: int, seed: int) -> Real:
    """Return shares (count, k) of what is open: evenly drawn, towards small clearances, and at the ends.

    Parameters
    ----------
    pins : PinStates
    count, seed : int

    Returns
    -------
    ndarray
    """
    draw = np.random.default_rng(seed)
    found = draw.uniform(size=(count, len(pins.radii.value)))
    kinds = draw.integers(4, size=found.shape) * (draw.uniform(size=(count, 1)) < 0.7)
    found = np.where(kinds == 1, 0.0, np.where(kinds == 2, 1.0, np.where(kinds == 3, found**6, found)))
    return np.asarray(found)


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A band, and the draws that it should hold.

    Attributes
    ----------
    of : str
        What the band is of.
    low, high : float
        Its ends.
    least, most : float
        Of the draws.
    beyond : int
        How many draws lie outside by more than ``SAME``.
    """

    of: str
    low: float
    high: float
    least: float
    most: float
    beyond: int

    @classmethod
    def of_all(cls, of: str, low: float, high: float, found: Real) -> "Drawn":
        """Compare draws with a band.

        Parameters
        ----------
        of : str
        low, high : float
        found : ndarray, shape (n,)

        Returns
        -------
        Drawn
        """
        beyond = np.maximum(found - high, low - found) > SAME * max(abs(low), abs(high))
        return cls(
            of=of, low=low, high=high, least=float(found.min()), most=float(found.max()), beyond=int(beyond.sum())
        )

    @property
    def excess(self) -> float:
        """By how much a draw lies outside at most, over the end of the band that is larger."""
        return self._left / (max(abs(self.low), abs(self.high)) or 1.0)

    @property
    def left(self) -> float:
        """The same over what lies between the ends."""
        return self._left / (self.high - self.low) if self.high > self.low else math.inf

    @property
    def _left(self) -> float:
        return max(self.most - self.high, self.low - self.least)


def outside(case: Case, count: int, seed: int = 0) -> list[Drawn]:
    """Draw clearances of a linkage and return the bands that some draw leaves.

    Parameters
    ----------
    case : Case
    count : int
        Of draws.
    seed : int, optional

    Returns
    -------
    list of Drawn
    """
    statics = solve_case_statics(case)
    pins = statics.forces["l"].pins
    if pins is None:
        return []
    v = pins.solved(shares(pins, count, seed)).v
    return [one for one in (*compared(statics, "l", v), *_points(case, statics, pins, v)) if one.beyond]


def compared(statics: CaseStatics, load_case: str, v: Real) -> Iterator[Drawn]:
    """Yield the bands of thrusts, of pins' stress and of links' stress by hand, as how pins stand makes them.

    Parameters
    ----------
    statics : CaseStatics
    load_case : str
        Its name; of a linkage whose pins stand in their holes.
    v : ndarray, shape (n, 4 h)
        Where pins stand in each draw.

    Yields
    ------
    Drawn
    """
    case, forces = statics.standing[load_case].case, statics.forces[load_case]
    pins, names = forces.pins, list(case.joints)
    assert pins is not None
    # What joints bear is affine in where pins stand.
    at_zero = _wrenches(pins, names, np.zeros(v.shape[1]))
    by_unit = np.array([_wrenches(pins, names, unit) - at_zero for unit in np.eye(v.shape[1])])
    drawn = at_zero + np.einsum("nv,vjk->njk", v, by_unit)
    thrust, by_joint = thrusts(forces), {name: drawn[:, j] for j, name in enumerate(names)}
    largest = max(
        float(np.abs(one.joints[name].wrench[:3]).max())
        for one in (forces.reactions, *forces.sharings)
        for name in names
    )
    for j, name in enumerate(names):
        if name in thrust and thrust[name].high > 1e-4 * largest:
            yield Drawn.of_all(f"thrust at {name}", thrust[name].low, thrust[name].high, np.abs(drawn[:, j, 2]))
        if case.linkage.rise(name) != 0.0 and case.joints[name].pivots:
            band = shared_stress(case, name, forces.reactions.joints, forces).equivalent
            each = np.array([one.equivalent.value for one in stresses_between(case, name, by_joint)])
            yield Drawn.of_all(f"pin at {name}", band.low, band.high, each)
    yield from _stresses(statics, load_case, v)


def _wrenches(pins: PinStates, names: list[str], v: Real) -> Real:
    found = pins.reactions(v).joints
    return np.array([found[name].wrench for name in names])


def _stresses(statics: CaseStatics, load_case: str, v: Real) -> Iterator[Drawn]:
    """Stress of links in those draws in which plain sections at the ends of their beams bear most and least."""
    case, forces, loads = statics.standing[load_case].case, statics.forces[load_case], statics.loads[load_case]
    pins = forces.pins
    assert pins is not None
    ends = pins.aims.ends
    borne, number = pins.aims.stresses(v), tuple(dict.fromkeys(ends.owners))
    for link in case.checked_links:
        own = [borne[:, k] for k, owner in enumerate(ends.owners) if owner == ("link", link)]
        if ("link", link) not in number:
            continue
        own.append(borne[:, number.index(("link", link)) - len(number)])
        chosen = {int(i) for one in own for i in np.argsort(one)[-TRIED:]}
        answers = sharing_answers(case, load_case, link, forces, loads)
        every = HandStates(case, link, answers.every).stress
        body = case.body(link)
        acting = [link_loads(load_case, link, body, pins.reactions(v[i]), loads) for i in sorted(chosen)]
        grown = [on_tilting_pins(case, link, on_plates(case, link, one)) for one in acting]
        of_draws = HandStates(case, link, grown).stress
        growth = answers.stress(every[0], every[1:])
        yield Drawn.of_all(f"stress of {link}", growth.low * every[0], growth.high * every[0], of_draws)


def _points(case: Case, statics: CaseStatics, pins: PinStates, v: Real) -> Iterator[Drawn]:
    """Displacement of the point, where all holes are stated: of others it holds running fits, not the loosest holes."""
    frame = statics.forces["l"].frame
    assert frame is not None
    if unstated(case, pins):
        return
    [check] = case.checks.values()
    node = frame.points[check.link, check.at]  # type: ignore[union-attr]
    plain = pins.answer(np.zeros(v.shape[1])).displacements[node, :3]
    by_unit = np.array([pins.answer(unit).displacements[node, :3] - plain for unit in np.eye(v.shape[1])])
    for one in check_case(case, fidelity="beam", threads=1).load_cases["l"].checks:
        if one.quantity is Quantity.DISPLACEMENT:
            moved = np.linalg.norm(plain + v @ by_unit, axis=1)
            yield Drawn.of_all("displacement", one.value.low, one.value.high, moved)


def vibrating(data: Mapping[str, Any], seed: int = 0) -> list[Drawn]:
    """Draw clearances of a linkage, state them, and return the band of its lowest frequency where a draw leaves it.

    Parameters
    ----------
    data : mapping
        Its tables.
    seed : int, optional

    Returns
    -------
    list of Drawn
    """
    case = validate(dict(data))
    pins = solve_case_statics(case).forces["l"].pins
    if pins is None:
        return []
    band = _modes(case).modes[0].frequency
    holes = [number for one in pins.radii.numbers for number in one]
    names = [hole for one in pins.radii.clearances for hole in one.holes]
    drawn = []
    for radii in pins.radii.of(shares(pins, VIBRATING, seed))[0]:
        joints = {name: dict(joint) for name, joint in data["joints"].items()}
        for joint in joints.values():
            for entry in ("clearance", "fit", "tight_in"):
                joint.pop(entry, None)
            joint["clearance"] = dict.fromkeys(joint["links"], "0 mm")
        for (joint, link), number in zip(names, holes, strict=True):
            joints[joint]["clearance"][link] = f"{2.0 * float(radii[2 * number])!r} mm"
        rims = _modes(validate({**data, "joints": joints})).rims
        drawn.append(rims.frequency.value if rims is not None and rims.frequency is not None else 0.0)
    found = Drawn.of_all("frequency", band.low, band.high, np.array(drawn))
    return [found] if found.beyond else []


def _modes(case: Case) -> LinkageModes:
    masses = part_masses(case)
    loads = acting_loads(case, case.load_cases["l"], placed(case.solve_pose(), 0.0), masses)
    frame = build_frame(case, case.solve_pose(), loads, held=case.pinned_drive)
    return on_rims(case, linkage_modes(case, "l", frame, masses), masses)


def built_in(name: str, count: int) -> tuple[list[Drawn], int]:
    """Draw clearances of a built-in case from what it states of its holes.

    Parameters
    ----------
    name : str
    count : int
        Of draws.

    Returns
    -------
    list of Drawn, int
        The bands that draws leave, or whose ends lie more than ``BY_COUPLES`` apart; and how many there are of all.
    """
    case = read_case(name)
    statics, found = solve_case_statics(case, name), list[Drawn]()
    for load_case, forces in statics.forces.items():
        if forces.pins is not None and len(forces.pins.radii.value):
            v = forces.pins.solved(shares(forces.pins, count, 0)).v
            found += [replace(one, of=f"{load_case}: {one.of}") for one in compared(statics, load_case, v)]
    return [one for one in found if one.beyond or 0.0 < one.low * BY_COUPLES < one.high], len(found)


def _kept(found: Sequence[Drawn]) -> list[dict[str, Any]]:
    return [{**vars(one), "excess": one.excess, "left": one.left} for one in found]


def main() -> None:
    """Draw, tell what lies outside, and keep it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, number in (("linkages", 20), ("draws", 10_000), ("first", 0)):
        parser.add_argument(f"--{name}", type=int, default=number)
    parser.add_argument("--cases", nargs="*", default=built_in_cases())
    asked, kept, cases = parser.parse_args(), {}, {}
    for seed in range(asked.first, asked.first + asked.linkages):
        case = linkage(seed)
        found = [*outside(case, asked.draws, seed), *vibrating(tables(seed), seed)]
        kept[seed] = {"links": len(case.links), "draws": asked.draws, "outside": _kept(found)}
        told = "; ".join(f"{one.of}: {one.beyond} by up to {one.excess:.2%}" for one in found)
        print(f"linkage {seed}, {len(case.links)} links: {told or 'none outside'}", flush=True)
    for name in asked.cases:
        found, bands = built_in(name, asked.draws)
        if not bands:
            continue
        cases[name] = {"draws": asked.draws, "bands": bands, "wide": _kept(found)}
        print(f"{name}: {bands} bands, draws leave {sum(one.beyond > 0 for one in found)}", flush=True)
        for one in found:
            print(f"  {one.of}: band 1 to {one.high / one.low:.2f}, draws 1 to {one.most / one.least:.2f}", flush=True)
    save("draws", {"linkages": kept, "cases": cases})


if __name__ == "__main__":
    main()
