"""Random four-bar linkages with two of everything, as stated and with every cause of doubt at a place of its own.

Two load cases, two materials (a ductile and a brittle, printed one), two sizes of parts and of pins, two checks of
strength, in either order. What is stated leaves numbers open; ``Inputs`` say where each cause stands, and the same
linkage is built with it there and without the doubt. Kinematics and statics of the linkage with its pins anywhere in
their play are solved here once more, apart from alula, in complex numbers (mm, N).
"""

import cmath
import copy
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from materials import TOLD

from alula.loads.case.case import Case
from alula.loads.case.case_file import validate

JOINTS = ("O2", "A", "B", "O4")
LINKS = {"O2": ("base", "crank"), "A": ("crank", "coupler"), "B": ("coupler", "rocker"), "O4": ("base", "rocker")}
PARTS = {"crank": "wide", "coupler": "narrow", "rocker": "wide"}
MATERIALS = {"wide": "ductile", "narrow": "brittle"}
LOAD_CASES = ("one", "two")
CAUSES = ("load", "strength", "modulus", "play", "friction", "air")


@dataclass(frozen=True, kw_only=True)
class Inputs:
    """Where every cause stands; what is left out stands as stated.

    load      load case -> factor on all of its loads
    strength  material -> factor
    modulus   material -> factor
    friction  joint -> coefficient
    air       C_N
    play      joint -> how far the second link's point stands off the first's [mm]
    """

    load: Mapping[str, float] = field(default_factory=dict)
    strength: Mapping[str, float] = field(default_factory=dict)
    modulus: Mapping[str, float] = field(default_factory=dict)
    friction: Mapping[str, float] = field(default_factory=dict)
    air: float | None = None
    play: Mapping[str, complex] = field(default_factory=dict)


def mm(x: float) -> str:
    return f"{x!r} mm"


