"""Mass and size of a linkage."""

from collections.abc import Iterator
from typing import Any

from alula.fea.asked.asked import GRAMS
from alula.fea.outcomes.result import CheckResult
from alula.fea.whole.mass import mass_reason
from alula.fea.whole.size import size_band, size_limits
from alula.loads.records.check_spec import MassCheck, SizeCheck
from alula.loads.states.extent import Extent, unmeasured
from alula.loads.states.weighed import Weighed
from alula.reports.figures.outlines.box import box_drawing
from alula.reports.sections.data import data
from alula.reports.sections.section import Part, Picture, Section, say
from alula.reports.sections.table import Column, Number, Table, words

AXES = "xyz"


def whole_section(result: CheckResult) -> Section:
    """Return mass and size of a linkage.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        Without parts where no check asks for either.
    """
    return Section(
        key="whole",
        title="Mass and size",
        short="Mass and size",
        parts=tuple(_parts(result)),
        data={"mass": _mass(result.mass), "size": _size(result.size)},
    )


def _parts(result: CheckResult) -> Iterator[Part]:
    checks = [check for check in result.case.checks.values() if isinstance(check, MassCheck | SizeCheck)]
    asked = next((check for check in checks if isinstance(check, MassCheck)), None)
    if asked is not None and result.mass is not None:
        yield say("{why}", why=mass_reason(result.mass, asked.others))
        yield _masses(result.mass, asked.others)
    if checks and result.size is not None and (limits := size_limits(result.case)):
        size, motion = result.size, result.size.motion
        over = "in the stated pose" if motion is None else f"over the motion of {motion.coordinate}"
        yield Picture(
            name="box",
            alt=f"Outlines of links and pins {over} with the box about them, from above and from the side",
            caption=f"The box about all parts {over}, of rigid links. Links without a part count by their points.",
            draw=lambda: box_drawing(size, limits),
        )


def _masses(found: Weighed, others: float | None) -> Table:
    rows: list[tuple[str | Number, ...]] = [
        (link, *(Number(mass or None, factor=GRAMS, derived=True) for mass in (own.part, own.pins, own.carried)),
         Number(own.total, factor=GRAMS, derived=True))
        for link, own in {**found.links, "all links": found.total}.items()
    ]  # fmt: skip
    if others is not None:
        rows.append(("others, as stated", "", "", "", Number(others, factor=GRAMS, derived=True)))
        whole = Number(found.total.total + others, factor=GRAMS, derived=True)
        rows.append(("all links and others", "", "", "", whole))
    columns = (words("link"), *(Column(what, "g") for what in ("part", "pins", "carried", "total")))
    return Table(key="masses", columns=columns, rows=tuple(rows), caption="Mass of each link")


def _mass(found: Weighed | None) -> dict[str, Any] | None:
    """Return what a linkage weighs [g]."""
    if found is None:
        return None
    kinds = ("part", "pins", "carried")
    return {
        "total": GRAMS * found.total.total,
        "links": {link: {kind: GRAMS * getattr(own, kind) for kind in kinds} for link, own in found.links.items()},
        "centroid": data(found.centroid),
        "not_counted": data(found.not_counted),
    }


def _size(found: Extent | None) -> dict[str, Any] | None:
    if found is None:
        return None
    motion = found.motion
    return {
        "coordinate": None if motion is None else motion.coordinate.name,
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
        "not_counted": data(unmeasured(found.assembly.case)),
    }
