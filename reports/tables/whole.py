"""Mass and size of a linkage, as records."""

from dataclasses import dataclass
from typing import Any

from alula.fea.outcomes.result import CheckResult
from alula.fea.whole.mass import GRAMS, mass_reason
from alula.fea.whole.size import size_band
from alula.loads.records.check_spec import MassCheck, SizeCheck
from alula.loads.states.extent import Extent, unmeasured
from alula.loads.states.weighed import Weighed
from alula.reports.sentences import told as in_words
from alula.reports.tables.data import data

AXES = "xyz"
Masses = tuple[float, float, float, float]


@dataclass(frozen=True, kw_only=True)
class WholeTable:
    """What the page shows of mass and size where a check asks for it.

    Attributes
    ----------
    masses : tuple of (str, tuple of 4 float)
        Link, and the mass of its part, of its pins, of what it carries and of all of it [g]; all links last.
    others : float or None
        Mass of what the case does not model, as the check states it [g].
    mass_sentence : str
        What the mass is made up of; "" where no check of mass is stated.
    motion : str
        The coordinate over which the box is; "" where it is that of the stated pose.
    """

    masses: tuple[tuple[str, Masses], ...]
    others: float | None
    mass_sentence: str
    motion: str


def whole_table(result: CheckResult) -> WholeTable | None:
    """Return what the page shows of mass and size.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    WholeTable or None
        None where no check asks for either.
    """
    checks = [check for check in result.case.checks.values() if isinstance(check, MassCheck | SizeCheck)]
    if not checks:
        return None
    asked = next((check for check in checks if isinstance(check, MassCheck)), None)
    rows: list[tuple[str, Masses]] = []
    told, others = "", None
    if asked is not None and result.mass is not None:
        told, others = in_words(mass_reason(result.mass, asked.others)), asked.others
        for link, own in {**result.mass.links, "all links": result.mass.total}.items():
            rows.append((link, (GRAMS * own.part, GRAMS * own.pins, GRAMS * own.carried, GRAMS * own.total)))
    motion = None if result.size is None else result.size.motion
    return WholeTable(
        masses=tuple(rows),
        others=None if others is None else GRAMS * others,
        mass_sentence=told,
        motion="" if motion is None else motion.coordinate,
    )


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
