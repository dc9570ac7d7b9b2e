"""Parts from files and plates of our own, drawn at random: found, placed and meshed as closed forms say."""

import math

import numpy as np
import pytest
import random_parts
from scipy.spatial import ConvexHull

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.body import Body
from alula.geometry.bodies.body_rules import check_body
from alula.geometry.bodies.features import Pin, Ring
from alula.geometry.imported.read import part_facts
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.parts.plate import Plate
from alula.geometry.parts.step import StepPart
from alula.geometry.placement.match import Wanted
from alula.geometry.placement.placed_body import placed_body

FEW, MANY = [0, 1], range(2, 40)


def some(seeds, more):
    """Few seeds in every run of the tests, many in a converged study."""
    return [*seeds, *(pytest.param(seed, marks=pytest.mark.converged) for seed in more)]


@pytest.fixture(scope="module")
def files(request, tmp_path_factory):
    """The STEP files of all seeds that were chosen, written at once."""
    seeds = {item.callspec.params["seed"] for item in request.session.items if "files" in item.fixturenames}
    return random_parts.write(tmp_path_factory.mktemp("random"), sorted(seeds))


@pytest.mark.parametrize("seed", some(FEW, MANY))
def test_a_random_part_is_found_placed_and_meshed(files, seed):
    plate = random_parts.drawn(seed)
    facts = part_facts(files[seed])
    volume, centroid = plate.moments()
    assert facts.volume == pytest.approx(volume, rel=1e-6)
    assert facts.centroid == pytest.approx(plate.moved(centroid), abs=1e-4)
    holes = sorted(plate.holes, key=lambda hole: hole.diameter)
    bores = sorted(facts.bores, key=lambda bore: bore.diameter)
    assert [bore.diameter for bore in bores] == pytest.approx([hole.diameter for hole in holes])
    for hole, bore in zip(holes, bores, strict=True):
        assert bore.length == pytest.approx(plate.thickness + hole.top + hole.bottom)
        assert bore.centre == pytest.approx(plate.moved((hole.x, hole.y, (hole.top - hole.bottom) / 2.0)), abs=1e-5)
    # The link's frame: the first hole is the origin, the second lies on the x axis; pins are 0.1 mm smaller.
    first, second = complex(holes[0].x, holes[0].y), complex(holes[1].x, holes[1].y)
    places = [(complex(h.x, h.y) - first) * abs(second - first) / (second - first) for h in holes]
    wanted = tuple(
        Wanted(name=f"P{i}", place=(at.real, at.imag), diameter=hole.diameter - 0.1)
        for i, (hole, at) in enumerate(zip(holes, places, strict=True))
    )
    body = placed_body(StepPart(shape="step", file=str(files[seed]), material="pvc-u"), wanted)
    # The kernel's borders are looked at in 65 places of each curve.
    assert [pin.ring.diameter for pin in body.pins] == pytest.approx([plate.ring(h) for h in holes], rel=3e-3)
    mesh = mesh_body(body, COARSE)
    assert mesh.volume == pytest.approx(volume, rel=1e-3)
    for pin, hole in zip(body.pins, holes, strict=True):
        length = plate.thickness + hole.top + hole.bottom
        assert mesh.areas[f"bore:{pin.name}"] == pytest.approx(math.pi * hole.diameter * length, rel=1e-3)
        assert mesh.areas[f"top:{pin.name}"] == pytest.approx(
            math.pi / 4.0 * (pin.ring.diameter**2 - hole.diameter**2), rel=1e-3
        )


def random_plate(rng):
    """A plate about two to five pins, some with larger eyes, with up to two holes between them."""
    thickness, size = rng.uniform(1.5, 6.0), rng.uniform(25.0, 90.0)
    half = thickness / 2.0
    pins = tuple(
        Pin(
            name=name,
            x=rng.uniform(0.0, size),
            y=rng.uniform(-size, size) / 2.0,
            diameter=(diameter := rng.uniform(2.0, 7.0)),
            ring=Ring(diameter=diameter * rng.uniform(1.5, 3.0), low=-half, high=half),
        )
        for name in "ABCDE"[: rng.integers(2, 6)]
    )
    holes = [
        {"x": f"{rng.uniform(0, size)} mm", "y": f"{rng.uniform(-size, size) / 2} mm", "diameter": f"{d} mm"}
        for d in rng.uniform(2.0, size / 5.0, rng.integers(0, 3))
    ]
    sizes = {"thickness": f"{thickness} mm", "eye_diameter": "10 mm", "holes": holes}
    part = Plate.model_validate({"shape": "plate", "material": "pvc-u"} | sizes)
    return Body(part=part, pins=pins, ends=(), holes=())


@pytest.mark.parametrize("seed", some(FEW, MANY))
def test_a_random_plate_is_refused_or_meshed(seed):
    rng = np.random.default_rng(seed)
    while True:
        body = random_plate(rng)
        try:
            check_body(body)
            break
        except CaseError:
            pass
    mesh = mesh_body(body, COARSE)
    turn = np.linspace(0.0, 2.0 * math.pi, 4000)
    round_about = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    hull = ConvexHull(np.concatenate([[p.x, p.y] + p.ring.diameter / 2.0 * round_about for p in body.pins]))
    holes = [hole.diameter for hole in (*body.pins, *body.part.holes)]
    area = hull.volume - math.pi / 4.0 * np.square(holes).sum()  # scipy calls the area of a plane hull its volume
    assert mesh.volume == pytest.approx(area * body.part.thickness, rel=1e-3)
    for pin in body.pins:
        assert mesh.areas[f"bore:{pin.name}"] == pytest.approx(math.pi * pin.diameter * body.part.thickness, rel=1e-3)
