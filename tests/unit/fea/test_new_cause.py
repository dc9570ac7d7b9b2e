"""A new cause goes into the bands of links and joints, by hand and on solids, by its file and a line in ``CAUSES``."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest
from edited_cases import edited

from alula.fea.beam.cut_free import link_loads
from alula.fea.check.run import check_case
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.fea.common.verdict import Quantity
from alula.fea.doubts import causes
from alula.fea.doubts.causes import CAUSES, OnLinks, Stated
from alula.fea.doubts.force_doubt import growths_by_hand, of_sizes
from alula.fea.links.link_by_hand import on_plates
from alula.fea.superposition.link_answers import LinkAnswers
from alula.loads.statics.statics import Reactions

SOURCE = Source(kind=SourceKind.LOAD, detail="gusts")
GUSTS, LULLS = (0.8, 1.25), (0.5, 1.1)


def times(loads: LinkLoads, factor: float) -> LinkLoads:
    return replace(
        loads,
        pins=tuple(replace(pin, wrench=factor * pin.wrench, friction=factor * pin.friction) for pin in loads.pins),
        couples=tuple(replace(one, torque=factor * one.torque) for one in loads.couples),
        ends=tuple(replace(end, wrench=factor * end.wrench) for end in loads.ends),
    )


def of_all(reactions: Reactions, factor: float) -> Reactions:
    return replace(
        reactions, joints={x: replace(one, wrench=factor * one.wrench) for x, one in reactions.joints.items()}
    )


def gusting(name: str, factors: tuple[float, float]) -> Callable[[Stated], OnLinks]:
    """Return a cause under which all that acts, but for weight, may be some times as large."""

    def rule(value: float, others: Sequence[float]) -> Scatter:
        every = [one / value for one in (value, *others)]
        return Scatter(low=min(every), high=max(every), sources=(SOURCE,))

    def found(stated: Stated) -> OnLinks:
        def answers(link: str) -> LinkAnswers:
            case, forces = stated.case, stated.forces
            acting = link_loads(stated.load_case, link, case.body(link), forces.reactions, stated.loads)
            others = tuple(on_plates(case, link, times(acting, factor)) for factor in factors)
            return LinkAnswers(stated=on_plates(case, link, acting), others=others, stress=rule, displacement=rule)

        reactions = stated.forces.reactions
        by_link = {link: answers(link) for link in stated.case.checked_links}
        growths = growths_by_hand(
            stated.case, reactions, [of_all(reactions, x) for x in factors], of_sizes(rule), by_link
        )
        return OnLinks(name=name, growths=growths, on_link=answers)

    return found


@pytest.mark.parametrize(("fidelity", "links", "wider"), [("beam", None, 1e-6), ("solid", ["crank"], 0.3)])
def test_two_new_causes_widen_every_band_and_move_no_value(monkeypatch, fidelity, links, wider) -> None:
    """On a solid the shares of a cause hold the error of its mesh as well."""
    case = edited("four-bar", ["load_cases.lift.own_weight=false", "solid.mesh_size=4.0"])
    plain = check_case(case, fidelity=fidelity, only=links)
    monkeypatch.setattr(causes, "CAUSES", (*CAUSES, gusting("gusts", GUSTS), gusting("lulls", LULLS)))
    found = check_case(case, fidelity=fidelity, only=links)
    before, after = (
        {
            (one.quantity, one.subject): one.value
            for one in result.load_cases["lift"].checks
            if one.quantity in (Quantity.SAFETY_FACTOR, Quantity.DEFLECTION)
            and (links is None or one.subject.name in links)
        }
        for result in (plain, found)
    )
    low, high = GUSTS[0] * LULLS[0], GUSTS[1] * LULLS[1]
    assert len(before) == (6 if links is None else 2)
    for key, band in before.items():
        least, most = (1.0 / high, 1.0 / low) if key[0] is Quantity.SAFETY_FACTOR else (low, high)
        assert after[key].value == pytest.approx(band.value, rel=1e-9)
        assert 1.0 - wider <= after[key].low / (least * band.low) <= 1.0 + 1e-6
        assert 1.0 - 1e-6 <= after[key].high / (most * band.high) <= 1.0 + wider
        assert SOURCE in after[key].sources
