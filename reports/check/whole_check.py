"""A check as a whole: which sections it has, in which order, on which page, with which pictures."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from alula.fea.outcomes.result import CheckResult
from alula.reports.check.changes import changes_section, first_change
from alula.reports.check.displacement import displacement_section
from alula.reports.check.linkage import governing_load_cases, linkage_picture, linkage_section
from alula.reports.check.links import links_section
from alula.reports.check.mass_and_size import whole_section
from alula.reports.check.opinion import opinion_section
from alula.reports.check.pins import pins_left_out
from alula.reports.check.plastic_collapse import collapse_section, governing_collapses
from alula.reports.check.stated import audit_section, case_section, hand_section, limits_section, materials_section
from alula.reports.check.statics import ground_section, statics_section
from alula.reports.page.provenance import provenance_section
from alula.reports.renderers.page import Page
from alula.reports.renderers.record import as_json, as_record
from alula.reports.sections.air import air_section, flapping_section
from alula.reports.sections.assembly import assembly_section
from alula.reports.sections.checks import checks_section, has_all, nearest
from alula.reports.sections.design import design_section
from alula.reports.sections.frequencies import frequencies_section
from alula.reports.sections.markup import code, headed
from alula.reports.sections.section import Picture, Section, parts_of
from alula.reports.sentences.verdicts import besides, checks_of, opening
from alula.reports.turnable.moving import CHECK_CAPTION, LINKAGE
from alula.reports.words.numbers import fixed


def check_sections(result: CheckResult, published: str = "") -> tuple[Section, ...]:
    """Return all that is told of a check.

    Parameters
    ----------
    result : CheckResult
        With what ``alula.fea.findings.of_check`` finds besides.
    published : str, optional
        How many published figures ``claims.html`` has, in a sentence; "" where there is no such page.

    Returns
    -------
    tuple of Section
        What would change it first, as it stands above the contents of the page; last what is not covered, and with
        what it was made.
    """
    sections = (
        changes_section(result),
        case_section(result, published),
        checks_section(result.case, checks_of(result), result.verdict, "In this pose"),
        _model(result),
        linkage_section(result),
        assembly_section(result),
        whole_section(result),
        frequencies_section(result.frequencies),
        statics_section(result),
        displacement_section(result),
        pins_left_out(result),
        air_section(result),
        flapping_section(result),
        ground_section(result),
        links_section(result),
        collapse_section(result),
        opinion_section(result),
        hand_section(result),
        audit_section(result),
        design_section(result.case),
        materials_section(result),
    )
    return (*sections, limits_section(sections), provenance_section(result.case, result.date))


def _model(result: CheckResult) -> Section:
    """Return the linkage as a model that a reader can turn."""
    case, moves = result.case, " and in motion" if result.case.motion is not None else ""
    caption = CHECK_CAPTION
    if not case.layered:
        caption += " The case states no layers: links that would lie in each other are drawn apart."
    if any(link.part is None for link in case.links.values()):
        caption += " Links without a part are thin and grey."
    picture = Picture(model=LINKAGE, caption=caption)
    return Section(key="model", title=f"The linkage in its layers{moves}", parts=(picture,))


def check_record(result: CheckResult, sections: Sequence[Section]) -> dict[str, Any]:
    """Return a check as data that JSON can hold.

    Parameters
    ----------
    result : CheckResult
    sections : sequence of Section
        As ``check_sections``.

    Returns
    -------
    dict
        As ``docs/result.md`` describes it.
    """
    head = {"case": result.name, "title": result.case.title, "source": result.case.source}
    return as_record(sections, **head, verdict=result.verdict.value)


def check_json(result: CheckResult, sections: Sequence[Section]) -> str:
    """Return ``check_record`` as the text of ``result.json``; strict JSON, without NaN or infinity.

    Parameters
    ----------
    result : CheckResult
    sections : Sequence[Section]

    Returns
    -------
    str
    """
    return as_json(check_record(result, sections))


def check_page(result: CheckResult, sections: Sequence[Section]) -> Page:
    """Return the page of a check.

    Parameters
    ----------
    result : CheckResult
    sections : sequence of Section
        As ``check_sections``.

    Returns
    -------
    Page
    """
    checks, several = checks_of(result), len(result.load_cases) > 1
    told_first = opening(result.case, result.verdict, checks, several=several, short=True)
    change, command = first_change(sections, said=" ".join(told_first))
    alone = len(sections[0].data["changes"]) <= 1 and not command  # then the first lines say all of it
    picture = linkage_picture(result, governing_load_cases(result)[0])
    times = ", ".join(f"{stage} {fixed(seconds, 1)} s" for stage, seconds in result.timings.items())
    if result.kept[0]:
        times += f"; {result.kept[0]} of {result.kept[1]} meshes and solutions were kept from earlier checks"
    return Page(
        title=f"{result.verdict.value.capitalize()}: {result.case.title}",
        kind="Structural check of a planar linkage",
        heading=result.case.title,
        verdict=result.verdict.value,
        lead=tuple(filter(None, (told_first[0], *map(headed, told_first[1:]), change, besides(result.caveats)))),
        first=(
            Section(key="picture", parts=(picture,)),
            nearest(checks, several=several, all_below=has_all(checks)),
        ),
        opening=() if alone else (sections[0],),
        sections=tuple(sections[1:]),
        footer=(
            f"Time: {times}.",
            f"Units: mm, N, N·mm, MPa, degrees. All numbers as data: {code('result.json')} in the same folder.",
        ),
    )


def check_pictures(
    result: CheckResult, page: Page, progress: Callable[[str], None] = lambda message: None
) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Draw every picture of a check's page.

    Parameters
    ----------
    result : CheckResult
    page : Page
        As ``check_page``.
    progress : callable, optional
        Receives messages.

    Returns
    -------
    tuple
        Name -> Drawing; and warnings.
    """
    from alula.reports.figures.figures import stress_plots
    from alula.reports.figures.plastic_zone import plastic_plots

    links = next(iter(result.load_cases.values())).links
    worst = {link: result.governing(link).links[link] for link in links}
    progress("Drawing the linkage, the internal forces and the stress plots ...")
    with ThreadPoolExecutor(1) as beside:  # its work is that of a child process
        rendered = beside.submit(stress_plots, worst, {link: result.case.links[link].points for link in worst})
        drawn = {
            part.name: part.draw()
            for section in page.every
            for part in parts_of(section.parts)
            if isinstance(part, Picture) and part.draw is not None
        }
        plots, warnings = rendered.result()
    zones, missing = plastic_plots(governing_collapses(result))
    drawn |= {f"stress-{link}": plot for link, plot in plots.items()}
    return drawn | {f"plastic-{link}": plot for link, plot in zones.items()}, (*warnings, *missing)
