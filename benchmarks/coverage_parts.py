"""Links drawn at random, on which the error bands of solids are fixed (training) and tried (held out).

Twelve kinds of links in turn: tubes, rods, flat, plain-eyed and thick-eyed bars, discs, arms, slots, cross holes in
tubes and bars, plain ends of tubes and bars. Sizes, Poisson's ratio, load, kind of material, the accuracy that is
asked for and the distance of the limit are drawn for each. Edges are rounded, so that every peak has a limit; discs
have none inwards. Flat kinds (``PLANE``) are loaded in their plane and do not contract across (ν = 0): an independent
plane code knows their peaks.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.fea.common.link_loads import DriveCouple, EndLoad, LinkLoads, PinLoad
from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.eyes import RIM
from alula.geometry.meshing.mesh import check_body
from alula.geometry.parts.part import Bar, Body, Disc, HoleRow, Pin, PlainEnd, Tube

WIDTH = 10.0
"""Of every section [mm]: errors depend on proportions alone."""
KINDS = (
    "tube", "rod", "bar", "plain eyes", "thick eyes", "disc", "arm", "slot", "holes in a tube", "holes in a bar",
    "end of a tube", "end of a bar",
)  # fmt: skip
PLANE = ("bar", "plain eyes", "disc", "arm", "slot", "holes in a bar")
FORCE = 100.0
YOUNG = 2400.0


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A link, its load, and what is asked of its numbers.

    Attributes
    ----------
    name : str
        Its number, kind and load.
    kind : str
        One of ``KINDS``.
    body : Body
        Its shape.
    loads : LinkLoads
        Its load.
    nu : float
        Poisson's ratio.
    brittle : bool
        True where the principal stress decides, False where von Mises does.
    accuracy : float
        That is asked for, relative.
    limit : float
        On the deciding stress, over its true value.
    """

    name: str
    kind: str
    body: Body
    loads: LinkLoads
    nu: float
    brittle: bool
    accuracy: float
    limit: float


def drawn(seed: int, flat: int, others: int) -> Iterator[Drawn]:
    """Draw each flat kind and each other kind so many times; what the rules for bodies refuse is drawn again."""
    for number in range(max(flat, others) * len(KINDS)):
        kind, attempt = KINDS[number % len(KINDS)], 0
        if number // len(KINDS) >= (flat if kind in PLANE else others):
            continue
        while True:
            rng = np.random.default_rng([seed, number, attempt])
            try:
                body = _body(rng, kind)
                check_body(body)
                break
            except CaseError:
                attempt += 1
        load, loads = _loads(rng, kind, body)
        yield Drawn(
            name=f"{number + 1} {kind}, {load}",
            kind=kind,
            body=body,
            loads=loads,
            nu=0.0 if kind in PLANE else round(float(rng.uniform(0.25, 0.42)), 3),
            brittle=bool(rng.random() < 0.5),
            accuracy=float(rng.choice([0.2, 0.1, 0.05, 0.03])),
            limit=round(float(np.exp(rng.choice([-1.0, 1.0]) * rng.uniform(0.02, 1.2))), 4),
        )


def _mm(widths: float) -> str:
    return f"{WIDTH * widths:.4g} mm"


def _body(rng: np.random.Generator, kind: str) -> Body:
    """Sizes over the width of the section."""
    fillet, eye = rng.uniform(0.1, 0.3), rng.uniform(1.35, 2.0)
    if kind == "disc":
        return _disc(rng)
    sizes: dict[str, Any]
    tubular = kind in ("tube", "rod", "holes in a tube", "end of a tube")
    if tubular:
        inner = 0.0 if kind == "rod" else rng.uniform(0.35, 0.8)
        thick = max(rng.uniform(1.25, 1.75), 1.0 + 1.01 * RIM * fillet)
        sizes = {"outer_diameter": _mm(1.0), "inner_diameter": _mm(inner)}
    else:
        flat = rng.uniform(0.3, 1.0)
        thick = flat
        if kind == "plain eyes":
            eye = 1.0
        if kind == "thick eyes":
            thick = flat + 1.01 * RIM * fillet + rng.uniform(0.0, 0.3)
        sizes = {"width": _mm(1.0), "thickness": _mm(flat)}
    sizes |= {"eye_diameter": _mm(eye), "eye_thickness": _mm(thick), "fillet_radius": _mm(fillet), "material": "any"}
    part = Tube.model_validate(sizes | {"shape": "tube"}) if tubular else Bar.model_validate(sizes | {"shape": "bar"})
    bore = rng.uniform(0.25, 0.65) * eye * WIDTH
    step = (eye + 2.0 * fillet + rng.uniform(0.4, 1.5)) * WIDTH

    def pin(name: str, x: float, **more: Any) -> Pin:
        return Pin(**({"name": name, "x": x, "y": 0.0, "diameter": bore} | more))

    if kind == "arm":
        angle, reach = rng.uniform(0.9, 1.6), rng.uniform(2.2, 3.0) * WIDTH
        foot = (step, 0.0)
        tip = pin("Q", step + reach * np.cos(angle), y=reach * np.sin(angle), foot=foot)
        return Body(part=part, pins=(pin("A", 0.0), pin("B", step), pin("C", 2.0 * step), tip), ends=(), holes=())
    if kind == "slot":
        slot, wide = rng.uniform(0.8, 2.0) * WIDTH, rng.uniform(0.3, 0.5) * WIDTH
        sliding = pin("B", step + slot / 2.0, diameter=wide, slot=slot, clearance=0.0)
        return Body(part=part, pins=(pin("A", 0.0), sliding, pin("C", 2.0 * step + slot)), ends=(), holes=())
    if kind.startswith("holes"):
        hole, along = rng.uniform(0.15, 0.35), "z" if kind in PLANE else str(rng.choice(["y", "z"]))
        middle = step * rng.uniform(0.85, 1.0)
        row = {"count": 1, "diameter": _mm(hole), "along": along}
        row |= {"first": f"{middle:.4g} mm", "last": f"{middle:.4g} mm"}
        return Body(
            part=part, pins=(pin("A", 0.0), pin("C", 2.0 * step)), ends=(), holes=(HoleRow.model_validate(row),)
        )
    if kind.startswith("end"):
        tip = PlainEnd(name="H", x=step * 2.0, patch=rng.uniform(0.4, 0.9) * WIDTH)
        return Body(part=part, pins=(pin("A", 0.0), pin("C", step)), ends=(tip,), holes=())
    places = {"A": 0.0, "B": step, "C": 2.0 * step} if rng.random() < 0.5 else {"A": 0.0, "C": 1.3 * step}
    return Body(part=part, pins=tuple(pin(name, x) for name, x in places.items()), ends=(), holes=())


