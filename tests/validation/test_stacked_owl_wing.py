"""The owl wing in layers, against the numbers of an independent frame.

That frame: Euler-Bernoulli beams of 12 unknowns, pins as steel beams of 1.5 mm built into the first link of their joint
and free to turn about their axis in the second, all else continuous; ground rigid; the torque held at AE; 0.25 N down
at H; E 2400 MPa, nu 0.38, tubes of 5 over 2.5 mm, layers 7 mm apart. It was written for these numbers by others.
"""

import math
from collections.abc import Iterator

import numpy as np
import pytest
from edited_cases import edited

import alula.fea.frame.equations
import alula.fea.frame.system
from alula.fea.beam.cut_free import link_loads
from alula.fea.frame.build import build_frame
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.linkage_frame import LinkageFrame
from alula.fea.pins.clearances import clearances_of
from alula.fea.standing.joint_forces import joint_forces
from alula.loads.case.case import Case
from alula.loads.states.actions import stated_loads

LINKS = ("AG", "GF", "AE", "CF", "CH", "ED")
TWO, FOUR = (-1, 0, 0, 1, 0, 1), (0, 0, 1, 2, 3, 2)
TABLE = {
    TWO: ((0.147, 11.356, 1.917, 0.831, 0.187), (-5.69, -47.61, -0.38)),
    FOUR: ((0.455, 11.357, 1.966, 0.830, 0.207), (-5.68, -47.79, -0.03)),
}


def stacked(layers: tuple[int, ...]) -> Case:
    stated = [f"links.{name}.layer={layer}" for name, layer in zip(LINKS, layers, strict=True)]
    return edited("owl-wing-static", [*stated, 'layer_spacing="7 mm"'], bare=True)


def solved(case: Case) -> tuple[LinkageFrame, FrameSolution]:
    [load_case] = case.load_cases.values()
    frame = build_frame(case, case.solve_pose(), stated_loads(case, load_case), held=case.pinned_drive)
    return frame, solve_frame(frame.model)


def largest_stress(frame: LinkageFrame, solution: FrameSolution, link: str) -> float:
    """√((N/A + M/Z)² + 3 τ²) of a tube, M of both bending moments."""
    found = 0.0
    for i, beam in frame.beams.items():
        if beam.link == link:
            section, forces = frame.model.elements[i].section, solution.internal_forces(i)
            for x in np.linspace(0.0, frame.model.length(i), 9):
                n, _, _, t, m_y, m_z = forces.at(float(x))
                normal = abs(n) / section.area + math.hypot(m_y, m_z) * section.half_y / section.i_y
                found = max(found, math.hypot(normal, math.sqrt(3.0) * t * section.half_y / section.torsion))
    return found


@pytest.fixture
def no_shear(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with_shear = alula.fea.frame.system.flexibility

    def flexibility(*of: object) -> tuple[float, ...]:
        along, _, _, twist, about_y, about_z = with_shear(*of)  # type: ignore[arg-type]
        return along, 0.0, 0.0, twist, about_y, about_z

    monkeypatch.setattr(alula.fea.frame.system, "flexibility", flexibility)
    alula.fea.frame.equations._known.cache_clear()
    yield
    alula.fea.frame.equations._known.cache_clear()


@pytest.mark.usefixtures("no_shear")
@pytest.mark.parametrize("layers", [TWO, FOUR])
def test_the_frame_gives_the_published_table(layers: tuple[int, ...]) -> None:
    frame, solution = solved(stacked(layers))
    stresses, moved = TABLE[layers]
    found = [largest_stress(frame, solution, link) for link in LINKS[1:]]
    assert found == pytest.approx(stresses, rel=0.01)
    assert solution.displacements[frame.points["CH", "H"], :3] == pytest.approx(moved, abs=0.006)


def test_shear_of_the_pins_changes_little() -> None:
    """A pin of 1.5 mm over 7 mm gives some 10 % more by shear, the links' stress less than 1 %."""
    frame, solution = solved(stacked(FOUR))
    found = [largest_stress(frame, solution, link) for link in LINKS[1:]]
    assert found == pytest.approx(TABLE[FOUR][0], rel=0.01)


@pytest.mark.parametrize("layers", [TWO, FOUR])
def test_the_load_does_the_work_that_links_and_pins_store(layers: tuple[int, ...]) -> None:
    """Clapeyron: half the load times its way is ∫ N²/2EA + V²/2κGA + T²/2GJ + M²/2EI over all beams and pins."""
    frame, solution = solved(stacked(layers))
    points, weights = np.polynomial.legendre.leggauss(4)
    stored = 0.0
    for i, element in enumerate(frame.model.elements):
        section, young = element.section, element.young
        shear = young / (2.0 * (1.0 + element.poisson))
        stiff = shear * section.area * section.shear_coefficient(element.poisson)
        bent = (young * section.i_y, young * section.i_z)
        over = np.array([young * section.area, stiff, stiff, shear * section.torsion, *bent])
        length, forces = frame.model.length(i), solution.internal_forces(i)
        for point, weight in zip(points, weights, strict=True):
            found = np.array(forces.at(float(length * (1.0 + point) / 2.0)))
            stored += weight * length / 2.0 * float((found**2 / over).sum()) / 2.0
    moved = solution.displacements[frame.points["CH", "H"], 1]
    assert stored == pytest.approx(0.5 * 0.25 * abs(moved), rel=1e-6)


@pytest.mark.parametrize("layers", [TWO, FOUR])
def test_every_link_balances_however_pins_share_the_couples(layers: tuple[int, ...]) -> None:
    case = stacked(layers)
    [load_case] = case.load_cases.values()
    loads = stated_loads(case, load_case)
    forces = joint_forces(case, case.solve_pose(), loads)
    assert forces.sharings
    every = [forces.on_tight_pins, forces.reactions, *forces.sharings]
    for reactions in every:
        for link in LINKS[1:]:
            acting = link_loads("", link, case.body(link), reactions, loads)
            assert acting.resultant() == pytest.approx(np.zeros(6), abs=1e-7)
        plain = every[0].joints
        for name, joint in reactions.joints.items():
            assert joint.wrench[[0, 1]] == pytest.approx(plain[name].wrench[[0, 1]], abs=1e-9)


def test_a_pin_stated_tight_runs_in_the_other_link_alone() -> None:
    case = stacked(FOUR)
    stated = {"A": ("AE",), "B": ("CF",), "D": ("ED", "CH")}
    joints = {n: joint.model_copy(update={"tight_in": stated.get(n, ())}) for n, joint in case.joints.items()}
    case = case.model_copy(update={"joints": joints})
    frame, _ = solved(case)
    found = [hole for one in clearances_of(case, frame) for hole in one.holes]
    assert sorted(found) == sorted(
        (n, link) for n in joints if case.linkage.rise(n) for link in joints[n].links if link not in stated.get(n, ())
    )
