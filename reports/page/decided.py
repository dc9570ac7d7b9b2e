"""How the checks of a page are decided: what its verdict means, why a check is open or fails, what bands hold."""

from collections.abc import Sequence

from alula.fea.common.verdict import UNLOADED_QUANTITIES, CheckOutcome, Quantity, Verdict, reason_for
from alula.reports.sentences import told

_MEANING = {
    Verdict.PASS: "{where} and under these loads every check keeps its limit, even at the unfavourable end of its "
    "error band.",
    Verdict.FAIL: "At least one check misses its limit, even at the favourable end of its error band.",
    Verdict.UNDECIDED: "At least one check is open: its limit lies inside its error band, or no model that ran can "
    "decide it. This is neither a pass nor a fail.",
}
_TELLING = (Quantity.DRIVE_POWER, Quantity.LAYERS, Quantity.LAYER_GAP, Quantity.DISPLACEMENT, *UNLOADED_QUANTITIES)
"""Quantities whose reasons say more than their values."""


def meaning(verdict: Verdict, where: str) -> str:
    """Return what a verdict means.

    Parameters
    ----------
    verdict : Verdict
    where : str
        Where it was looked at, such as ``In this pose``.

    Returns
    -------
    str
    """
    return _MEANING[verdict].format(where=where)


def held(checks: Sequence[CheckOutcome]) -> dict[str, tuple[str, ...]]:
    """Return the kinds of sources of error in the bands: name of the check -> each kind once, without particulars.

    A check without any width stands there only where its values say why.

    Parameters
    ----------
    checks : sequence of CheckOutcome

    Returns
    -------
    dict of str to tuple of str
    """
    wide = {check.name for check in checks if check.value.low < check.value.high}
    found: dict[str, dict[str, None]] = {}
    for check in checks:
        band = check.value
        texts = [str(source.kind) for source in band.sources] if check.name in wide else []
        if band.without:
            texts.append(f"{'no error of the model' if texts else 'nothing'} ({told(band.without)})")
        for text in texts:
            found.setdefault(check.name, {})[text] = None
    return {name: tuple(texts) for name, texts in found.items()}


def reasons(checks: Sequence[CheckOutcome]) -> list[str]:
    """Return the reason of each check; "" where its row says the same, so not where the reason names the model.

    Parameters
    ----------
    checks : sequence of CheckOutcome

    Returns
    -------
    list of str
    """
    return [
        ""
        if check.quantity not in _TELLING
        and not check.value.unknowable
        and (check.verdict is Verdict.PASS or check.reason == reason_for(check.value, check.limit, check.verdict))
        else told(check.reason)
        for check in checks
    ]
