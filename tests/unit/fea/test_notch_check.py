"""A check of notches: of which links it is asked, what is refused, and how its band is made, judged and told."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from edited_cases import edited

from alula.fea.asked.asked import asked
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.doubts.load_growth import Growths
from alula.fea.judging import notches
from alula.fea.judging.link_result import by_hand_shares
from alula.fea.modes.notches import NotchFactor
from alula.fea.outcomes.limits import layer_limit, layers_of
from alula.fea.refine.refinement import Effort
from alula.fea.solid.notch_field import NotchStress
from alula.geometry.base.errors import CaseError
from alula.loads.records.check_spec import NotchCheck
from alula.reports.check.modes import mode_parts, mode_records
from alula.reports.sentences import told

CHECK = 'checks.cracks={ type = "notch", minimum = 1.5, links = ["front"] }'
RESIN = 'parts.front.material="resin-405nm"'
OWN = (
    'materials.own={{ title = "Resin", density = "1150 kg/m^3", youngs_modulus = "2 GPa", poissons_ratio = 0.38, '
    'ultimate_strength = "40 MPa", strength = "ultimate", minimum_safety_factor = 2.0{}, '
    "sources = {{}}, status = {{}} }}"
)
TOUGH = ', inherent_strength = "50 MPa", critical_distance = "0.2 mm"'
BY_VOLUME = ', weibull_modulus = 10.0, weibull_volume = "1000 mm^3"'
FOUND = NotchFactor(
    factor=Band(value=2.0, low=1.6, high=2.4),
    location=np.array([1.0, 2.0, 3.0]),
    surface=30.0,
    distance=0.2,
    point=20.0,
    line=18.0,
    relieved=True,
    by_point=2.0,
    by_line=2.2,
)


def own(more):
    return [CHECK, OWN.format(more), 'parts.front.material="own"']


def place(ahead, use, *, counts=True):
    return NotchStress(node=0, surface=30.0, ahead=ahead, plain=5.0, use=use, elements=np.array([0]), counts=counts)


class Solved:
    """A refined solid of one place, two variants and a mesh that misses 1 MPa (2.25 times 4/9)."""

    def __init__(self, monkeypatch, uses, *, volume=None, spans=(180, 180), transfers=(None, None), known=True):
        self.precision = [
            SimpleNamespace(
                principal=SimpleNamespace(
                    factor=2.25, index=0.1, kind="one mesh", high=1.1, low=0.9, rule=reason("by_index", factor=1.25)
                ),
                known=lambda quantity: known,
            )
        ] * len(spans)
        figures = SimpleNamespace(estimate=SimpleNamespace(stress=np.array([4.0 / 9.0])))
        self.levels = [SimpleNamespace(chord=0.0, figures=[figures] * len(spans))]
        cases = [
            SimpleNamespace(load="loads", transfer=transfer, span=span, displacement=n)
            for n, (span, transfer) in enumerate(zip(spans, transfers, strict=False))
        ]
        self.solution = SimpleNamespace(cases=cases, space=SimpleNamespace(nodes=np.ones((1, 3))), E=1.0, nu=0.3)
        self.sharp_edges = 0
        monkeypatch.setattr(notches, "stress_field", lambda space, number, E, nu: number)
        monkeypatch.setattr(
            notches,
            "NotchField",
            lambda field: SimpleNamespace(
                surface=np.array([30.0]),
                field=SimpleNamespace(space=self.solution.space),
                worst=lambda strength: uses[field](strength),
                effective_volume=lambda modulus: volume,
            ),
        )

    def factor(self, case):
        [one] = asked(case, NotchCheck)
        return notches.notch_factor(case, one, "loads", SimpleNamespace(check=None), self)


def same(point, line):
    """What a place uses up under any strength that the card may have."""
    return lambda strength: (place(20.0, point), place(18.0, line))


def test_the_band_holds_both_methods_and_the_mesh(monkeypatch):
    case = edited("knee", own(TOUGH))
    found = Solved(monkeypatch, [same(0.40, 0.50)], spans=(180,)).factor(case)
    assert found.factor.value == pytest.approx(1.0 / 0.40)
    assert found.factor.low == pytest.approx(1.0 / (0.50 + 1.0 / 40.0))
    assert found.factor.high == pytest.approx(1.0 / (0.40 - 1.0 / 40.0))
    assert (found.by_point, found.by_line) == (pytest.approx(2.5), pytest.approx(2.0))


def test_the_worse_variant_counts_and_contact_adds_to_the_narrow_pressure(monkeypatch):
    case = edited("knee", own(TOUGH))
    for uses, spans in (
        ((same(0.40, 0.40), same(0.60, 0.60)), (180, 90)),
        ((same(0.60, 0.60), same(0.40, 0.40)), (90, 180)),
    ):
        found = Solved(monkeypatch, uses, spans=spans).factor(case)
        assert found.factor.value == pytest.approx(1.0 / 0.60)
        assert found.factor.low == pytest.approx((1.0 - notches.CONTACT_SHORTFALL) / (0.60 + 1.0 / 40.0))
        assert found.factor.high == pytest.approx(1.0 / (0.40 - 1.0 / 40.0))


def test_another_transfer_of_a_torque_widens_the_band_alone(monkeypatch):
    case = edited("knee", own(TOUGH))
    other = "bore-shear" if case.torque_transfer == "eye-faces" else "eye-faces"
    for uses, transfers in (((0.4, 0.6), (case.torque_transfer, other)), ((0.6, 0.4), (other, case.torque_transfer))):
        every = [same(use, use) for use in uses]
        found = Solved(monkeypatch, every, transfers=transfers).factor(case)
        assert found.factor.value == pytest.approx(1.0 / 0.4)
        assert found.factor.low == pytest.approx(1.0 / (0.6 + 1.0 / 40.0))


def test_ranges_of_the_card_widen_the_band(monkeypatch):
    more = TOUGH + ', critical_distance_range = ["0.1 mm", "0.3 mm"]'

    def by_distance(strength):
        use = {0.1: 0.8, 0.2: 0.5, 0.3: 0.25}[strength.distance]
        return place(20.0, use), place(20.0, use)

    found = Solved(monkeypatch, [by_distance], spans=(180,)).factor(edited("knee", own(more)))
    ends = found.factor.low, found.factor.value, found.factor.high
    assert ends == pytest.approx((1.0 / 0.825, 2.0, 1.0 / 0.225))
    assert "stated ranges at notches" in " ".join(map(told, found.factor.texts))


@pytest.mark.parametrize(("volume", "share"), [(1000.0, 30.0 / 40.0), (1.0, 30.0 / 40.0 * 0.001**0.1)])
def test_strength_by_volume(monkeypatch, volume, share):
    """Of as much volume as the specimens have it is theirs; a thousandth bears 1000^(1/m) as much.

    The link is a pair: that of both plates counts.
    """
    case = edited("knee", own(BY_VOLUME))
    assert case.links["front"].count == 2
    found = Solved(monkeypatch, [same(0.0, 0.0)], volume=volume / 2.0, spans=(180,)).factor(case)
    ends = found.factor.low, found.factor.value, found.factor.high
    assert ends == pytest.approx((1.0 / (1.1 * share), 1.0 / share, 1.0 / (0.9 * share)))
    assert found.distance is None
    assert found.effective_volume == volume


def test_the_range_of_the_tensile_strength_is_none_of_notches(monkeypatch):
    case = edited("knee", own(TOUGH + ', strength_range = ["30 MPa", "60 MPa"]'))
    found = Solved(monkeypatch, [same(0.4, 0.4)], spans=(180,)).factor(case)
    assert "stated ranges at notches" not in " ".join(map(told, found.factor.texts))


@pytest.mark.parametrize(("use", "low"), [(0.4, 30.0 / 36.0), (1.5, 1.0 / (1.5 + 1.0 / 30.0))])
def test_the_edge_of_a_clamp_counts_at_the_weakest_strength(monkeypatch, use, low):
    case = edited("knee", own(TOUGH + ', strength_range = ["30 MPa", "60 MPa"]'))
    monkeypatch.setattr(notches, "edge_stress", lambda body, beam, largest: 36.0)
    assert Solved(monkeypatch, [same(use, use)], spans=(180,)).factor(case).factor.low == pytest.approx(low)


@pytest.mark.parametrize(("use", "decides"), [(0.5, 30.0 / 40.0), (0.9, 0.9)])
def test_the_lower_of_distance_and_volume_counts(monkeypatch, use, decides):
    found = Solved(monkeypatch, [same(use, use)], volume=500.0, spans=(180,)).factor(
        edited("knee", own(TOUGH + BY_VOLUME))
    )
    assert found.factor.value == pytest.approx(1.0 / decides)
    assert (found.by_point, found.by_volume) == (pytest.approx(1.0 / use), pytest.approx(40.0 / 30.0))


def test_without_tension_the_mesh_alone_leaves_it_open(monkeypatch):
    found = Solved(monkeypatch, [lambda strength: None], spans=(180,)).factor(edited("knee", own(TOUGH)))
    assert (found.factor.low, found.factor.high) == (pytest.approx(40.0), np.inf)
    assert "nowhere in tension" in told(notches.notch_said(found))


def judged(monkeypatch, found, case=None, growth=None):
    """Return the outcome where each plate has what was found."""
    case = case or edited("knee", own(TOUGH))
    factors = iter(found)
    monkeypatch.setattr(notches, "notch_factor", lambda *of: next(factors))
    monkeypatch.setattr(notches, "bending_growth", lambda *of: Scatter())
    plates = [SimpleNamespace(name=f"plate {n}") for n in range(len(found))]
    cases = [SimpleNamespace(load=plate.name) for plate in plates]
    decided = {"front": SimpleNamespace(solid=SimpleNamespace(solution=SimpleNamespace(cases=cases)))}
    doubts = growth or Growths(), by_hand_shares(Growths(), "front")
    load_case = next(iter(case.load_cases))
    here = SimpleNamespace(
        case=case,
        load_case=load_case,
        loads=lambda link: plates,
        hands=lambda link: [None for _ in plates],
        decided=decided,
        links={"front": None},
        doubts=lambda link: doubts,
    )
    [one] = asked(case, NotchCheck)
    judged = notches.judge_notches(here, one)
    return judged.outcome, judged.numbers[0] if judged.numbers else None


@pytest.mark.parametrize(
    ("low", "high", "verdict"), [(1.5, 3.0, Verdict.PASS), (1.4, 3.0, Verdict.UNDECIDED), (1.0, 1.45, Verdict.FAIL)]
)
def test_the_whole_band_is_judged(monkeypatch, low, high, verdict):
    outcome, _ = judged(monkeypatch, [replace(FOUND, factor=Band(value=low, low=low, high=high))])
    assert outcome.verdict is verdict
    assert (outcome.subject.name, outcome.limit, outcome.quantity) == ("front", 1.5, Quantity.NOTCHES)
    assert "20 MPa at half the critical distance of 0.2 mm" in told(outcome.reason)


def test_the_worse_plate_and_scatter_of_loads_count(monkeypatch):
    weak = replace(FOUND, factor=Band(value=1.8, low=1.2, high=2.0))
    case = edited("knee", [*own(TOUGH), "load_cases.heel-strike.scatter=[0.5, 2.0]"])
    for plates in ([FOUND, weak], [weak, FOUND]):
        outcome, found = judged(monkeypatch, plates, case)
        assert (outcome.value.low, outcome.value.high) == (pytest.approx(0.6), pytest.approx(4.0))
        assert found.factor == outcome.value


def test_a_plate_that_is_not_known_leaves_it_open(monkeypatch):
    for plates in ([FOUND, reason("idle_link")], [reason("idle_link"), FOUND]):
        outcome, found = judged(monkeypatch, plates)
        assert outcome.verdict is Verdict.UNDECIDED
        assert found is None


def test_a_peak_without_limit_is_not_judged(monkeypatch):
    solved = Solved(monkeypatch, [same(0.4, 0.4)], spans=(180,), known=False)
    monkeypatch.setattr(notches, "judged", lambda *of: SimpleNamespace(reason=reason("idle_link")))
    assert solved.factor(edited("knee", own(TOUGH))) == reason("idle_link")


def test_where_nothing_is_taken_off_it_says_so():
    assert "nothing is taken off 30 MPa" in told(notches.notch_said(replace(FOUND, relieved=False)))
    by_volume = replace(FOUND, distance=None, effective_volume=12.0, by_volume=3.0)
    assert told(notches.notch_said(by_volume)).startswith("12 mm³ evenly")


def test_by_hand_it_is_open_and_names_the_remedy():
    result = check_case(edited("knee", [CHECK, RESIN]), fidelity="beam")
    checks = [one for case in result.load_cases.values() for one in case.checks if one.quantity is Quantity.NOTCHES]
    assert len(checks) == 2
    assert {one.verdict for one in checks} == {Verdict.UNDECIDED}
    assert all("--fidelity solid" in told(one.reason) for one in checks)


def test_layers_are_judged_with_notches_alone():
    """Notches are judged along the layers, so that a link of weak layers must not pass by them."""
    pla = 'parts.front.material="pla-fdm-xy"', "parts.front.build_direction=[1,0,0]"
    case = edited("knee", ['checks={ cracks={ type = "notch", minimum = 1.5, links = ["front"] } }', *pla])
    assert layer_limit(case, "front") == 1.5
    assert layers_of(case, "front").across == 12.0
    result = check_case(case, fidelity="beam")
    every = [one for found in result.load_cases.values() for one in found.checks]
    assert len([one for one in every if one.quantity is Quantity.LAYERS]) == len(result.load_cases)


def test_from_the_case_to_the_page():
    """The link is solved although its safety factor is clear by hand; its notches are not weaker than its surface."""
    entries = CHECK, RESIN, "checks.strength.minimum=0.1", "solid.mesh_size=1.6"
    result = check_case(edited("knee", entries), effort=Effort(max_meshes=1))
    for case in result.load_cases.values():
        [found] = case.of_links(NotchFactor).values()
        assert found.relieved
        assert found.point < found.surface
        assert found.distance == pytest.approx(0.226, abs=0.002)
        safety = case.links["front"].safety_factor
        assert safety.value < found.by_point < 1.5 * safety.value
        [record] = mode_records(case)["notches"]
        assert record["by_line"] == found.by_line
        [table] = [part for part in mode_parts(case) if part.key == "notches"]
        assert len(table.rows) == 1


@pytest.mark.parametrize(
    ("entries", "says"),
    [
        ([], "yields at a notch before it breaks; leave this check out"),
        (['parts.front.material="pla-fdm-xy"'], "build_direction"),
        (['parts.front.material="petg-fdm-xy"'], "tells nothing of notches"),
        ([RESIN, 'checks.cracks.links=["nowhere"]'], "is no link with a part"),
    ],
)
def test_links_that_it_cannot_judge_are_refused(entries, says):
    with pytest.raises(CaseError, match=says):
        edited("knee", [CHECK, *entries])
