"""Reasons and their sentences."""

import ast
from collections.abc import Iterator
from pathlib import Path

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


ROOT = Path(__file__).resolve().parents[3]


def kinds() -> Iterator[str]:
    """Yield the kinds that reasons are given in so many words."""
    for folder in ("geometry", "loads", "fea"):
        for file in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                match node:
                    case ast.Call(func=ast.Name(id="reason"), args=[ast.Constant(value=str(kind))]):
                        yield kind


def test_every_kind_has_a_sentence() -> None:
    assert sorted(set(kinds()) - catalogue.sentences().keys()) == []


def test_every_sentence_is_of_a_kind_that_something_gives() -> None:
    files = [file for folder in ("loads", "fea") for file in (ROOT / folder).rglob("*.py")]
    texts = "".join(file.read_text(encoding="utf-8") for file in files)
    assert [kind for kind in catalogue.sentences() if f'"{kind}"' not in texts] == []
