"""One measure of a link: each number in each state, by unit loads, load vectors and samples, on halves and wholes."""

from dataclasses import replace
from functools import cache

import pytest
import solid_meshes
from turning_load import BODY, POSES, RHO, history

from alula.fea.elements.space import displacement_space
from alula.fea.refine.link_task import ElasticLink
from alula.fea.solid.layers import Layers
from alula.fea.solid.solution import solve_solid
from alula.fea.solid.stress import stress_field
from alula.fea.superposition.link_measure import LinkMeasure
from alula.fea.tolerance.link_response import LinkResponse
from alula.geometry.materials.material import library
from alula.geometry.meshing.mirror import mirrored

LAYERS = Layers(normal=(1.0, 0.5, 1.0), across=12.0, between=5.0)
LINK = ElasticLink.of(BODY, library()["pvc-u"].model_copy(update={"density": RHO}), LAYERS)
QUANTITIES = ("von_mises", "principal", "layers", "displacement")
SOME = (0, 5, 14)


@cache
def mesh(halves):
    found = mirrored(solid_meshes.half_bar(around=12, radial=2, along=2, layers=1, tail=4.0))
    return found if halves else replace(found, mirror=None)


@cache
def measure(halves):
    space = displacement_space(mesh(halves))
    return LinkMeasure.of_units(LINK, space, [history(space)], threads=1)


@cache
def of_some(halves):
    space = displacement_space(mesh(halves))
    return LinkMeasure.of_loads(LINK, space, [history(space).chosen(pose) for pose in SOME], threads=1)


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("found", [measure, of_some])
def test_the_upper_half_tells_the_peaks_of_the_whole_link(found, quantity):
    """Oblique layers too, which the lower half has otherwise."""
    half, whole = found(True), found(False)
    assert len(whole.solved.nodes) > 1.6 * len(half.solved.nodes)
    one, other = half.peaks(quantity), whole.peaks(quantity)
    assert one.value == pytest.approx(other.value, rel=1e-9)
    assert one.image.any() == (quantity == "layers")
    nodes = half.solved.space.nodes
    assert (nodes[one.node[one.image], 2] >= 0.0).all()


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_every_state_has_its_direct_peaks(quantity):
    """By its load vector exactly, by unit loads within what their series leaves out."""
    space, exact, units = displacement_space(mesh(True)), of_some(True), measure(True)
    peaks, summed = exact.peaks(quantity).value, units.peaks(quantity).value
    for variant in exact.variants:
        pose = SOME[variant.record]
        solved = solve_solid(
            mesh(True), E=LINK.E, nu=LINK.nu, density=RHO, loads=[history(space).chosen(pose)], line=LINK.line,
            laws=[variant.law], transfers=[variant.transfer or "bore-shear"], threads=1,
        )  # fmt: skip
        nodal = stress_field(space, solved.cases[0].displacement, E=LINK.E, nu=LINK.nu)
        direct = {
            "von_mises": nodal.von_mises.max(),
            "principal": nodal.principal[:, 0].max(),
            "layers": LAYERS.stress(nodal.nodal).max(),
            "displacement": solved.cases[0].displacement_max,
        }[quantity]
        assert peaks[variant.loads] == pytest.approx(direct, rel=1e-6)
        [same] = [one for one in units.variants if (one.law, one.transfer) == (variant.law, variant.transfer)]
        assert summed[same.loads][pose] == pytest.approx(direct, rel=2e-2)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_samples_have_the_peaks_of_their_states(quantity):
    """Where the samples are the pilots; the spline of pressures by direction is all that differs."""
    loads = history(displacement_space(mesh(True)))
    response = LinkResponse(measure=measure(True), stated="bore-shear", pilots={loads.name: loads})
    peaks = measure(True).peaks(quantity).value
    for variant, found in response.peaks(quantity, loads).items():
        assert len(found) == POSES
        assert found == pytest.approx(peaks[variant.loads], rel=1e-3)


@pytest.mark.parametrize("pose", SOME)
def test_contact_and_the_error_of_layers_widen_a_band(pose):
    found = measure(True)
    wide, narrow = (next(v for v in found.variants if v.law.span == span) for span in (180, 90))
    for variant, share in ((wide, 1.0), (narrow, 0.94)):
        load, node = variant.loads.start + pose, int(found.peaks("von_mises").node[variant.loads.start + pose])
        low, high = found.ends("von_mises", load, node, 1000.0)
        _, most = found.ends("layers", load, node, 1000.0)
        assert share * high - 1000.0 == pytest.approx(1000.0 - low, abs=1e-6)
        assert share * most - 1000.0 == pytest.approx(LAYERS.sensitivity * (1000.0 - low), abs=1e-6)
