"""Plastic collapse of links: the factor on their loads, what yields on the way there, and what stays after the load."""

from collections.abc import Iterator, Mapping
from typing import Any

from alula.fea.common.verdict import Quantity
from alula.fea.outcomes.result import CheckResult
from alula.fea.plastic.link_collapse import LinkCollapse
from alula.reports.sections.data import entries
from alula.reports.sections.section import Part, Picture, Section, Text
from alula.reports.sections.table import Column, Table, numbers, words
from alula.reports.words.numbers import joined, number

LEFT_OUT = (
    "change of shape while it flows (small strains)",
    "clearance, friction and tilt of pins",
    "pins themselves",
    "rupture before the limit",
)
"""What a plastic-collapse factor leaves out."""
_RECORD = "factor low high mesh_error pressure transfer ended unloaded strain residual plastic_share unknowns solves"


def collapse_section(result: CheckResult) -> Section:
    """Return what was found of the plastic collapse of links.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    Section
        Without parts where no check asks for it.
    """
    every = {name: one.of_links(LinkCollapse) for name, one in result.load_cases.items()}
    record: dict[str, Any] | None = None
    if any(every.values()):
        record = {"load_cases": {name: {"links": _links(found)} for name, found in every.items()}}
    return Section(
        key="plastic-collapse",
        title="Plastic collapse" if record else "",
        short="Plastic collapse" if record else "",
        parts=tuple(_parts(result)) if record else (),
        data={"plastic_collapse": record},
    )


def _links(found: Mapping[str, LinkCollapse]) -> dict[str, Any]:
    return {link: entries(one, _RECORD) for link, one in found.items()}


def governing_collapses(result: CheckResult) -> dict[str, LinkCollapse]:
    """Return each link whose collapse was found, under the load case under which its factor is least.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    dict of str to LinkCollapse
    """
    found: dict[str, LinkCollapse] = {}
    for load_case in result.load_cases.values():
        for link, one in load_case.of_links(LinkCollapse).items():
            if link not in found or one.low < found[link].low:
                found[link] = one
    return found


def _parts(result: CheckResult) -> Iterator[Part]:
    several = len(result.load_cases) > 1
    rows = [
        (x, link, one) for x, case in result.load_cases.items() for link, one in case.of_links(LinkCollapse).items()
    ]
    bands = {
        (check.load_case, check.link): check.value
        for case in result.load_cases.values()
        for check in case.checks
        if check.quantity is Quantity.PLASTIC_COLLAPSE
    }
    yield Text(
        "All loads on a link grow together by the factor until it flows without end, or until its material reaches the "
        "largest strain of its card. Below the factor it holds; once a point has yielded it stays bent in part.",
        "note",
    )
    yield Table.by_columns(
        {
            words("link"): [link for _, link, _ in rows],
            words("load case", hidden=not several): [name for name, _, _ in rows],
            Column("plastic-collapse factor (band)"): numbers(bands[name, link] for name, link, _ in rows),
            words("ends by"): [_ENDS[one.ended] for _, _, one in rows],
            Column("plastic strain under the load"): numbers(one.strain for _, _, one in rows),
            Column("residual displacement", "mm"): numbers(one.residual for _, _, one in rows),
        },
        key="plastic-collapse",
    )
    for link, one in governing_collapses(result).items():
        yield Picture(
            name=f"plastic-{link}",
            model=f"plastic-{link}",
            alt=f"Plastic zone of link {link} at its collapse",
            caption=f"Link {link} at {number(one.factor, 3)} times its loads. Of its volume "
            f"{number(100.0 * one.plastic_share, 2)} % has flowed: red in the picture, with its strain in the model.",
        )
    yield Text(f"Left out: {joined(LEFT_OUT)}.", "small")


_ENDS = {"limit": "flow without end", "strain": "largest strain"}
