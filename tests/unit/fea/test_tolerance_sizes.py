"""Toleranced sizes: numbers between their ends against direct checks, masses and interpolation against closed forms."""

from types import SimpleNamespace

import numpy as np
import pytest

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject
from alula.fea.refine.refinement import Effort
from alula.fea.tolerance.analysis import tolerance_case
from alula.fea.tolerance.numbers import covered
from alula.fea.tolerance.sizes import SizeChange, resized, size_ends
from alula.fea.tolerance.states import Sampler
from alula.geometry.base.errors import AlulaError, CaseError
from alula.loads.case.case_file import read_case
from alula.loads.case.toleranced import toleranced
from alula.loads.states.masses import part_masses
from benchmarks.tolerances import direct_case

TEXT = """
schema_version = 1
title = "lever"
large_displacement = "off"
pose = { coordinate = "arm", angle = "20 deg" }
drive = { link = "arm", joint = "O" }
[links.base]
ground = true
points = { O = ["0 mm", "0 mm"], Q = ["0 mm", "9 mm"] }
[links.arm]
part = "bar"
points = { O = ["0 mm", "0 mm"], P = ["30 mm", "0 mm"] }
[joints]
O = { links = ["base", "arm"], pin_diameter = "3 mm" }
[parts.bar]
shape = "bar"
material = "pla-fdm-xy"
width = "8 mm"
thickness = "4 mm"
fillet_radius = "2 mm"
[parts.spare]
shape = "bar"
material = "pla-fdm-xy"
width = "8 mm"
thickness = "4 mm"
fillet_radius = "2 mm"
[load_cases.pull]
own_weight = true
[[load_cases.pull.forces]]
link = "arm"
at = "P"
force = ["0 N", "-10 N"]
[checks.strength]
type = "safety-factor"
[checks.bend]
type = "displacement"
maximum = "5 mm"
[checks.tip]
type = "displacement"
at = "P"
maximum = "5 mm"
[checks.pins]
type = "pins"
[checks.bearing]
type = "bearing"
"""
ONE_MESH = Effort(max_meshes=1)
SIZES = {"parts.bar.thickness": "0.4 mm", "joints.O.pin_diameter": "0.3 mm"}


@pytest.fixture(scope="module")
def lever(tmp_path_factory):
    path = tmp_path_factory.mktemp("sizes") / "lever.toml"
    path.write_text(TEXT, encoding="utf-8")
    return read_case(str(path))


@pytest.fixture(scope="module")
def sampled(lever):
    """The lever with every tolerance at either end, so that all corners are among the samples."""
    stated = {**SIZES, "load_cases.pull.forces.0": "20 %", "pose.angle": "8 deg"}
    corners = {path: {"plus_minus": half, "distribution": "worst case"} for path, half in stated.items()}
    case = lever.with_values({"tolerances": corners})
    return case, tolerance_case(case, samples=500, threads=1, effort=ONE_MESH)


def told(result, name):
    return next(one for one in result.numbers if one.check == name)


def test_samples_are_those_of_direct_checks_at_corners_of_two_sizes(sampled):
    """Load and pose are off as well, so that the solids of both ends are met by other loads than their own."""
    case, result = sampled
    variables, rows = toleranced(case), result.deviations
    for sample in (0, np.flatnonzero((rows[:, :2] * rows[0, :2] < 0.0).all(axis=1))[0]):
        direct = check_case(
            direct_case(case, variables, rows[sample]), fidelity="solid", threads=1, effort=ONE_MESH
        )  # fmt: skip
        compared = 0
        for own in direct.load_cases["pull"].checks:
            if not covered(case, own):
                continue
            one, compared = told(result, own.name), compared + 1
            assert one.low[sample] <= own.value.value <= one.high[sample]
            # the peak of another mesh differs by some percent; pins and displacements have no such noise
            noise = 0.03 if own.name == "strength" else 0.005
            assert one.values[sample] == pytest.approx(own.value.value, rel=noise), own.name
        assert compared == sum(one.certain is not None for one in result.numbers) >= 5


def test_torque_follows_the_weight_of_a_thickness(lever):
    """The arm without its force: T = m g x_c, and m is proportional to the thickness of a bar as thick as its eyes."""
    case = lever.with_values({"load_cases.pull.forces": [], "tolerances": {"parts.bar.thickness": "0.2 mm"}})
    variables = toleranced(case)
    [ends] = size_ends(case, variables)
    sampler = Sampler(
        case=case,
        pose=case.solve_pose(),
        masses=part_masses(case),
        variables=variables,
        reaches={"parts.bar.thickness": ends.masses},
    )
    rows = np.linspace(-0.2, 0.2, 9)[:, None]
    torque = sampler.states(rows).forces["pull"].drive_torque
    assert torque[4] > 0.0
    assert torque == pytest.approx(torque[4] * (1.0 + rows[:, 0] / 4.0), rel=1e-6)


OUTCOME = CheckOutcome.of("strength", Subject.link("arm"), "pull", Quantity.SAFETY_FACTOR, Band.exact(5.0), 1.0)


