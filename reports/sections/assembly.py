"""Links in their layers: the drawing, gaps between those at one height, and what layers leave out."""

from typing import Any

from alula.fea.common.band import Band
from alula.fea.outcomes.result import CheckResult
from alula.fea.whole.clearance import SOURCES, clearance_band, gap_reason
from alula.geometry.clearance.least import Gap
from alula.loads.case.joint_rules import clearances
from alula.loads.states.clearance import Clearance
from alula.reports.figures.outlines.assembly import assembly_drawing
from alula.reports.figures.outlines.contact import contact_drawing
from alula.reports.sections.data import data, entries
from alula.reports.sections.section import Part, Picture, Section, Text, say
from alula.reports.sections.table import Column, Number, Table, numbers, words
from alula.reports.sentences import told
from alula.reports.words.numbers import joined, sentence

MOST = 12
"""Gaps that a table shows, the least first."""
_STACKING = (
    "The case states no layers, so all links lie in one plane. In a real linkage they are stacked along the pins; the "
    "offset causes additional bending and torsion."
)
_LAYERS = (
    "Pins between layers are beams that touch their holes at the rims. Holes are as wide as the case states; where it "
    "states nothing, the value has running pins (H8/f7), and the bands hold all from pressed pins to holes wider by a "
    "tenth of the pin. That faces that touch, and heads that no joint states, bear couples is left out."
)
_TILT = " Displacements and the gaps between layers hold how far running pins tilt in holes of which nothing is stated."


def assembly_section(result: CheckResult) -> Section:
    """Return the links in their layers and the gaps between those at one height.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        Without parts where no layers are stated.
    """
    found = result.clearance
    if found is None:
        return Section(key="assembly", data={"clearance": None}, not_covered=(_left_out(result),))
    return Section(
        key="assembly",
        title="Links in their layers",
        short="Layers",
        parts=(
            Picture(
                name="assembly",
                alt="Links and pins in the stated pose, from above and from the side",
                caption="Links and pins in the stated pose, from above and from the side, a colour for each layer. "
                "From above, what is higher covers what is lower. Pins (dark) reach from the lowest to the highest "
                "face of the two links that they join.",
                draw=lambda: assembly_drawing(found),
            ),
            *gap_parts(found),
        ),
        data={"clearance": clearance_record(found)},
        not_covered=(_left_out(result),),
    )


def gap_parts(found: Clearance) -> tuple[Part, ...]:
    """Return the gaps between links at one height, and a drawing of the least.

    Parameters
    ----------
    found : Clearance

    Returns
    -------
    tuple of Part
    """
    touches = found.contact is not None
    where = "at their first contact" if touches else "where they come nearest"
    motion = found.motion
    over = f"over the motion of {motion.coordinate}" if motion is not None else "in the stated pose"
    parts: list[Part] = [
        Text(f"Links that lie at one height, and pins and the links that they pass, must not touch {over}.", "note"),
        clearance_text(found),
    ]
    if found.shown is not None:
        parts.append(
            Picture(
                name="clearance",
                alt=f"The two outlines {where}",
                caption=f"The two outlines {where}, as seen from above, and a close-up. Thin lines: the others.",
                draw=lambda: contact_drawing(found),
            )
        )
    if found.gaps:
        parts.append(gap_table(found))
    if touches:
        parts.append(
            Text(
                "Of a pair that touches, coordinate and place are those of its first contact; its gap is negative: "
                "less the diameter of the largest circle that lies in both.",
                "note",
            )
        )
    return tuple(parts)


def gap_table(found: Clearance) -> Table:
    """Return the least gaps.

    Parameters
    ----------
    found : Clearance

    Returns
    -------
    Table
    """
    motion, gaps = found.motion, found.gaps[:MOST]
    bands = (Band(value=gap.value, low=gap.low, high=gap.high, sources=SOURCES) for gap in gaps)
    at = [_at(found, gap) for gap in gaps]
    coordinate = Column("") if motion is None else Column(motion.coordinate.name, motion.unit)
    smallest = f", the {MOST} smallest" if len(found.gaps) > MOST else ""
    return Table.by_columns(
        {
            words("between"): [joined(gap.names) for gap in gaps],
            Column("gap (band)", "mm"): numbers(bands),
            coordinate: None if motion is None else ["" if x is None else Number(x, decimals=2) for x in at],
            Column("x", "mm"): numbers((gap.place[0] for gap in gaps), decimals=2),
            Column("y", "mm"): numbers((gap.place[1] for gap in gaps), decimals=2),
            words(""): ["touch" if gap.touches else "" for gap in gaps],
        },
        key="gaps",
        caption=f"Least gaps{smallest}; pairs that stay further apart than another are left out",
    )


def clearance_text(found: Clearance) -> Text:
    """Return the least gap of an assembly, and its first contact.

    Parameters
    ----------
    found : Clearance

    Returns
    -------
    Text
    """
    where = sentence(told(gap_reason(found)))
    if found.least is None:
        return Text(where)
    gap = Number(clearance_band(found), "mm")
    return say("Least gap between links in layers: {gap}. {where}", gap=gap, where=where)


def clearance_record(found: Clearance | None) -> dict[str, Any] | None:
    """Return the gaps of an assembly as an entry of ``result.json``.

    Parameters
    ----------
    found : Clearance or None
        Its gaps.

    Returns
    -------
    dict or None
        None where no layers are stated.
    """
    if found is None:
        return None
    motion = found.motion
    return {
        "coordinate": None if motion is None else motion.coordinate.name,
        "unit": None if motion is None else motion.unit,
        "least": data(clearance_band(found)),
        "first_contact": None if found.contact is None else _gap(found, found.contact),
        "gaps": [_gap(found, gap) for gap in found.gaps],
        "heights": dict(found.assembly.case.heights),
    }


def _gap(found: Clearance, gap: Gap) -> dict[str, Any]:
    return {
        "between": list(gap.names),
        **entries(gap, "value low high touches"),
        "at": _at(found, gap),
        "place": list(gap.place),
    }


def _at(found: Clearance, gap: Gap) -> float | None:
    return None if gap.at is None or found.motion is None else float(found.motion.told(gap.at))


def _left_out(result: CheckResult) -> tuple[str, str]:
    if not result.case.layered:
        return "Stacking", _STACKING
    linkage, loose = result.case.linkage, clearances(result.case)
    tilting = [name for name in linkage.joints if linkage.rise(name) != 0.0 and name not in loose]
    tilts = any(not linkage.joints[name].fixed for name in tilting)
    return "Layers", _LAYERS + _TILT if tilts else _LAYERS
