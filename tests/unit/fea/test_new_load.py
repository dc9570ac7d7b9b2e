"""A new kind of load is one class: a check and an envelope use it, and hand calculation knows nothing of it."""

from dataclasses import fields

import numpy as np
import pytest
import solid_meshes
from clip_load import Clip, ClippedLoads, ClipPressure
from turning_load import BODY, POSES, RHO, history

from alula.fea.elements.space import displacement_space
from alula.fea.motion.link_envelope import LinkMotion
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.tractions import link_tractions
from alula.geometry.materials.material import library

FORCE = 40.0
CARD = library()["pvc-u"].model_copy(update={"density": RHO})
E, NU = CARD.youngs_modulus, CARD.poissons_ratio


@pytest.fixture(scope="module")
def mesh():
    return solid_meshes.bar(around=12, radial=2, along=3, layers=2, tail=4.0)


def clipped(space) -> ClippedLoads:
    plain = history(space)
    given = {field.name: getattr(plain, field.name) for field in fields(plain)}
    return ClippedLoads(**given, clips=(Clip(pin="B", force=np.linspace(0.0, FORCE, POSES)),))


def test_a_new_kind_of_load_acts_in_checks_and_envelopes(mesh, monkeypatch) -> None:
    monkeypatch.setattr(link_tractions, "KINDS", (*link_tractions.KINDS, ClipPressure))
    space = displacement_space(mesh)
    loads = clipped(space)
    motion = LinkMotion(
        space, link="bar", body=BODY, material=CARD, histories=[loads], evaluated=np.ones(POSES, dtype=bool),
        stated="bore-shear", returns=True,
    )  # fmt: skip
    pose = POSES - 1
    direct, without = (
        solve_solid(
            mesh, E=E, nu=NU, density=RHO, loads=[one.chosen(pose)], line=("bore:A", "bore:B"),
            transfers=["bore-shear"], threads=1,
        )
        for one in (loads, history(space))
    )  # fmt: skip
    eye = np.unique(space.faces("top:B"))
    for number, case in enumerate(direct.cases):
        nodal, plain = (
            stress_field(space, one.cases[number].displacement, E=E, nu=NU).nodal for one in (direct, without)
        )
        pressed = (nodal - plain)[eye, 2].mean()
        assert pressed == pytest.approx(-FORCE / 25.0, rel=0.15)  # on the square eye of 5 mm, with its hole
        [curve] = [c for c in motion.curves["turn"] if (c.span, c.transfer) == (case.span, "bore-shear")]
        combined = np.einsum(
            "nim,m->ni", motion.measure.solved.stress, motion.measure.solved.combination[:, curve.first + pose]
        )
        assert np.abs(combined - nodal).max() < 2e-2 * np.abs(nodal).max()


def test_without_its_line_among_the_kinds_it_is_left_out(mesh) -> None:
    space = displacement_space(mesh)
    found = link_tractions.LinkTractions.of(space, [clipped(space)], density=RHO)
    assert ClipPressure not in {type(load) for load in found.loads}
