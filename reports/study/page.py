"""``study.html``: one file with the pictures and tables of a study, which loads nothing from elsewhere."""

import os
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from alula.fea.common.verdict import Verdict
from alula.fea.study.store import NAME, Store
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import built_in_cases
from alula.reports.figures.study.choice import StudyPicture, pictures
from alula.reports.figures.study.style import LOOKS, tick
from alula.reports.page.output import place, refuse_unusable, write_folder
from alula.reports.page.template import fill
from alula.reports.study.columns import Parameter, StudyColumns, read_study
from alula.reports.study.rows import ALIKE, Row, number_text
from alula.reports.words.numbers import joined, number

PAGE = "study.html"
FOLDER = "pictures"
COMMAND = "study"
_MOST_WORDS = 12
_MOST_SENTENCES = 10


def write_study(folder: Path, output: Path, wanted: Sequence[str] = ()) -> Path:
    """Write the page and the pictures of a study.

    Parameters
    ----------
    folder : Path
        Of the study, which stays as it is.
    output : Path
        They are written into its subfolder ``study``.
    wanted : sequence of str, optional
        Parts of the names of numbers to be drawn.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    CaseError
        For a folder without a study, a study without points, and an output that is the folder of a study.
    CannotRunError
        Where the disk refuses.
    """
    refuse_folder(folder, output)
    with Store.reading(folder) as store:
        study = read_study(store, wanted)
    drawn, notes = pictures(study)

    def fill(target: Path) -> None:
        (target / PAGE).write_text(render(study, drawn, notes), encoding="utf-8")
        (target / FOLDER).mkdir()
        for picture in drawn:
            (target / FOLDER / f"{picture.name}.png").write_bytes(picture.png)

    write_folder(output, COMMAND, fill)
    return output / COMMAND / PAGE


def refuse_folder(folder: Path, output: Path) -> None:
    """Refuse a folder for the page before anything is computed for it.

    Parameters
    ----------
    folder : Path
        Of the study, which may not be there yet.
    output : Path
        For the page.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_study``.
    """
    if place(output, COMMAND) in (found := _whole(folder), found / COMMAND) or (place(output, COMMAND) / NAME).exists():
        raise CaseError(f"output: '{output}' is the folder of a study, which stays as it is; choose another folder")
    refuse_unusable(output, COMMAND, (PAGE,))


def _whole(folder: Path) -> Path:
    return Path(os.path.abspath(folder))


def render(study: StudyColumns, drawn: Sequence[StudyPicture], notes: Sequence[str] = ()) -> str:
    """Return the page of a study.

    Parameters
    ----------
    study : StudyColumns
    drawn : sequence of StudyPicture
    notes : sequence of str, optional
        Sentences on what cannot be drawn.

    Returns
    -------
    str
    """
    plan, heads = study.facts["plan"], _heads(study)
    lost = [(state, why, count) for (state, why), count in study.sentences.items()]
    extremes = [(which, row, number_text(row.nearest)) for which, row in study.extremes.items() if row.nearest]
    open_points = study.counts.get(Verdict.UNDECIDED.value, 0)
    return fill(
        "study.html.jinja",
        case=Path(plan["case"]).name,
        plan=plan,
        versions=study.facts["versions"],
        headline=headline(study),
        extremes=extremes,
        alike=ALIKE if open_points > 1 and not extremes else "",
        stated=_stated,
        varies=[(one.path, *_values(one)) for one in study.parameters],
        linked=plan["link"],
        fixed=plan["set"],
        checked=study.margin is not None,
        pictures=drawn,
        notes=(*notes, *_left_out(study)),
        limiting=list(study.limiting.items()),
        lost=lost[:_MOST_SENTENCES],
        more_lost=max(len(lost) - _MOST_SENTENCES, 0),
        heads=heads,
        rows=[(row, _cells(row, heads, study)) for row in study.rows],
        more=len(study.outcome) - len(study.rows),
        command=_command(study),
    )


def headline(study: StudyColumns) -> str:
    """Return how many points there are, and what became of them.

    Parameters
    ----------
    study : StudyColumns

    Returns
    -------
    str
        Such as ``40 points: 12 pass, 3 undecided and 25 fail.``
    """
    total, here = study.facts["points"], len(study.outcome)
    told = joined([f"{study.counts[name]} {name}" for name in LOOKS if name in study.counts])
    points = f"{here} points" if here == total else f"{here} of {total} points"
    return f"{points}: {told}."


def _left_out(study: StudyColumns) -> tuple[str, ...]:
    if not study.left_out:
        return ()
    return (f"{study.left_out} more numbers vary; --number with a part of a name draws others.",)


def _values(one: Parameter) -> tuple[str, int]:
    if one.words:
        words = list(one.words[:_MOST_WORDS])
        return ", ".join(words) + (" ..." if len(one.words) > _MOST_WORDS else ""), len(one.words)
    found = np.unique(one.values)
    unit = f" {one.unit}" if one.unit else ""
    if len(found) <= _MOST_WORDS:
        return ", ".join(tick(float(value)) for value in found) + unit, len(found)
    return f"{number(float(found[0]))} to {number(float(found[-1]))}{unit}", len(found)


def _stated(row: Row) -> str:
    return ", ".join(f"{path} = {value}" for path, value in row.parameters.items())


def _heads(study: StudyColumns) -> list[tuple[str, bool]]:
    """Titles of the table of points, each with True for numbers."""
    paths = dict.fromkeys(path for row in study.rows for path in row.parameters)
    found = [("Point", True), *((path, False) for path in paths), ("Verdict", False)]
    if study.margin is not None:
        found.append(("Nearest to its limit", False))
    found += [(response.label, True) for response in study.numbers]
    if study.mass is not None:
        found.append(("Mass [g]", True))
    return found


def _cells(row: Row, heads: Sequence[tuple[str, bool]], study: StudyColumns) -> list[str]:
    place = int(np.searchsorted(study.position, row.position))
    known: dict[str, Any] = {
        "Point": row.position,
        "Verdict": row.outcome,
        "Nearest to its limit": number_text(row.nearest) if row.nearest else "",
        "Mass [g]": "" if row.mass is None else number(row.mass, 4),
    }
    known |= {one.label: _shown(one.value[place]) for one in study.numbers}
    return [str(row.parameters[head] if head in row.parameters else known.get(head, "")) for head, _ in heads]


def _shown(value: float) -> str:
    return "" if np.isnan(value) else number(float(value), 4)


def _command(study: StudyColumns) -> str:
    """The command that checks the best point; "" where nothing is checked, and for a case that no file states."""
    plan, best = study.facts["plan"], study.extremes.get("best")
    if best is None or plan["analysis"] == "motion" or plan.get("tables"):
        return ""
    changes = {**plan["set"], **best.parameters}
    options = [word for path, value in changes.items() for word in ("--set", f"{path}={_text(value)}")]
    case = plan["case"] if plan["case"] in built_in_cases() else Path(plan["case"]).name
    return shlex.join(["alula", plan["analysis"], case, *options, "-o", "out"])


def _text(value: object) -> str:
    import json

    return value if isinstance(value, str) else json.dumps(value)
