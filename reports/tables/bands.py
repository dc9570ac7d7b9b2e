"""A number with its band as plain data."""

from typing import Any

from fea.common.band import Band


def band_record(band: Band) -> dict[str, Any]:
    """Return a band as data: its numbers, what it covers in words, and the kinds of these sources of error.

    Parameters
    ----------
    band : Band
    """
    return {
        "value": band.value,
        "low": band.low,
        "high": band.high,
        "holds": list(band.texts),
        "kinds": [source.kind.name.lower() for source in band.sources],
    }
