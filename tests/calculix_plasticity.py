"""Plastic paths by CalculiX on our mesh, supports and integration points: what our own are tried on.

The load is led as ours is: an equation makes a further unknown of f·u, whose displacement is given in each step; the
load factor comes from CalculiX's own internal forces. A state is one step of one increment, so that both take the
plastic strains through the same states. Newton's method without a line search, as CalculiX has it, needs them close.
"""

import re

import numpy as np
import solid_meshes
from holed_problems import strip_problem
from plastic_problems import NU, E, law, loaded

from alula.fea.calculix import program as calculix
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.space import displacement_space
from alula.fea.plastic.link_collapse import _Held
from alula.fea.tractions.link_tractions import LinkTractions
from alula.geometry.base.tidying import scratch_folder
from alula.geometry.meshing.mirror import mirrored
from alula.loads.records.bearing import WIDE

CLOSE, END = 1.12, 4.5
"""By how much f·u grows from state to state, and at what multiple of that of first yield it ends. With 1.25 CalculiX
lost the eyes."""


def strip(**hardening):
    """A strip with a hole of half its width, in plane stress."""
    p = strip_problem(0.5, 2, 3, 2, E=E, nu=NU)
    for node in np.flatnonzero(p.space.nodes[:, 2] > 1e-9):
        p.fixed.pop(3 * int(node) + 2, None)
    return loaded(p, law(**hardening))


def square_eyes():
    """Half of a bar with two square eyes of 1.67 bores, each pulled by its pin."""
    sizes = {"hole": 1.5, "length": 20.0, "around": 12, "radial": 1, "along": 1, "layers": 1}
    space = displacement_space(mirrored(solid_meshes.half_bar(**sizes)))
    return pulled(space, law(), {"A": (0.0, -1.0), "B": (20.0, 1.0)}, 3.0)


def pulled(space, yields, pins, diameter):
    """Half of a link on which pins (centre along x, force along x [N]) press; held as its collapse is found."""
    loads = LinkLoads(
        name="pull",
        pins=tuple(
            PinLoad(name=name, centre=np.array([x, 0, 0.0]), diameter=diameter, wrench=np.array([f, 0, 0, 0, 0, 0.0]))
            for name, (x, f) in pins.items()
        ),
    )
    pose = loads.chosen(None)
    [variant] = LinkTractions.of(space, [pose], density=1e-9).variants(pose, (WIDE,), ("x",))
    return _Held.of(space, yields, variant.load, 1, np.inf).problem


def our_path(load):
    """Return states from first yield on."""
    states = [load.elastic(load.first_yield)]
    while (control := CLOSE * states[-1].control) <= END * load.first_yield:
        states.append(load.led(states[-1], control, states[-2] if len(states) > 1 else None))
    return states


def calculix_path(load, states, *, time_limit=600.0):
    """Return the load factor and the displacements (n, 3) by CalculiX at the f·u of each of our states."""
    space, yields = load.body.space, load.body.law
    node, size = len(space.nodes) + 1, float(np.abs(load.load).max())
    unknowns = np.flatnonzero(load.load)
    unknowns = unknowns[np.argsort(-np.abs(load.load[unknowns]))]
    terms = [f"{u // 3 + 1}, {u % 3 + 1}, {load.load[u] / size:.12e}" for u in unknowns.tolist()]
    terms.append(f"{node}, 1, -1.")
    with scratch_folder("alula-calculix-") as scratch:
        path = scratch / "link.inp"
        with path.open("w", encoding="ascii") as deck:
            calculix.write_mesh(deck, space, "plastic path")
            deck.write(f"*NODE, NSET=LED\n{node}, 0., 0., 0.\n*EQUATION\n{len(terms)}\n")
            deck.writelines(f"{', '.join(terms[i : i + 4])}\n" for i in range(0, len(terms), 4))
            deck.write(f"*MATERIAL, NAME=MATERIAL\n*ELASTIC\n{yields.E!r}, {yields.nu!r}\n")
            rows = [(0.0, 1.0), *yields.hardening]
            deck.write("*PLASTIC\n" + "".join(f"{factor * yields.strength!r}, {strain!r}\n" for strain, factor in rows))
            deck.write("*SOLID SECTION, ELSET=EALL, MATERIAL=MATERIAL\n*BOUNDARY\n")
            deck.writelines(f"{u // 3 + 1}, {u % 3 + 1}\n" for u in load.fixed.tolist())
            for state in states:
                amount = state.control * load.work / size
                deck.write(f"*STEP\n*STATIC, DIRECT\n1., 1.\n*BOUNDARY\n{node}, 1, 1, {amount:.12e}\n")
                deck.write("*NODE PRINT, NSET=NALL\nU, RF\n*END STEP\n")
        dat, _ = calculix.run(path, scratch, threads=1, time_limit=time_limit)
        printed = dat.read_text(encoding="ascii")
    blocks = re.split(r"^ (?:displacements|forces).*$", printed, flags=re.MULTILINE)[1:]
    tables = [np.array([line.split()[1:] for line in block.splitlines() if line.strip()], float) for block in blocks]
    return [float(one.ravel() @ load.load) / load.size**2 for one in tables[1::2]], tables[::2]
