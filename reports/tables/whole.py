"""Mass and size of a linkage, as records."""

from typing import Any

from fea.whole.mass import GRAMS
from fea.whole.size import size_band
from loads.states.extent import Extent, unmeasured
from loads.states.weighed import Weighed
from reports.tables.data import data

AXES = "xyz"


def mass_record(found: Weighed | None) -> dict[str, Any] | None:
    """Return what a linkage weighs as plain data.

    Parameters
    ----------
    found : Weighed or None

    Returns
    -------
    dict or None
        In grams; None where no part was weighed.
    """
    if found is None:
        return None
    kinds = ("part", "pins", "carried")
    return {
        "total": GRAMS * found.total.total,
        "links": {link: {kind: GRAMS * getattr(own, kind) for kind in kinds} for link, own in found.links.items()},
        "centroid": data(found.centroid),
        "not_counted": list(found.not_counted),
    }


def size_record(found: Extent | None) -> dict[str, Any] | None:
    """Return the box about a linkage as plain data.

    Parameters
    ----------
    found : Extent or None

    Returns
    -------
    dict or None
        None where no outlines were made.
    """
    if found is None:
        return None
    motion = found.motion
    return {
        "coordinate": None if motion is None else motion.coordinate,
        "unit": None if motion is None else motion.unit,
        **{axis: data(size_band(found, k)) for k, axis in enumerate(AXES)},
        "sides": [
            {
                "axis": axis,
                "side": which,
                "value": side.value,
                "by": side.name,
                "at": None if side.at is None or motion is None else float(motion.told(side.at)),
            }
            for axis, sides in zip(AXES, found.reaches, strict=True)
            for which, side in zip(("low", "high"), sides, strict=True)
        ],
        "not_counted": list(unmeasured(found.assembly.case)),
    }
