"""Reasons and their sentences."""

import pytest

from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.reports.sentences import catalogue


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> None:
    def several(links: tuple[str, ...]) -> str:
        return "one link" if len(links) == 1 else "several links"

    own = {"plain": "the limit {limit:plain} N", "share": "{share:3} of {links:and}", "outer": "{why}; {factor}"}
    monkeypatch.setattr(catalogue, "sentences", lambda: {**own, "many": several})


@pytest.mark.usefixtures("known")
def test_a_reason_is_told_with_its_facts() -> None:
    inner = reason("share", share=0.12345, links=["AE", "BC"])
    assert catalogue.told(inner) == "0.123 of AE and BC"
    assert catalogue.told(reason("outer", why=inner, factor=Band(value=2.0, low=1.0, high=3.0))) == (
        "0.123 of AE and BC; 2.00 (1.00 to 3.00)"
    )
    assert catalogue.told(reason("many", links=["AE"])) == "one link"
    assert catalogue.told("as the library says") == "as the library says"


def test_reasons_of_one_kind_with_the_same_facts_are_one() -> None:
    assert len({reason("share", links=["a"]), reason("share", links=("a",)), reason("share", links=("b",))}) == 2


@pytest.mark.usefixtures("known")
def test_a_fact_that_is_missing_is_an_error() -> None:
    with pytest.raises(KeyError):
        catalogue.told(reason("plain"))
