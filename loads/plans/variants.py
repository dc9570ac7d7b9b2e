"""The variants of a case that a study computes, each as the tables of a case file."""

import hashlib
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import Change, changed_tables, folder_of, read_tables
from alula.loads.plans.derived import derived_value, in_turn
from alula.loads.plans.plan import StudyPlan, case_name, table_of
from alula.loads.plans.points import Point, Points
from alula.loads.stated.part_points import named_files
from alula.loads.text.explain import printable, sentence

LEFT_OUT = ("published_statics", "claims")
"""Tables that say what a source published of the case as it stands, which no variant is."""


class Variants:
    """The points of a plan and the case at each.

    Parameters
    ----------
    plan : StudyPlan
    folder : Path
        That the plan's names are relative to.
    points : sequence of mapping, optional
        In place of those that the plan describes: of a search, which chooses them on its way.

    Attributes
    ----------
    plan : StudyPlan
    points : Points
    base : dict
        Tables of the case with what the plan sets, without ``LEFT_OUT``.
    files : dict of str to Path
        Files of the case's parts and of its cycle, by SHA-256 of their content.

    Raises
    ------
    CaseError
        For a case or a plan that is wrong at every point: an entry that the case file does not know, an expression of
        entries that the case does not state, a file that is not there.
    """

    def __init__(self, plan: StudyPlan, folder: Path, points: Sequence[Mapping[str, object]] | None = None) -> None:
        self.plan, self.name = plan, case_name(plan, folder)
        changes = [Change(path, value, "set") for path, value in plan.set.items()]
        self.base = changed_tables(plan.tables or read_tables(self.name), changes)
        for table in LEFT_OUT:
            self.base.pop(table, None)
        self.points = Points(plan.axes(), table_of(plan, folder), plan.sample) if points is None else Points((), points)
        self.files: dict[str, Path] = {}
        self._digests: dict[str, str] = {}
        _refuse_unknown(self.tables(self.points[0]))

    def __len__(self) -> int:
        """Return how many variants there are."""
        return len(self.points)

    def tables(self, point: Point) -> dict[str, Any]:
        """Return the case at a point, with every file named by the digest of its content.

        Parameters
        ----------
        point : dict of str to object
            Entry -> value.

        Returns
        -------
        dict of str to object
            Not validated.

        Raises
        ------
        CaseError
            For an entry that the case does not have, an expression that has no value there, and entries that follow
            from each other.
        """
        found = changed_tables(self.base, _changes(point, "vary"))

        def follow(path: str, waiting: Collection[str]) -> None:
            nonlocal found
            value = derived_value(found, path, self.plan.link[path], waiting)
            found = changed_tables(found, _changes({path: value}, "link"))

        in_turn(self.plan.link, follow)
        for entry, table, key in named_files(found):
            table[key] = self._digest(entry, table[key])
        return found

    def _digest(self, entry: str, stated: str) -> str:
        """Return the digest of a file with its suffix, which is its name wherever it travels."""
        if stated not in self._digests:
            path = Path("" if self.plan.tables else folder_of(self.name)) / stated
            try:
                with path.open("rb") as stream:
                    digest = hashlib.file_digest(stream, "sha256").hexdigest()
            except (OSError, ValueError) as error:
                why = getattr(error, "strerror", None) or "no such name"
                raise CaseError(f"{entry}: '{printable(stated)}' cannot be read ({why}); correct it") from None
            named = digest + path.suffix.lower()
            self.files[named], self._digests[stated] = path, named
        return self._digests[stated]


def _changes(point: Mapping[str, object], who: str) -> Sequence[Change]:
    return [Change(path, value, who) for path, value in point.items()]


def _refuse_unknown(tables: dict[str, Any]) -> None:
    """Refuse entries that no case file has: mistyped, they would make every point fail alike."""
    try:
        Case.model_validate(tables, context={"folder": ""})
    except CaseError:  # this point breaks a rule of cases; others may not
        return
    except ValidationError as error:
        if any(problem["type"] == "extra_forbidden" for problem in error.errors()):
            raise CaseError(sentence(error, Case)) from None
