"""``envelope.html`` and ``motion.html``: a motion on one page, with the linkage as a model that a reader can turn."""

import base64
import math
from collections.abc import Mapping

from fea.motion.envelope_result import EnvelopeResult
from loads.states.case_motion import CaseMotion
from reports.page.template import fill
from reports.turnable.moving import ENVELOPE_CAPTION, MOTION_CAPTION, envelope_linkage, motion_linkage
from reports.turnable.pack import data_block
from reports.turnable.script import viewer

ENVELOPE, MOTION = "envelope.html", "motion.html"
STYLES = ("report.css", "turnable.css")
TITLES = {
    "link-angles": "Directions of the links",
    "paths": "Paths of the joints",
    "torque": "Drive",
    "clearance": "Gap between links",
}


def envelope_page(result: EnvelopeResult, curves: bytes, plots: Mapping[str, bytes]) -> str:
    """Return the page of an envelope.

    Parameters
    ----------
    result : EnvelopeResult
    curves : bytes
        PNG of the safety factors over the motion.
    plots : mapping
        Link -> PNG of its stress in the worst pose.

    Returns
    -------
    str
    """
    rows = [
        (name, load_case, link, found, math.degrees(float(result.angles[found.pose])))
        for name, link in result.links.items()
        for load_case, found in link.load_cases.items()
    ]
    return fill(
        "envelope.html.jinja",
        styles=STYLES,
        script=viewer(),
        result=result,
        case=result.case,
        coordinate=result.moved.motion.coordinate,
        first=math.degrees(float(result.angles[0])),
        last=math.degrees(float(result.angles[-1])),
        rows=rows,
        curves=curves,
        plots=plots,
        linkage_model=data_block(envelope_linkage(result)),
        linkage_caption=ENVELOPE_CAPTION,
        linkage_still="",
    )


def motion_page(result: CaseMotion, pictures: Mapping[str, bytes], animation: bytes, *, name: str) -> str:
    """Return the page of a motion.

    Parameters
    ----------
    result : CaseMotion
    pictures : mapping
        Name of the file, without its ending -> PNG.
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
        pictures=[(TITLES.get(key, "Joint forces"), picture) for key, picture in pictures.items()],
        turns=[
            (link, *(math.degrees(f) for f in (angle[0], angle[-1], angle.min(), angle.max())))
            for link in motion.linkage.moving
            for angle in [motion.angle(link)]
        ],
        linkage_model=data_block(motion_linkage(result)),
        linkage_caption=MOTION_CAPTION,
        linkage_still="data:image/gif;base64," + base64.b64encode(animation).decode("ascii"),
    )
