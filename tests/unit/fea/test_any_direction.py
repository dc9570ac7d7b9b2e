"""Printed parts that do not say how they were built: no direction may be the worse for it."""

from functools import cache

import numpy as np
import pytest
from edited_cases import edited
from materials import with_material

from alula.fea.check.run import check_case
from alula.fea.common.source import SourceKind
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.outcomes.limits import layer_limit
from alula.fea.solid.layers import in_worst_direction, on_plane
from alula.geometry.materials.material import library
from alula.geometry.materials.printable import is_printed, is_solid_stock
from alula.reports.sentences import told as in_words

PLA = library()["pla-fdm-xy"]


@cache
def crank(load, *, stated=False, fidelity="beam", **lost):
    """The crank of the four-bar, under a load [N]."""
    case = edited("four-bar", [f"load_cases.lift.forces.0.force=['0 N','-{load:g} N']"])
    if not stated:
        case = case.model_copy(
            update={"parts": {"bar": case.parts["bar"].model_copy(update={"build_direction": None})}}
        )
    case = with_material(case, "pla-fdm-xy", PLA.model_copy(update=lost))
    checks = check_case(case, fidelity=fidelity, only={"crank"}).load_cases["lift"].checks
    [found] = [c for c in checks if c.quantity is Quantity.SAFETY_FACTOR and c.link == "crank"]
    return found


NO_LAYERS = dict.fromkeys(name for name in type(PLA).model_fields if "layers" in name)


def told(outcome):
    return any(source.kind is SourceKind.BUILD for source in outcome.value.sources)


def test_a_pass_needs_the_weakest_direction_and_a_fail_the_strongest():
    along = crank(1.5, **NO_LAYERS)
    assert along.verdict is Verdict.PASS
    found = crank(1.5)
    assert (found.verdict, found.value.high) == (Verdict.UNDECIDED, along.value.high)
    assert "states no build_direction" in in_words(found.reason)
    ratio = found.value.low / along.value.low
    assert 12.0 / 23.0 / 1.5 < ratio < 12.0 / 23.0 / 1.1, "tension across layers and shear along them, least strengths"
    assert crank(0.5).verdict is Verdict.PASS, "in all directions"
    assert told(crank(0.5))
    assert crank(200.0).verdict is Verdict.FAIL, "in all directions"


def test_a_solid_is_solved_where_it_may_tell_that_the_weakest_direction_holds():
    """Its band by hand is clear of the limit along the layers, and holds the one across them."""
    assert crank(1.0).verdict is Verdict.UNDECIDED
    assert crank(1.0, fidelity="auto").verdict is Verdict.PASS


@cache
def layers(load, fidelity, **lost):
    """Outcome of the crank's layers, built along its pins, under a load [N]."""
    case = edited("four-bar", [f"load_cases.lift.forces.0.force=['0 N','-{load:g} N']", "links.rocker.end_patch=8 mm"])
    case = with_material(case, "pla-fdm-xy", PLA.model_copy(update=lost))
    checks = check_case(case, fidelity=fidelity, only={"crank"}).load_cases["lift"].checks
    [found] = [c for c in checks if c.quantity is Quantity.LAYERS and c.link == "crank"]
    return found


def test_by_hand_layers_of_a_stated_direction_have_the_least_of_all_directions():
    found = layers(5.0, "beam")
    assert (found.verdict, found.value.high) == (Verdict.UNDECIDED, np.inf)
    assert found.value.value < layers(5.0, "auto").value.value, "its solid tells more"
    assert "--fidelity solid" in in_words(found.reason)
    assert layers(0.5, "beam").verdict is Verdict.PASS
    lost = {"shear_strength_between_layers": None, "shear_strength_between_layers_range": None}
    assert layers(0.1, "beam", **lost).verdict is Verdict.UNDECIDED


def test_without_a_shear_strength_no_direction_is_sure():
    lost = {"shear_strength_between_layers": None, "shear_strength_between_layers_range": None}
    found = crank(0.1, **lost)
    assert (found.verdict, found.value.low) == (Verdict.UNDECIDED, 0.0)
    assert "states no shear_strength_between_layers" in in_words(found.reason)


def test_a_stated_direction_and_a_card_without_layers_leave_the_factor_as_it_is():
    stated = crank(1.5, stated=True)
    assert stated.value == crank(1.5, **NO_LAYERS).value
    assert not told(stated)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 4.0])
def test_the_bound_holds_all_directions_and_is_no_more_than_a_sixth_above_them(ratio):
    """Against planes turned by brute force, for stress of all kinds; 2/sqrt(3) where v is that of pure shear."""
    rng = np.random.default_rng(7)
    planes = rng.normal(size=(20_000, 3))
    for scale in rng.uniform(0.0, 1.0, size=(60, 3, 1)):
        a = rng.normal(size=(3, 3)) * scale
        tensor = (a + a.T) / 2.0
        sigma = tensor[[0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
        tension, shear = on_plane(sigma, planes)
        worst = np.hypot(np.maximum(tension, 0.0), ratio * shear).max()
        first, second, third = np.linalg.eigvalsh(tensor)
        mises = np.sqrt(((first - second) ** 2 + (second - third) ** 2 + (third - first) ** 2) / 2.0)
        bound = in_worst_direction(max(third, 0.0), mises, ratio)
        assert worst * (1.0 - 1e-9) <= bound <= 1.16 * worst


def test_the_bound_of_a_pull_and_of_a_push():
    """A pull p in steps by hand: c = p - p/sqrt(3), r = p/sqrt(3), x = c/3r; a push has shear alone."""
    c, r = 1.0 - 3.0**-0.5, 3.0**-0.5
    x = c / (3.0 * r)
    assert in_worst_direction(1.0, 1.0, 2.0) == pytest.approx(((c + r * x) ** 2 + 4.0 * r**2 * (1.0 - x**2)) ** 0.5)
    assert in_worst_direction(0.0, 1.0, 2.0) == pytest.approx(2.0 * r)
    assert in_worst_direction(1.0, 0.0, 2.0) == pytest.approx(1.0), "the same in all directions"
    assert in_worst_direction(0.0, 0.0, 2.0) == 0.0


@pytest.mark.parametrize(
    ("title", "printed", "stock"),
    [
        ("PETG, fused filament", True, False),
        ("Tough UV resin, post-cured", True, False),
        ("Polyamide 12, laser-sintered", True, False),
        ("Stainless steel 304", False, True),
        ("Stainless steel 316L, printed by DMLS", True, False),
        ("Unplasticised PVC, pressure-pipe grade", False, True),
        ("nylon", False, False),
    ],
)
def test_what_a_card_tells_of_printing(title, printed, stock):
    card = PLA.model_copy(update=dict.fromkeys(NO_LAYERS) | {"title": title})
    assert (is_printed(card), is_solid_stock(card)) == (printed, stock)


@pytest.mark.parametrize("material", ["aluminium-6061-t6", "pvc-u"])
def test_the_starter_in_another_material_has_no_layers(material):
    case = edited("four-bar", [f'parts.bar.material="{material}"'])
    assert layer_limit(case, "crank") is None
    assert layer_limit(edited("four-bar", []), "crank") == 6.0
