"""``envelope.html`` and ``motion.html``: a motion on one page, with the linkage as a model that a reader can turn."""

import base64
import math
from collections.abc import Mapping
from typing import Any

from alula.fea.common.verdict import by_nearness
from alula.fea.findings.rates import rates_record
from alula.fea.motion.envelope_result import EnvelopeResult, LinkEnvelope, LoadCaseEnvelope
from alula.fea.outcomes.unchecked import caveats
from alula.loads.states.case_motion import CaseMotion
from alula.reports.figures.sheet.drawing import Drawing
from alula.reports.motion.rate_rows import ends, link_columns, places, point_columns, told_speed, whole_rows
from alula.reports.page.decided import held, meaning, reasons
from alula.reports.page.template import fill
from alula.reports.turnable.moving import ENVELOPE_CAPTION, MOTION_CAPTION, envelope_linkage, motion_linkage
from alula.reports.turnable.pack import data_block
from alula.reports.turnable.script import viewer
from alula.reports.words.wording import besides, decision

ENVELOPE, MOTION = "envelope.html", "motion.html"
STYLES = ("report.css", "turnable.css")
TITLES = {
    "link-angles": "Directions of the links",
    "paths": "Paths of the joints",
    "torque": "Drive",
    "air": "Drive with and without air on wings",
    "clearance": "Gap between links",
    "joint-forces": "Joint forces",
    "link-speeds": "Angular speeds and accelerations of the links",
    "point-speeds": "Speeds and accelerations of the points, as sizes",
    "energy": "Energies, power of the drive and force on the ground",
}
"""What a figure shows, by the name of its file without the number of a load case."""


def envelope_page(result: EnvelopeResult, curves: Drawing, plots: Mapping[str, Drawing]) -> str:
    """Return the page of an envelope.

    Parameters
    ----------
    result : EnvelopeResult
    curves : Drawing
        Of the safety factors over the motion.
    plots : mapping
        Link -> Drawing of its stress in the worst pose.

    Returns
    -------
    str
    """
    checks, several = by_nearness(result.checks), len(result.moved.forces) > 1
    return fill(
        "envelope.html.jinja",
        styles=STYLES,
        script=viewer(),
        result=result,
        case=result.case,
        coordinate=result.moved.motion.coordinate,
        first=math.degrees(float(result.angles[0])),
        last=math.degrees(float(result.angles[-1])),
        headline=envelope_headline(result),
        meaning=meaning(result.verdict, "Over the motion"),
        checks=checks,
        reasons=reasons(checks),
        bands=held(checks),
        several=several,
        rows=worst_poses(result),
        curves=curves,
        plots=plots,
        linkage_model=data_block(envelope_linkage(result)),
        linkage_caption=ENVELOPE_CAPTION,
        linkage_still="",
    )


def worst_poses(result: EnvelopeResult) -> list[tuple[str, str, LinkEnvelope, LoadCaseEnvelope, float]]:
    """Return the worst pose of each link under each load case, the least safety factor first.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    list of tuple
        Link, load case, what was found of both, and the value of the coordinate [deg].
    """
    rows = [
        (name, load_case, link, found, math.degrees(float(result.angles[found.pose])))
        for name, link in result.links.items()
        for load_case, found in link.load_cases.items()
    ]
    return sorted(rows, key=lambda row: row[3].severity)


def envelope_headline(result: EnvelopeResult) -> str:
    """Return the verdict of an envelope, what decides it and what it stands on besides.

    Parameters
    ----------
    result : EnvelopeResult

    Returns
    -------
    str
    """
    told = decision(result.verdict, by_nearness(result.checks), several=len(result.moved.forces) > 1)
    return " ".join(filter(None, (told, besides(caveats(result.case, over_motion=True)))))


def motion_page(result: CaseMotion, pictures: Mapping[str, Drawing], animation: bytes, *, name: str) -> str:
    """Return the page of a motion.

    Parameters
    ----------
    result : CaseMotion
    pictures : mapping
        Name of the file, without its ending -> Drawing.
    animation : bytes
        GIF, which stands where the model cannot.
    name : str
        Of the case, as the command was given it.

    Returns
    -------
    str
    """
    motion = result.motion
    return fill(
        "motion.html.jinja",
        styles=STYLES,
        script=viewer(),
        result=result,
        case=result.case,
        name=name,
        first=float(motion.told(motion.angles[0])),
        last=float(motion.told(motion.angles[-1])),
        pictures=[(TITLES[key.rstrip("-0123456789")], picture) for key, picture in pictures.items()],
        turns=[
            (link, *(math.degrees(f) for f in (angle[0], angle[-1], angle.min(), angle.max())))
            for link in motion.linkage.moving
            for angle in [motion.angle(link)]
        ],
        rates=_rates(result),
        linkage_model=data_block(motion_linkage(result)),
        linkage_caption=MOTION_CAPTION,
        linkage_still="data:image/gif;base64," + base64.b64encode(animation).decode("ascii"),
    )


def _rates(result: CaseMotion) -> list[dict[str, Any]]:
    """Tables of every load case with a speed; where links and points move as in another, its name in their place."""
    found: list[dict[str, Any]] = []
    for name in result.torque:
        rates = rates_record(result, name)
        if rates is None:
            continue
        shared = {key: rates[key] for key in ("links", "points")}
        same = next((other["name"] for other in found if other["shared"] == shared), None)
        tables = [] if same else [link_columns(rates), point_columns(rates, result.motion.unit)]
        found.append(
            {
                "name": name,
                "shared": shared,
                "same": same,
                "speed": told_speed(result, name),
                "tables": [
                    ([head for head, _ in columns], list(zip(*(cells for _, cells in columns), strict=True)))
                    for columns in tables
                ],
                "whole": [(what, unit, ends(row), " and ".join(places(row))) for what, unit, row in whole_rows(rates)],
                "massless": rates["whole"]["momentum"] is None,
            }
        )
    return found
