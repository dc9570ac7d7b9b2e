"""What ``alula size`` prints of a search over several entries."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

    from alula.fea.sizing.candidates import Place
    from alula.fea.sizing.lightest import Gain, Lightest


def status_of(found: "Lightest") -> int:
    """Return the status of the command: 0 where a combination passes, 1 where all fail, 3 where that is open.

    Parameters
    ----------
    found : Lightest

    Returns
    -------
    int
    """
    from alula.fea.sizing.lightest import none_passes

    return 0 if found.best is not None else 1 if none_passes(found) else 3


def record_of(found: "Lightest") -> Mapping[str, Any]:
    """Return the result as plain data.

    Parameters
    ----------
    found : Lightest

    Returns
    -------
    mapping
    """
    from alula.fea.study.margin import nearest
    from alula.geometry.base.version import result_stamp
    from alula.reports.renderers.record import finite

    solved = []
    for place, result in found.solved.items():
        limit, number = nearest(result), found.objective.number(result)
        solved.append({
            "values": found.point(place),
            "state": result.state,
            "verdict": result.verdict,
            "sentence": result.sentence,
            "objective": None if number is None else number.__dict__,
            "limit": None if limit is None else limit.__dict__,
        })  # fmt: skip
    told = {
        **result_stamp(),
        "entries": [axis.path for axis in found.axes],
        "objective": {"quantity": found.objective.quantity, "largest": found.objective.largest},
        "best": None if found.best is None else found.point(found.best),
        "complete": found.complete,
        "combinations_by_hand": found.by_hand,
        "limit": None if found.limit is None else found.limit.__dict__,
        "gains": [gain.__dict__ for gain in found.gains],
        "solved": solved,
    }
    return dict(finite(told, {}))


def print_lightest(found: "Lightest", console: "Console") -> None:
    """Print the result.

    Parameters
    ----------
    found : Lightest
    console : rich.console.Console
    """
    from alula.reports.study.rows import number_text
    from alula.reports.words.terminal import say, say_table

    sought = f"{'Greatest' if found.objective.largest else 'Least'} {found.objective.quantity}"
    if found.best is None:
        say(console, "No combination that was solved passes over its whole band.", style="bold")
    else:
        say(
            console,
            f"{sought} that passes: {_cost(found, found.best)} with {_values(found, found.best)}.",
            style="bold",
        )
        if found.limit is not None:
            say(
                console,
                f"There {number_text(found.limit)} limits it"
                + "".join(_gained(found, gain) for gain in found.gains)
                + ".",
            )
    total = 1
    for axis in found.axes:
        total *= len(axis.values)
    say(
        console,
        f"Of {total} combinations {found.by_hand} were calculated by hand, and {len(found.solved)} solved by the model "
        "that decides.",
    )
    if not found.complete:
        say(console, "The search did not end within these: go on with a larger --most and the same folder.")
    heads = [*((axis.path, False) for axis in found.axes), (found.objective.quantity, True), ("verdict", False)]
    ordered = sorted(found.solved, key=lambda place: found.objective.cost(found.solved[place]))
    rows = [[*map(str, found.point(place).values()), _cost(found, place), *_outcome(found, place)] for place in ordered]
    say_table(console, [*heads, ("nearest to its limit", False)], rows)


def _values(found: "Lightest", place: "Place") -> str:
    return ", ".join(f"{path} = {value}" for path, value in found.point(place).items())


def _cost(found: "Lightest", place: "Place") -> str:
    from alula.reports.words.numbers import number

    cost = found.objective.number(found.solved[place])
    return "" if cost is None else number(cost.value) + ("" if cost.unit == "1" else f" {cost.unit}")


def _outcome(found: "Lightest", place: "Place") -> tuple[str, str]:
    from alula.fea.study.margin import nearest
    from alula.reports.study.rows import number_text

    result = found.solved[place]
    limit = nearest(result)
    return str(result.verdict or result.state), result.sentence if limit is None else number_text(limit)


def _gained(found: "Lightest", gain: "Gain") -> str:
    from alula.reports.words.numbers import percent

    model = ", by hand calculation" if gain.by_hand else ""
    changes = f"changes it by {percent(gain.share)} and the {found.objective.quantity} by {percent(gain.cost)}"
    return f"; {gain.path} = {gain.value} {changes}{model}"
