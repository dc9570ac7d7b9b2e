"""The command ``alula size``: the least size that passes, the greatest that fails, and what limits them."""

import json as jsonlib
import sys
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.reports.commands.options import (
    AccuracyOption,
    CaseArgument,
    LinkOption,
    SetOption,
    VariantsOption,
    WorkersOption,
    at_a_time,
    folder_option,
)
from alula.reports.commands.study import stated

if TYPE_CHECKING:
    from rich.console import Console

    from alula.fea.sizing.least import Sized
    from alula.fea.sizing.lightest import Lightest
    from alula.loads.compose.stated_case import StatedCase
    from alula.loads.plans.axis import Axis

app = typer.Typer()
STEPS = 100
"""Of a range without step."""


@app.command()
def size(
    case: CaseArgument,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            help='The entry and its range: parts.tube.outer_diameter="3 mm..8 mm"; of several, the least mass.',
            show_default=False,
        ),
    ] = None,
    choose: Annotated[
        list[str] | None,
        typer.Option(
            "--choose",
            help="An entry and its values, or a part and those of the case that may stand for it: "
            "parts.tube=tube-4,tube-5.",
        ),
    ] = None,
    minimise: Annotated[
        str | None, typer.Option(help='What shall be least: mass, or "largest drive torque" and the like.')
    ] = None,
    maximise: Annotated[str | None, typer.Option(help="What shall be greatest instead.")] = None,
    most: Annotated[
        int, typer.Option("--most", min=1, help="Combinations of several entries that the model that decides solves.")
    ] = 24,
    seed: Annotated[int, typer.Option(min=0, help="Of the search over several entries.")] = 0,
    step: Annotated[
        str | None, typer.Option("--step", help='Distance of two values, such as "0.5 mm"; default: a hundredth.')
    ] = None,
    link: LinkOption = None,
    overrides: SetOption = None,
    fidelity: Annotated[str, typer.Option(help="Model that decides: auto, beam or solid.")] = "auto",
    accuracy: AccuracyOption = None,
    analysis: Annotated[str, typer.Option(help="check or envelope.")] = "check",
    threads: VariantsOption = None,
    workers: WorkersOption = None,
    output: Annotated[Path | None, folder_option("Folder that keeps what was computed, as of a study.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Find the least value of an entry that passes over its whole band, or of several entries the least mass."""
    from alula.loads.case.case_file import stated_changes
    from alula.loads.compose.stated_case import StatedCase

    found = find_size(
        StatedCase.read(case),
        stated(vary, "--vary"),
        stated(choose, "--choose"),
        step=step,
        minimise=minimise,
        maximise=maximise,
        most=most,
        seed=seed,
        link=stated(link, "--link"),
        values={change.path: change.value for change in stated_changes(overrides or ())},
        fidelity=fidelity,
        accuracy=accuracy,
        analysis=analysis,
        workers=at_a_time(threads, workers),
        folder=output,
        tell=_tell,
    )
    if json:
        print(jsonlib.dumps(_record(found), indent=2, allow_nan=False))
    else:
        from rich.console import Console

        print_found(found, Console())
    raise SystemExit(_status(found))


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

    axes = _axes(vary, choose, step)
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
        store = stack.enter_context(Store.writing(kept))
        engine = stack.enter_context(engine_for(variants, kept, workers=workers))
        search = Search(plan, Path(), store, engine, tell=tell)
        told = caveats(case.with_values(dict(values) | points[0]).record, over_motion=analysis == "envelope")
        found: Sized | Lightest = (
            lightest(search, axes, objective, most=most, seed=seed, caveats=told)
            if several
            else least_size(search, axes[0].path, axes[0].values, caveats=told)
        )
        if folder is not None:
            search.finish()
    return found


def print_found(found: "Sized | Lightest", console: "Console") -> None:
    """Print the result of either search.

    Parameters
    ----------
    found : Sized or Lightest
    console : rich.console.Console
    """
    from alula.fea.sizing.least import Sized
    from alula.reports.commands.lightest import print_lightest
    from alula.reports.words.terminal import say
    from alula.reports.words.wording import besides

    if isinstance(found, Sized):
        print_size(found, console)
    else:
        print_lightest(found, console)
    if left := besides(found.caveats):
        say(console, left)


def _record(found: "Sized | Lightest") -> Mapping[str, Any]:
    from alula.fea.sizing.least import Sized
    from alula.reports.commands.lightest import record_of
    from alula.reports.sections.data import entries

    told = record(found) if isinstance(found, Sized) else record_of(found)
    return {**told, "caveats": [entries(one, "heading topic what why") for one in found.caveats]}


def _status(found: "Sized | Lightest") -> int:
    from alula.fea.sizing.least import Sized
    from alula.reports.commands.lightest import status_of

    return exit_status(found) if isinstance(found, Sized) else status_of(found)


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
        stepped = "/" in text or " by " in text
        if step and stepped:
            raise CaseError(f"vary {printable(path)}: '{printable(text)}' has steps of its own; leave --step out")
        axes.append(axis(path, text if stepped else f"{text} by {step}" if step else f"{text}/{STEPS + 1}"))
    for path, text in chosen.items():
        if ".." in text:
            raise CaseError(f"choose {printable(path)}: '{printable(text)}' is a range; state it with --vary")
        axes.append(axis(path, text))
    return axes


def _tell(sentence: str) -> None:
    print(sentence, file=sys.stderr, flush=True)


def exit_status(found: "Sized") -> int:
    """Return the status of the command: 0 where a value passes, 1 where all fail, 3 where none is decided to pass.

    Parameters
    ----------
    found : Sized

    Returns
    -------
    int
    """
    if found.passing is not None:
        return 0
    return 1 if found.failing in (0, len(found.values) - 1) and not found.opened else 3


def record(found: "Sized") -> Mapping[str, Any]:
    """Return the result as plain data.

    Parameters
    ----------
    found : Sized

    Returns
    -------
    mapping
    """
    from alula.geometry.base.version import result_stamp
    from alula.reports.renderers.record import finite

    def value(step: int | None) -> object:
        return None if step is None else found.values[step]

    solved = [
        {
            "value": found.values[step],
            "state": result.state,
            "verdict": result.verdict,
            "sentence": result.sentence,
            "limit": None if (limit := found.limit(step)) is None else limit.__dict__,
        }
        for step, result in sorted(found.results.items())
    ]
    told = {
        **result_stamp(),
        "entry": found.path,
        "passing": value(found.passing),
        "failing": value(found.failing),
        "undecided": [found.values[step] for step in found.opened],
        "fails_beyond": [found.values[step] for step in found.turns],
        "solved": solved,
    }
    return dict(finite(told, {}))


def print_size(found: "Sized", console: "Console") -> None:
    """Print the result.

    Parameters
    ----------
    found : Sized
    console : rich.console.Console
    """
    from alula.reports.words.terminal import say

    least, most = ("Least", "greatest") if found.rising else ("Greatest", "least")
    span = f"{found.values[0]} to {found.values[-1]}"
    if found.passing is None:
        say(console, f"No value of {found.path} from {span} passes over its whole band.", style="bold")
    else:
        say(console, f"{least} {found.path} that passes: {found.values[found.passing]}.", style="bold")
        if found.passing == (0 if found.rising else len(found.values) - 1):
            say(console, "The range begins with it; values beyond may pass, too.")
    if found.failing is None:
        say(console, f"None from {span} fails.")
    else:
        say(console, f"The {most} that fails: {found.values[found.failing]}.")
    if found.opened:
        say(console, f"Undecided: {', '.join(str(found.values[step]) for step in found.opened)}.")
    if found.turns:
        values = ", ".join(str(found.values[step]) for step in found.turns)
        say(
            console, f"The verdict turns more than once: {values} fails again. Choose from alula study with this range."
        )
    best = found.passing if found.passing is not None else _best(found)
    for step in dict.fromkeys((best, found.failing)):
        if step is not None and (sentence := _limited(found, step)):
            say(console, sentence)


def _best(found: "Sized") -> int | None:
    """The undecided step on the passing side, where none passes."""
    return max(found.opened, key=lambda step: step if found.rising else -step, default=None)


def _limited(found: "Sized", step: int) -> str:
    from alula.fea.study.margin import sense_of
    from alula.reports.study.rows import number_text

    limit, gain = found.limit(step), found.gain(step)
    if limit is None:
        return ""
    told = f"At {found.values[step]} {number_text(limit)} limits it"
    if gain is None or step == len(found.values) - 1:
        return told + "."
    other = found.values[step + (1 if found.rising else -1)]
    verb = "raises" if sense_of(limit).value == "≥" else "lowers"
    return f"{told}; {other} {verb} it by some {float(f'{100.0 * abs(gain):.2g}'):g} %."
