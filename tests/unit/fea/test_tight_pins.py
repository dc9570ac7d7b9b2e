"""What would decide a check that couples between layers leave open."""

from types import SimpleNamespace

import pytest

from alula.fea.common.band import Band
from alula.fea.common.scatter import Scatter
from alula.fea.common.verdict import Quantity, Verdict
from alula.fea.doubts.tight_pins import SharedCouples


@pytest.mark.parametrize(("quick", "whole", "decides"), [(1.1, 1.2, True), (1.1, 2.9, False), (2.9, 1.1, False)])
def test_a_fit_decides_where_a_whole_search_says_so_too(monkeypatch, quick: float, whole: float, decides: bool) -> None:
    """A factor of 5 (1.7 to 5) against 2 by couples of up to 3: a stress of up to 2.5 times passes."""
    searches = list[bool]()

    def left(self: SharedCouples, link: str, joints: tuple[str, ...], *, whole: bool = False) -> Scatter:
        searches.append(whole)
        return Scatter(high=highs[whole])

    highs = {False: quick, True: whole}
    monkeypatch.setattr(SharedCouples, "left", left)
    value = Band(value=5.0, low=5.0 / 3.0, high=5.0, sources=())
    check = SimpleNamespace(
        link="arm", quantity=Quantity.SAFETY_FACTOR, verdict=Verdict.UNDECIDED, value=value, limit=2.0
    )
    couples = {"arm": Scatter(high=3.0)}
    one = SharedCouples(case=None, load_case="l", forces=None, loads=(), grown=False, by_hand=couples, told=couples,
                        checks=[check])  # fmt: skip
    assert one.decided_by("arm", ("A",)) is decides
    assert searches == [False, True][: 1 + (quick < 2.5)]
