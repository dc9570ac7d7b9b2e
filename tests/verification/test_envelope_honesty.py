"""The band of a motion's peak where its pose was not the one refined for, and no curve where no number stands."""

from dataclasses import replace

import numpy as np
import pytest
import solid_meshes
from turning_load import BODY, POSES, RHO, history

from alula.fea.elements.space import displacement_space
from alula.fea.motion.link_envelope import ELSEWHERE, FATIGUE_ELSEWHERE, LinkMotion
from alula.fea.refine.level import level_of
from alula.fea.refine.link_series import precision
from alula.fea.refine.refinement import MeshRecord, RefinedSolid
from alula.fea.solid.solution import solve_solid
from alula.geometry.materials.material import library

MATERIAL = library()["pvc-u"]


@pytest.fixture(scope="module")
def mesh():
    return solid_meshes.bar(around=16, radial=3, along=4, layers=1, tail=4.0)


def refined_at(mesh, pose):
    """What a refinement that ended with its first mesh says of one pose."""
    solution = solve_solid(
        mesh, E=MATERIAL.youngs_modulus, nu=MATERIAL.poissons_ratio, density=RHO,
        loads=[history(displacement_space(mesh)).chosen(pose)], line=("bore:A", "bore:B"), threads=1,
    )  # fmt: skip
    level = level_of(solution, 300.0)
    record = MeshRecord(elements=len(level.cells), unknowns=3 * len(level.nodes), error=0.1, seconds=1.0)
    return RefinedSolid(
        solution=solution, precision=precision([level], (), section=3.0, eyes=()), meshes=(record,), stopped="",
        far=False, accuracy=0.05, sharp_edges=0,
    )  # fmt: skip


def enveloped(mesh, refined):
    space = displacement_space(mesh)
    found = LinkMotion(
        space, link="bar", body=BODY, material=MATERIAL, histories=[history(space)],
        evaluated=np.ones(POSES, dtype=bool), stated="eye-faces", returns=True,
    ).envelope(refined=refined)  # fmt: skip
    [load_case] = found.load_cases.values()
    return load_case


def test_a_peak_at_a_pose_that_was_not_refined_for_bears_its_own_estimate(mesh):
    at_worst = enveloped(mesh, refined_at(mesh, 0))
    at_worst = enveloped(mesh, refined_at(mesh, at_worst.pose))
    assert ELSEWHERE not in at_worst.stress.sources
    other = int(np.argmin(at_worst.value))
    assert at_worst.value[other] < 0.9 * at_worst.stress.value
    confident = refined_at(mesh, other)
    # As if many meshes had settled the other pose: its band has no width.
    settled = tuple(
        replace(case, **{name: replace(case.series(name), low=case.series(name).value, high=case.series(name).value)
                         for name in ("von_mises", "principal")})
        for case in confident.precision
    )  # fmt: skip
    elsewhere = enveloped(mesh, replace(confident, precision=settled))
    assert ELSEWHERE in elsewhere.stress.sources
    assert elsewhere.stress.value == pytest.approx(at_worst.stress.value)
    assert elsewhere.stress.high > 1.05 * elsewhere.stress.value
    assert elsewhere.high[elsewhere.pose] == elsewhere.stress.high
    assert elsewhere.safety_factor.low == pytest.approx(MATERIAL.allowable / elsewhere.stress.high)
    fatigued = enveloped(mesh, replace(confident, precision=settled)).fatigue
    assert FATIGUE_ELSEWHERE in fatigued.stress.sources
    assert fatigued.stress.high > 1.05 * fatigued.stress.value


def test_a_peak_without_limit_has_no_curve(mesh):
    refined = refined_at(mesh, 0)
    growing = tuple(replace(case, von_mises=replace(case.von_mises, kind="growing")) for case in refined.precision)
    found = enveloped(mesh, replace(refined, precision=growing))
    assert not found.known
    assert found.safety_factor.unknowable
    for curve in (found.value, found.low, found.high):
        assert np.isnan(curve).all()