def change(t, low, high):
    """A size whose numbers at its ends are known."""
    ends = np.log(np.array([low, high])[:, None, None] * np.ones((2, 3, 1)))
    return SimpleNamespace(t=np.array(t), logarithms=lambda outcome, bands: (ends[0], ends[1]))


@pytest.mark.parametrize("power", [1.0, 2.0, -1.0])
def test_what_interpolation_does_not_know_is_in_the_band(power):
    """A power of D - d, 10 ± 0.4 less 6 ± 0.3: the mixed part, which the ends do not tell, is in the band."""
    f = lambda D, d: ((D - d) / 4.0) ** power  # noqa: E731
    t = np.random.default_rng(0).uniform(-1.0, 1.0, (2, 400))
    outer = change(t[0], f(9.6, 6.0), f(10.4, 6.0))
    inner = change(t[1], f(10.0, 5.7), f(10.0, 6.3))
    value, low, high = resized(OUTCOME, np.ones((3, 400)), [outer, inner])
    true, third_order = f(10.0 + 0.4 * t[0], 6.0 + 0.3 * t[1]), 0.003
    assert (low <= true * (1.0 + third_order)).all()
    assert (true <= high * (1.0 + third_order)).all()
    assert np.abs(value / true - 1.0).max() > 0.007  # which a band of no width would miss
    assert np.median(high / low - 1.0) < 0.02


def test_powers_of_one_size_are_interpolated_to_a_permille():
    t = np.linspace(-1.0, 1.0, 41)
    value, low, high = resized(OUTCOME, np.ones((3, 41)), [change(t, 0.9**3, 1.1**3)])
    assert value == pytest.approx((1.0 + 0.1 * t) ** 3, rel=5e-4)
    assert (low <= (1.0 + 0.1 * t) ** 3 * (1.0 + 1e-12)).all()
    assert ((1.0 + 0.1 * t) ** 3 <= high * (1.0 + 1e-12)).all()


def test_ends_are_a_tenth_off_where_the_rules_allow_that(lever):
    """An eye may not be narrower than its bar, so that its ends are those of its tolerance."""
    case = lever.with_values(
        {
            "parts.bar.eye_diameter": "8.4 mm",
            "tolerances": {"parts.bar.thickness": "0.1 mm", "parts.bar.eye_diameter": "0.2 mm"},
        }
    )
    thick, eye = size_ends(case, toleranced(case))
    assert (thick.reach, eye.reach) == pytest.approx((0.4, 0.2))
    assert thick.links == {"arm"}
    assert thick.joints == {"O"}


def test_ends_of_a_case_with_friction_have_both_directions(lever):
    case = lever.with_values({"joints.O.friction": 0.2, "tolerances": {"parts.bar.thickness": "0.1 mm"}})
    [thick] = size_ends(case, toleranced(case))
    assert set(thick.low.frames) == set(thick.low.case.load_cases) == {"pull forward", "pull backward"}


@pytest.mark.parametrize(
    ("path", "half", "said"),
    [
        ("parts.bar.thickness", "4 mm", "as large as the size itself"),
        ("parts.bar.thickness", "1 deg", "not a unit of length"),
        ("parts.bar.shape", "1 mm", "no such size"),
        ("parts.bar.overhang", "1 mm", "no such size"),
        ("parts.bar.widths.0.1", "1 mm", "no such size"),
        ("joints.X.pin_diameter", "1 mm", "no such size"),
        ("parts.spare.width", "1 mm", "no link and no pin"),
        ("parts.bar.width", "5.5 mm", "at 2.5 mm"),
    ],
)
def test_sizes_that_do_not_go_are_refused(lever, path, half, said):
    with pytest.raises(AlulaError, match=said):
        size_ends(case := lever.with_values({"tolerances": {path: half}}), toleranced(case))


def test_a_case_without_file_has_no_other_sizes(lever):
    case = lever.model_copy(update={"title": "x"})
    with pytest.raises(CaseError, match="built or changed in Python"):
        size_ends(case, toleranced(lever.with_values({"tolerances": SIZES})))


def test_an_upper_end_without_limit_at_one_size_leaves_the_others_known():
    """Layers that are clear of their limit have none: infinite at both ends, it was subtracted from itself."""
    t = np.linspace(-1.0, 1.0, 5)
    result = SimpleNamespace(load_cases={"pull": SimpleNamespace(checks=[OUTCOME])})
    at = SimpleNamespace(check=SimpleNamespace(result=result))
    far = SimpleNamespace(bands=lambda outcome: np.array([[5.0], [4.0], [np.inf]]) * np.ones((3, 5)), **vars(at))
    ends = SimpleNamespace(links=frozenset({"arm"}), joints=frozenset())
    one = SizeChange(ends=ends, t=t, low=far, high=far)
    value, low, high = resized(OUTCOME, np.array([[5.0], [4.0], [8.0]]) * np.ones((3, 5)), [one])
    assert value == pytest.approx(5.0)
    assert low == pytest.approx(4.0)
    assert np.isnan(high).all()
