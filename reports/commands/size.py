"""The command ``alula size``: the least size that passes, the greatest that fails, and what limits them."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.reports.commands import options
from alula.reports.commands.ending import progress
from alula.reports.commands.telling import tell

if TYPE_CHECKING:
    from alula.fea.sizing.candidates import Objective
    from alula.fea.sizing.least import Sized
    from alula.fea.sizing.lightest import Lightest
    from alula.fea.sizing.search import Search
    from alula.loads.compose.stated_case import StatedCase
    from alula.loads.plans.axis import Axis
    from alula.loads.plans.points import Point

app = typer.Typer()
STEPS = 100
"""Of a range without step."""


@app.command()
def size(
    case: options.CaseArgument,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="<entry=range>",
            help='The entry and its range: parts.tube.outer_diameter="3 mm..8 mm"; of several, the least mass.',
        ),
    ] = None,
    choose: Annotated[
        list[str] | None,
        typer.Option(
            metavar="<entry=values>",
            help="An entry and its values, or a part and those of the case that may stand for it: "
            "parts.tube=tube-4,tube-5.",
        ),
    ] = None,
    minimise: Annotated[
        str | None,
        typer.Option(metavar="<name>", help='What shall be least: mass, "drive torque" and the like.'),
    ] = None,
    maximise: Annotated[str | None, typer.Option(metavar="<name>", help="What shall be greatest instead.")] = None,
    most: Annotated[
        int,
        typer.Option(
            metavar="<number>", min=1, help="Combinations of several entries that the model that decides solves."
        ),
    ] = 24,
    seed: Annotated[int, typer.Option(metavar="<number>", min=0, help="Of the search over several entries.")] = 0,
    step: Annotated[
        str | None,
        typer.Option(
            metavar="<step>", help='Distance of two values, such as "0.5 mm"; default: a hundredth of the range.'
        ),
    ] = None,
    link: options.LinkOption = None,
    overrides: options.SetOption = None,
    fidelity: Annotated[str, typer.Option(metavar="<model>", help="Model that decides: auto, beam or solid.")] = "auto",
    accuracy: options.AccuracyOption = None,
    analysis: Annotated[str, typer.Option(metavar="<analysis>", help="check or envelope.")] = "check",
    threads: options.VariantsOption = None,
    workers: options.WorkersOption = None,
    output: Annotated[Path | None, options.folder_option("Folder that keeps what was computed, as of a study.")] = None,
    json: options.JsonOption = False,
) -> None:
    """Find the least value of an entry that passes over its whole band, or of several entries the least mass."""
    from alula.loads.case.case_file import stated_changes
    from alula.loads.compose.stated_case import StatedCase
    from alula.reports.study.size import size_section

    found = find_size(
        StatedCase.read(case),
        options.stated(vary, "--vary"),
        options.stated(choose, "--choose"),
        step=step,
        minimise=minimise,
        maximise=maximise,
        most=most,
        seed=seed,
        link=options.stated(link, "--link"),
        values={change.path: change.value for change in stated_changes(overrides or ())},
        fidelity=fidelity,
        accuracy=accuracy,
        analysis=analysis,
        workers=options.at_a_time(threads, workers),
        folder=output,
        tell=progress,
    )
    tell([size_section(found)], json=json)
    raise SystemExit(exit_status(found))


def find_size(
    case: "StatedCase",
    vary: Mapping[str, str],
    choose: Mapping[str, str],
    *,
    step: str | None = None,
    minimise: str | None = None,
    maximise: str | None = None,
    most: int = 24,
    seed: int = 0,
    link: Mapping[str, str] = MappingProxyType({}),
    values: Mapping[str, object] = MappingProxyType({}),
    fidelity: str = "auto",
    accuracy: str | None = None,
    analysis: str = "check",
    workers: int | None = None,
    folder: Path | None = None,
    tell: Callable[[str], None],
) -> "Sized | Lightest":
    """Find the least value of an entry that passes, or the best values of several.

    Parameters
    ----------
    case : StatedCase
    vary, choose : mapping of str to str
        Entry -> its range, and entry -> its values.
    step : str, optional
        Distance of two values of a range.
    minimise, maximise : str, optional
        The quantity that shall be least or greatest; mass, where several entries vary.
    most, seed : int, optional
        How many combinations the model that decides solves, and seed of the search, of several entries.
    link : mapping of str to str, optional
        Entry -> expression of others.
    values : mapping of str to object, optional
        Other values for some entries.
    fidelity, accuracy, analysis : str, optional
        As of a study.
    workers : int, optional
        Processes; one a core unless given.
    folder : Path, optional
        That keeps what was computed.
    tell : callable
        Called with a sentence before each batch.

    Returns
    -------
    Sized or Lightest

    Raises
    ------
    CaseError
        For options that do not go together, and for a wrong case, entry or range.
    """
    from alula.fea.outcomes.unchecked import caveats
    from alula.fea.sizing.candidates import Objective
    from alula.fea.sizing.least import least_size
    from alula.fea.sizing.lightest import lightest
    from alula.fea.sizing.search import Search
    from alula.fea.study.compute import engine_for
    from alula.fea.study.store import Store
    from alula.geometry.base.errors import CaseError
    from alula.geometry.base.tidying import scratch_folder
    from alula.loads.plans.plan import plan_of
    from alula.loads.plans.variants import Variants
    from alula.loads.text.explain import printable

    axes = _axes(vary, choose, step)
    if twice := [axis.path for axis in axes if axis.path in values]:
        raise CaseError(f"size: '{printable(twice[0])}' is varied and set; leave one of the two out")
    if minimise and maximise:
        raise CaseError("size: both --minimise and --maximise are stated; leave one of the two out")
    objective = Objective(quantity=maximise or minimise or "mass", largest=bool(maximise))
    several = len(axes) > 1 or not axes[0].is_range or bool(minimise or maximise)
    if several and analysis != "check":
        raise CaseError(f"size: several entries or an objective go with --analysis check alone, not '{analysis}'")
    data: dict[str, Any] = case.of_study() | {"vary": {a.path: list(a.values) for a in axes}, "link": dict(link)}
    data["mass"] = several and objective.quantity == "mass"
    data |= {"fidelity": fidelity, "accuracy": accuracy, "analysis": analysis, "set": dict(values)}
    plan = plan_of(data)
    with ExitStack() as stack:
        kept = folder or stack.enter_context(scratch_folder("alula-"))
        longest = max(1 if a.is_range else len(a.values) for a in axes)
        points = [{a.path: a.values[max(i - longest, -len(a.values))] for a in axes} for i in range(longest)]
        variants = Variants(plan, Path(), points=points)
        for point in points:
            variants.tables(point)
        _refuse_negative(case, axes, dict(values) | points[0])
        store = stack.enter_context(Store.writing(kept))
        engine = stack.enter_context(engine_for(variants, kept, workers=workers))
        search = Search(plan, Path(), store, engine, tell=tell)
        told = caveats(case.with_values(dict(values) | points[0]).record, over_motion=analysis == "envelope")
        if minimise or maximise:
            _require_number(search, points[0], objective)
        found: Sized | Lightest = (
            lightest(search, axes, objective, most=most, seed=seed, caveats=told)
            if several
            else least_size(search, axes[0].path, axes[0].values, caveats=told)
        )
        if folder is not None:
            search.finish()
    return found


def _refuse_negative(case: "StatedCase", axes: "Sequence[Axis]", values: Mapping[str, object]) -> None:
    """Refuse a range that goes below zero where its entry takes no such value: its steps would be left out untold."""
    from alula.geometry.base.errors import CaseError

    for axis in axes:
        for end in (axis.values[0], axis.values[-1]) if axis.is_range else ():
            if not str(end).strip().startswith("-"):
                continue
            try:
                case.with_values({**values, axis.path: end})
            except CaseError as error:
                if str(error).startswith(f"{axis.path} (it is "):  # a rule of several entries may hold further on
                    raise


def _require_number(search: "Search", point: "Point", objective: "Objective") -> None:
    """Refuse a number that neither one variant nor a check has, before all variants are computed."""
    from alula.fea.common.verdict import Quantity
    from alula.geometry.base.errors import CaseError
    from alula.loads.text.explain import printable

    [result] = search.at([point], "beam", roughly=True)
    known = {number.quantity for number in result.numbers}
    if result.state == "done" and objective.quantity not in known | {*Quantity}:
        raise CaseError(
            f"size: no variant has the number '{printable(objective.quantity)}'; choose among "
            f"{', '.join(sorted(known))}"
        )


def _axes(varied: Mapping[str, str], chosen: Mapping[str, str], step: str | None) -> "list[Axis]":
    """Read what may be chosen: ranges in steps, and lists."""
    from alula.geometry.base.errors import CaseError
    from alula.loads.plans.axis import axis
    from alula.loads.text.explain import printable

    if twice := [path for path in varied if path in chosen]:
        raise CaseError(f"size: '{printable(twice[0])}' is varied and chosen; leave one of the two out")
    if not varied and not chosen:
        raise CaseError('size: nothing varies; state an entry and its range, --vary ENTRY="3 mm..8 mm"')
    axes = []
    for path, text in varied.items():
        if ".." not in text:
            raise CaseError(
                f"vary {printable(path)}: '{printable(text)}' is no range; write for example \"3 mm..8 mm\", or state "
                "values with --choose"
            )
        found = axis(path, text)
        if step and found.values:
            raise CaseError(f"vary {printable(path)}: '{printable(text)}' has steps of its own; leave --step out")
        if not found.values:
            found = axis(path, f"{text} by {step}") if step else found.divided(STEPS)
        axes.append(found)
    for path, text in chosen.items():
        if ".." in text:
            raise CaseError(f"choose {printable(path)}: '{printable(text)}' is a range; state it with --vary")
        axes.append(axis(path, text))
    return axes


def exit_status(found: "Sized | Lightest") -> int:
    """Return the status of the command: 0 where a value passes, 1 where all fail, 3 where that is open.

    Parameters
    ----------
    found : Sized or Lightest

    Returns
    -------
    int
    """
    from alula.fea.sizing.lightest import Lightest, none_passes

    if isinstance(found, Lightest):
        return 0 if found.best is not None else 1 if none_passes(found) else 3
    if found.passing is not None:
        return 0
    return 1 if found.failing in (0, len(found.values) - 1) and not found.opened else 3