def _disc(rng: np.random.Generator) -> Body:
    bore, ring, apart = rng.uniform(0.12, 0.3), rng.uniform(0.3, 0.45), rng.uniform(0.5, 0.65)
    across = 2.0 * apart + ring + rng.uniform(0.1, 0.4)
    sizes = {"diameter": across, "thickness": rng.uniform(0.15, 0.4), "eye_diameter": ring}
    part = Disc.model_validate({"shape": "disc", "material": "any"} | {k: _mm(v) for k, v in sizes.items()})
    pins = [Pin(name=name, x=x * WIDTH, y=0.0, diameter=bore * WIDTH) for name, x in (("A", 0.0), ("C", apart))]
    return Body(part=part, pins=tuple(pins), ends=(), holes=())


def _loads(rng: np.random.Generator, kind: str, body: Body) -> tuple[str, LinkLoads]:
    """Name the load and balance it: A takes the force and the torque about x, C what moments remain."""
    pins = {pin.name: pin for pin in body.pins}
    places = {name: np.array([pin.x, pin.y, 0.0]) for name, pin in pins.items()}
    wrenches = {name: np.zeros(6) for name in pins}
    end, couple = np.zeros(6), 0.0
    arm = places["C"][0] / WIDTH
    choices = ["pull", "push"]
    if kind not in PLANE:
        choices += ["drive", "twist", "bend out of the plane"]
    if "B" in pins:
        choices += ["bend"] * 3
    named = {"arm": ["arm"], "slot": ["slot", "slot and pull"]}
    named |= {"end of a tube": (tip := ["tip", "tip and pull", "tip out of the plane"]), "end of a bar": tip}
    load = str(rng.choice(named.get(kind, choices)))
    if load in ("pull", "push", "slot and pull", "tip and pull"):
        wrenches["C"][0] += {"push": -1.0, "pull": 1.0}.get(load, 3.0) * FORCE
    if load == "drive":
        wrenches["C"][1] += FORCE
        couple = -FORCE * places["C"][0]
        wrenches["C"][0] += float(rng.choice([0.0, 2.0])) * FORCE
    if load == "twist":
        wrenches["C"][3] += FORCE * WIDTH
    if load == "bend out of the plane":
        wrenches["C"][4] += FORCE * WIDTH
        wrenches["A"][4] -= FORCE * WIDTH
    if load in ("bend", "slot", "slot and pull"):
        wrenches["B"][1] += FORCE
    if load == "bend":
        wrenches["C"][0] += float(rng.uniform(-2.0, 2.0)) * arm * FORCE
    if load == "arm":
        turn = rng.uniform(0.0, 2.0 * np.pi)
        wrenches["Q"][:2] += FORCE * np.array([np.cos(turn), np.sin(turn)])
    if load.startswith("tip"):
        end[2 if "out" in load else 1] = FORCE
    h = np.array([body.ends[0].x, 0.0, 0.0]) if body.ends else np.zeros(3)
    force = sum((w[:3] for w in wrenches.values()), end[:3].copy())
    moment = sum((np.cross(places[n], w[:3]) + w[3:] for n, w in wrenches.items()), np.cross(h, end[:3]))
    moment = moment + couple * np.array([0.0, 0.0, 1.0])
    at_c = np.array([0.0, -moment[2], moment[1]]) / places["C"][0]
    wrenches["C"][:3] += at_c
    wrenches["A"][:3] -= force + at_c
    wrenches["A"][3] -= moment[0]
    return load, LinkLoads(
        name=load,
        pins=tuple(
            PinLoad(
                name=name,
                centre=places[name],
                diameter=pins[name].diameter,
                wrench=wrench,
                slotted=pins[name].slot > 0.0,
            )
            for name, wrench in wrenches.items()
        ),
        couples=(DriveCouple(pin="A", torque=couple),) if couple else (),
        ends=(EndLoad(name="H", point=h, wrench=end),) if body.ends else (),
    )