class FourBar:
    """A random one; the number of the draw decides on everything."""

    def __init__(self, draw: int, *, off: bool = True) -> None:
        rng = np.random.default_rng(draw)
        self.draw, self.off = draw, off
        self.a, self.b, self.c, self.d = (rng.uniform(*ends) for ends in ((18, 24), (52, 66), (36, 46), (56, 66)))
        self.tip = self.c + rng.uniform(14, 24)
        self.angle = math.radians(rng.uniform(50, 110))
        self.diameters = dict(zip(JOINTS, rng.permutation([2.0, 3.0, 2.5, 3.5]).tolist(), strict=True))
        self.radii = {name: rng.uniform(0.02, 0.06) for name in JOINTS}
        self.mu = {name: rng.uniform(0.1, 0.25) for name in JOINTS}
        self.mu_ends = {name: (mu * rng.uniform(0.5, 0.8), mu * rng.uniform(1.2, 1.6)) for name, mu in self.mu.items()}
        self.width = {"wide": rng.uniform(8, 10), "narrow": rng.uniform(5, 6.5)}
        self.thickness = {"wide": rng.uniform(3, 4), "narrow": rng.uniform(4, 6)}
        self.young = {"ductile": 2000.0, "brittle": 3200.0}
        self.young_ends = {"ductile": (0.7, 1.2), "brittle": (0.85, 1.6)}
        self.strength = {"ductile": 40.0, "brittle": 55.0}
        self.layers = {"strength_across_layers": 25.0, "shear_strength_between_layers": 18.0}
        self.strength_ends = {"ductile": (0.75, 1.15), "brittle": (0.6, 1.5)}
        self.strength_ends |= dict(zip(self.layers, ((0.8, 1.3), (0.7, 1.1)), strict=True))
        self.scatter = {"one": (0.85, 1.3), "two": (0.6, 1.1)}
        self.air, self.air_ends = 3.0, (1.5, 4.5)
        turn = rng.uniform(0.0, 2.0 * math.pi)
        # the second load case bears on another place, from another side
        self.forces = {
            "one": {"rocker": ("P", cmath.rect(rng.uniform(3, 5), turn))},
            "two": {
                "rocker": ("P", cmath.rect(rng.uniform(2, 4), turn + rng.uniform(1.5, 2.5))),
                "coupler": ("M", cmath.rect(rng.uniform(4, 6), turn + rng.uniform(3, 5))),
            },
        }
        self.speed = 2400.0 * float(rng.choice([-1.0, 1.0]))
        self.backwards = bool(rng.integers(2))  # checks, load cases and materials in the other order

    def turned(self, turn: float) -> "FourBar":
        """Return the same one with its crank turned on."""
        found = copy.copy(self)
        found.angle = self.angle + float(turn)
        return found

    def ordered(self, entries: Mapping[str, Any]) -> dict[str, Any]:
        """Return a table in the order of this draw, so that the worse of two comes first or last."""
        return dict(reversed(entries.items()) if self.backwards else entries.items())

    def stated(self, causes: Collection[str], **tables: Any) -> Case:
        """Return the case with its causes stated."""
        return validate(self.data(causes) | tables)

    def direct(self, causes: Collection[str], load_case: str, inputs: Inputs, **tables: Any) -> Case:
        """Return one load case with its causes where they stand, and no doubt about any."""
        data = self.data(causes, inputs, inputs.load.get(load_case, 1.0))
        data["load_cases"] = {load_case: data["load_cases"][load_case]}
        return validate(data | tables)

    def data(self, causes: Collection[str], inputs: Inputs | None = None, factor: float = 1.0) -> dict[str, Any]:
        """Return the tables of the case; ``factor`` is on all that acts, masses and air among it."""
        at = inputs or Inputs()
        place = self.assembled(at.play)
        card = {name: dict.fromkeys(TOLD, what) for name, what in (("sources", "a test"), ("status", "assumed"))}
        card |= {"poissons_ratio": 0.35}
        materials = {}
        for name, kind in (("ductile", "yield"), ("brittle", "ultimate")):
            young, strength = self.young[name], self.strength[name]
            one = {"title": name, "strength": kind, "density": f"{1200.0 * factor!r} kg/m^3", **card}
            one["youngs_modulus"] = f"{young * at.modulus.get(name, 1.0)!r} MPa"
            one[f"{kind}_strength"] = f"{strength * at.strength.get(name, 1.0)!r} MPa"
            if inputs is None and "modulus" in causes:
                one["youngs_modulus_range"] = [f"{young * end!r} MPa" for end in self.young_ends[name]]
            if inputs is None and "strength" in causes:
                one["strength_range"] = [f"{strength * end!r} MPa" for end in self.strength_ends[name]]
            materials[name] = one
        for entry, strength in self.layers.items():
            materials["brittle"][entry] = f"{strength * at.strength.get(entry, 1.0)!r} MPa"
            if inputs is None and "strength" in causes:
                materials["brittle"][f"{entry}_range"] = [
                    f"{strength * end!r} MPa" for end in self.strength_ends[entry]
                ]
        joints = {}
        for name in JOINTS:
            joint: dict[str, Any] = {"links": list(LINKS[name]), "pin_diameter": mm(self.diameters[name])}
            joint["pin_material"] = "brittle" if name in ("A", "O4") else "ductile"
            if "friction" in causes:
                joint["friction"] = mu = at.friction.get(name, self.mu[name])
                joint["friction_range"] = list(self.mu_ends[name]) if inputs is None else [mu, mu]
            if inputs is None and "play" in causes:
                joint["clearance"] = mm(2.0 * self.radii[name])
            joints[name] = joint
        load_cases = {}
        for name, forces in self.forces.items():
            loads = [
                {"link": link, "at": point, "force": [f"{factor * f.real!r} N", f"{factor * f.imag!r} N"]}
                for link, (point, f) in forces.items()
            ]
            one = {"forces": loads, "direction": "forward"}
            if inputs is None and "load" in causes:
                one["scatter"] = list(self.scatter[name])
            if "air" in causes:
                air: dict[str, Any] = {"density": f"{1.2 * factor!r} kg/m^3", "normal_coefficient": at.air or self.air}
                if inputs is None:
                    air["normal_coefficient_range"] = list(self.air_ends)
                one |= {"flapping": air, "speed": f"{self.speed!r} rpm"}
                del one["direction"]
            load_cases[name] = one
        crank = place["A"] - place["O2"]
        printed: dict[str, dict[str, Any]] = {"wide": {}, "narrow": {"build_direction": [0.0, 1.0, 0.0]}}
        data = {
            "schema_version": 1,
            "title": f"draw {self.draw}",
            "links": {
                "base": {"ground": True, "points": {n: [mm(place[n].real), mm(place[n].imag)] for n in ("O2", "O4")}},
                "crank": {"part": "wide", "points": {"O2": [mm(0.0), mm(0.0)], "A": [mm(abs(crank)), mm(0.0)]}},
                "coupler": {
                    "part": "narrow",
                    "points": {"A": [mm(0.0), mm(0.0)], "M": [mm(self.b / 2), mm(0.0)],
                               "B": [mm(abs(place["B"] - place["A"])), mm(0.0)]},
                },
                "rocker": {
                    "part": "wide",
                    "points": {"O4": [mm(0.0), mm(0.0)], "B": [mm(self.c), mm(0.0)], "P": [mm(self.tip), mm(0.0)]},
                    "end_patch": mm(4.0),
                },
            },
            "joints": joints,
            "pose": {
                "coordinate": "crank",
                "angle": f"{cmath.phase(crank)!r} rad",
                "near": {
                    "coupler": f"{cmath.phase(place['B'] - place['A'])!r} rad",
                    "rocker": f"{cmath.phase(place['B'] - place['O4'])!r} rad",
                },
            },
            "drive": {"link": "crank", "joint": "O2"},
            "parts": {
                name: {"shape": "bar", "material": MATERIALS[name], "width": mm(self.width[name]),
                       "thickness": mm(self.thickness[name]), "fillet_radius": mm(2.0), **printed[name]}
                for name in ("wide", "narrow")
            },
            "materials": self.ordered(materials),
            "load_cases": self.ordered(load_cases),
            "checks": self.ordered({
                "strong": {"type": "safety-factor", "minimum": 1.5},
                "stronger": {"type": "safety-factor", "minimum": 2.5, "links": ["rocker", "crank"]},
                "stiff": {"type": "displacement", "maximum": "0.2 mm"},
                "point": {"type": "displacement", "at": "P", "maximum": "1 mm"},
                "pins": {"type": "pins", "minimum": 1.5},
                    "pin": {"type": "pins", "minimum": 2.0, "joints": ["B"]},
                "eyes": {"type": "bearing", "minimum": 3.0},
                "limit": {"type": "limit-load", "minimum": 1.5},
            }),
        }  # fmt: skip
        if self.off:
            data["large_displacement"] = "off"
        if "air" in causes:  # one wing from root to tip, and one from tip to root
            data["wings"] = [
                {"link": "rocker", "start": "B", "end": "P", "chord": ["30 mm", "20 mm"]},
                {"link": "coupler", "start": "B", "end": "A", "chord": ["30 mm", "60 mm"]},
            ]
        return data

    def assembled(self, play: Mapping[str, complex]) -> dict[str, complex]:
        """Return where the pins stand: of each joint the point of its second link, at which its force acts."""
        o2 = play.get("O2", 0j)
        pin = o2 + cmath.rect(self.a, self.angle) + play.get("A", 0j)
        o4 = self.d + play.get("O4", 0j)
        # coupler's own B: at b from its pin, and with the offset at c from the rocker's
        across = o4 - play.get("B", 0j) - pin
        far = abs(across)
        along = (self.b**2 - self.c**2 + far**2) / (2.0 * far)
        own = pin + across / far * complex(along, math.sqrt(self.b**2 - along**2))
        return {"O2": o2, "A": pin, "B": own + play.get("B", 0j), "O4": o4}

    def statics(self, load_case: str, inputs: Inputs = Inputs()) -> tuple[dict[str, complex], float]:
        """Return what the first link of every joint does to its second, and the torque of the drive on the crank.

        Friction makes a couple at every pin, against the turning of the second link in the first as the crank turns
        forwards; it is in proportion to the force, and found in turn with it.
        """
        at, couples = self.assembled(inputs.play), dict.fromkeys(JOINTS, 0.0)
        turn = self.rates(at)
        direction = {name: turn[second] - turn[first] for name, (first, second) in LINKS.items()}
        rocker = (at["B"] - at["O4"]) / abs(at["B"] - at["O4"])
        coupler = (at["B"] - at["A"]) / abs(at["B"] - at["A"])
        places = {"P": at["O4"] + self.tip * rocker, "M": at["A"] + self.b / 2.0 * coupler}
        for _ in range(200):
            matrix, right = np.zeros((9, 9)), np.zeros(9)
            for row, link in enumerate(PARTS):
                for column, (name, pair) in enumerate(LINKS.items()):
                    sign = (pair[1] == link) - (pair[0] == link)
                    z = at[name]
                    matrix[3 * row, 2 * column] = matrix[3 * row + 1, 2 * column + 1] = sign
                    matrix[3 * row + 2, 2 * column : 2 * column + 2] = -sign * z.imag, sign * z.real
                    right[3 * row + 2] -= sign * couples[name]
                for where, force in [self.forces[load_case][link]] if link in self.forces[load_case] else []:
                    force, z = force * inputs.load.get(load_case, 1.0), places[where]
                    right[3 * row : 3 * row + 3] -= force.real, force.imag, (z.conjugate() * force).imag
            matrix[2, 8] = 1.0  # the drive's torque on the crank
            found = np.linalg.solve(matrix, right)
            forces = {name: complex(found[2 * i], found[2 * i + 1]) for i, name in enumerate(JOINTS)}
            before = couples
            sizes = {n: inputs.friction.get(n, 0.0) * self.diameters[n] / 2.0 * abs(forces[n]) for n in JOINTS}
            couples = {name: -math.copysign(size, direction[name]) for name, size in sizes.items()}
            if max(abs(couples[n] - before[n]) for n in JOINTS) < 1e-13:
                break
        return forces, float(found[8])

    def rates(self, at: Mapping[str, complex]) -> dict[str, float]:
        """Return how fast links turn while the crank turns forwards."""
        crank, coupler, rocker = at["A"] - at["O2"], at["B"] - at["A"], at["B"] - at["O4"]
        matrix = np.array([[coupler.real, -rocker.real], [coupler.imag, -rocker.imag]])
        one, two = np.linalg.solve(matrix, [-crank.real, -crank.imag])
        return {"base": 0.0, "crank": 1.0, "coupler": float(one), "rocker": float(two)}
