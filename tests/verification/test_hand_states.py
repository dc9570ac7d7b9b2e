"""Hand calculation of n states at once against one state at a time: each state keeps its own peak."""

import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from imported_case import imported_case
from rocker_case import TOML
from slotted_lever import slotted_lever

from alula.fea.beam.critical_locations import displacement_estimate
from alula.fea.beam.cut_free import link_loads
from alula.fea.beam.theory import internal_forces
from alula.fea.buckling.buckling import least_factor
from alula.fea.buckling.holding import columns, holding
from alula.fea.common.link_loads import LinkLoads
from alula.fea.links.link_by_hand import HandStates, link_by_hand
from alula.fea.links.on_axis import on_axis
from alula.fea.links.second_order import Bend, on_its_pins, on_tilting_pins
from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.bodies.body import reference_line
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, validate
from alula.loads.records.applied import shifted

SEED, COUNT = 7, 12
TUBES = "owl-wing-static"


def drawn(case: Case, link: str, size: float) -> Iterator[LinkLoads]:
    """Yield balanced loads of a link's pins, each of a size and direction of its own, first none; [N], a mean size."""
    draw, load_case = np.random.default_rng(SEED), next(iter(case.load_cases))
    found = solve_case_statics(case, TUBES)
    acting = link_loads("l", link, case.body(link), found.reactions[load_case], found.loads[load_case])
    bare = replace(acting, couples=(), ends=(), lines=(), inertia=None)
    for share in np.append(0.0, np.geomspace(0.1, 3.0, COUNT - 1)):
        wrenches = share * size * draw.uniform(-1.0, 1.0, (len(bare.pins), 6)) * (1.0, 0.2, 0.1, 0.0, 1.0, 1.0)
        pins = [replace(pin, wrench=wrench) for pin, wrench in zip(bare.pins, wrenches, strict=True)]
        rest, last = replace(bare, pins=tuple(pins)).resultant(), pins[-1]
        pins[-1] = replace(last, wrench=last.wrench - shifted(rest, -last.centre))
        yield replace(bare, pins=tuple(pins))


def cases(folder: Path) -> dict[str, tuple[Case, str, float]]:
    """Links of a tube, of a bar with a slot, and of a part from a file, each with a size of its loads [N]."""
    return {
        "bar": (validate(tomllib.loads(TOML)), "rocker", 20.0),
        "tube": (read_case(TUBES), "CH", 2.0),
        "slot": (slotted_lever(), "lever", 5.0),
        "file": (read_case(str(imported_case(folder))), "rocker", 40.0),
    }


@pytest.mark.parametrize("name", ["bar", "tube", "slot", "file"])
def test_every_state_of_many_is_that_state_alone(tmp_path: Path, name: str) -> None:
    case, link, size = cases(tmp_path)[name]
    states = list(drawn(case, link, size))
    pairs = [(states[i], states[-1 - i]) if i % 3 == 0 else (one,) for i, one in enumerate(states)]
    states = HandStates(case, link, pairs)
    stress, displacement, inverse = states.stress, states.displacement, states.inverse_buckling
    hands = [[link_by_hand(case, link, plate) for plate in plates] for plates in pairs]
    alone = [max(hand.worst[1].equivalent for hand in each) for each in hands]
    assert stress == pytest.approx(alone, rel=1e-9)
    body, material = case.body(link), case.material_of(link)
    moved = [
        displacement_estimate(
            body, plate.chosen(None), hand.check.forces.state(None), hand.check.section,
            young=material.youngs_modulus, poisson=material.poissons_ratio, line=reference_line(body),
        )[0]
        for plates, each in zip(pairs, hands, strict=True) for plate, hand in zip(plates, each, strict=True)
    ]  # fmt: skip
    counts = np.cumsum([0, *map(len, pairs)])[:-1]
    assert displacement == pytest.approx(np.maximum.reduceat(moved, counts), rel=1e-9)
    bent = np.maximum.reduceat([hand.displacement for each in hands for hand in each], counts)
    assert np.all(displacement > bent * (1.0 - 1e-9))
    factors = [min(least_factor(case, link, hand.check) for hand in each) for each in hands]
    assert inverse == pytest.approx([1.0 / factor for factor in factors], rel=1e-9)
    assert len(set(np.round(stress, 6))) > COUNT // 2  # or one state would stand for all
    assert 0 < np.count_nonzero(inverse) < len(inverse)


def test_growth_of_many_states_is_that_of_each_alone() -> None:
    case = validate(tomllib.loads(TOML))
    states = [replace(one, name=str(i)) for i, one in enumerate(drawn(case, "rocker", 3000.0))]
    together = on_tilting_pins(case, "rocker", states)
    (inertia, soft), material = columns(case.body("rocker"), free=True)[1], case.material_of("rocker")
    across, held = Bend(stiffness=material.youngs_modulus * inertia, stretches=soft), holding(case, "rocker").outermost
    forces = [internal_forces(on_axis(one, case.body("rocker"), material.density)) for one in states]
    alone = [on_its_pins(one, own, None, across, held) for one, own in zip(states, forces, strict=True)]
    grown = [bool(one.lines) for one in together]
    assert 0 < sum(grown) < len(grown)
    for one, other in zip(together, alone, strict=True):
        assert one.name == other.name
        assert len(one.lines) == len(other.lines)
        assert np.array([pin.wrench for pin in one.pins]) == pytest.approx(np.array([p.wrench for p in other.pins]))
        for line, same in zip(one.lines, other.lines, strict=True):
            assert line.at_start == pytest.approx(same.at_start)
