"""A motion as a whole: which sections it has, in which order, on which page."""

from typing import Any

from alula.fea.findings.of_motion import MotionFindings
from alula.fea.findings.rates import QUANTITIES, series
from alula.loads.case.case import Case
from alula.loads.states.clearance import Clearance
from alula.reports.motion.centre import centre_section
from alula.reports.motion.drive import drive_section
from alula.reports.motion.play import play_section
from alula.reports.motion.poses import motion_section
from alula.reports.motion.rates import rates_section
from alula.reports.motion.series import motion_series
from alula.reports.page.provenance import provenance_section
from alula.reports.renderers.page import Page, page_footer
from alula.reports.renderers.record import as_brief_record
from alula.reports.sections.air import flapping_parts, motion_air_record
from alula.reports.sections.assembly import clearance_record, gap_parts
from alula.reports.sections.design import design_section
from alula.reports.sections.section import Picture, Section
from alula.reports.turnable.moving import LINKAGE, MOTION_CAPTION

UNITS = {
    "angle": "deg",
    "length": "mm",
    "force": "N",
    "moment": "N*mm",
    "time": "s",
    "power": "W",
    "mass": "g",
    **{key: unit.replace("·", "*").replace("²", "^2") for key, unit in QUANTITIES.items()},
}


def motion_sections(found: MotionFindings) -> tuple[Section, ...]:
    """Return all that is told of a motion.

    Parameters
    ----------
    found : MotionFindings

    Returns
    -------
    tuple of Section
    """
    moved = found.moved
    own = series(moved)
    rates = {name: rates for name in moved.torque if (rates := series(moved, name)) is not None}
    return (
        model_section(moved.case, MOTION_CAPTION, still=LINKAGE),
        motion_section(found, own),
        drive_section(found),
        centre_section(found),
        _air(found),
        play_section(found),
        _gaps(found.clearance),
        design_section(moved.case),
        rates_section(moved, rates),
        motion_series(found, rates, own),
        provenance_section(moved.case),
    )


def model_section(case: Case, caption: str, *, still: str = "") -> Section:
    """Return the linkage as a model that a reader can turn.

    Parameters
    ----------
    case : Case
    caption : str
        What its colours are.
    still : str, optional
        Name of the picture that stands where the model cannot.

    Returns
    -------
    Section
    """
    if not case.layered:
        caption += " The case states no layers: links that would lie in each other are drawn apart."
    if any(link.part is None for link in case.links.values()):
        caption += " Links without a part are thin and grey."
    moves = " and in motion" if case.motion is not None else ""
    picture = Picture(name=still, alt="The linkage in motion", caption=caption, model=LINKAGE)
    return Section(key="model", title=f"The linkage in its layers{moves}", parts=(picture,))


def _gaps(found: Clearance | None) -> Section:
    """Return the gaps between links at one height."""
    return Section(
        key="clearance",
        title="Gaps between links in layers",
        short="Gaps",
        parts=() if found is None else gap_parts(found),
        data={"clearance": clearance_record(found)},
    )


def _air(found: MotionFindings) -> Section:
    """Return what the air does to wings that flap."""
    records = {name: motion_air_record(found.air, name) for name in found.moved.torque}
    stated = {name: record for name, record in records.items() if record is not None}
    return Section(
        key="flapping",
        title="Air on wings that flap",
        short="Air on wings",
        parts=() if found.air is None or not stated else tuple(flapping_parts(found.air, stated)),
        data={"load_cases": {name: {"flapping": record} for name, record in stated.items()}},
    )


def motion_record(found: MotionFindings, name: str, sections: tuple[Section, ...]) -> dict[str, Any]:
    """Return a motion as data that JSON can hold.

    Parameters
    ----------
    found : MotionFindings
    name : str
        Of the case, as the command was given it.
    sections : tuple of Section
        As ``motion_sections``.

    Returns
    -------
    dict
        As ``docs/result.md`` describes it.
    """
    return as_brief_record(sections, units=UNITS, case=name, title=found.moved.case.title)


def motion_page(found: MotionFindings, sections: tuple[Section, ...]) -> Page:
    """Return the page of a motion.

    Parameters
    ----------
    found : MotionFindings
    sections : tuple of Section
        As ``motion_sections``.

    Returns
    -------
    Page
    """
    case = found.moved.case
    return Page(
        title=f"Motion: {case.title}",
        kind="Motion of a planar linkage",
        heading=case.title,
        sections=sections,
        footer=page_footer("*.csv"),
    )
