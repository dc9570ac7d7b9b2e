"""What a study is asked to do: ``study.toml``, or the same from the options of the command."""

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError
from pydantic.json_schema import SkipJsonSchema

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Text
from alula.loads.case.case_file import built_in_cases, read_tables
from alula.loads.plans.axis import Axis, axis
from alula.loads.text.explain import printable, sentence

Value = str | int | float | bool
LARGEST_TABLE = 256 << 20
"""Bytes of a file of points."""


class Sample(CaseModel):
    """A space-filling sample of the ranges instead of their grid."""

    method: Literal["latin-hypercube", "sobol"] = "latin-hypercube"
    """Sobol's points balance best where their number is a power of two."""
    count: Annotated[int, Field(ge=1, le=10_000_000)]
    """How many points."""
    seed: Annotated[int, Field(ge=0)] = 0
    """Equal seeds give equal points, bit for bit, with one version of scipy."""


class StudyPlan(CaseModel):
    """Many variants of one case."""

    schema_version: Literal[1] = 1
    """Version of this format."""
    case: Text
    """Name of a built-in case, or path of a case file, relative to the folder of this file."""
    tables: SkipJsonSchema[dict[Text, Any]] = {}
    """The tables of a case that was composed in Python; ``case`` is its title then. A file needs none."""
    analysis: Literal["check", "motion", "envelope"] = "check"
    """What is done with every variant, as by the command of that name."""
    set: Annotated[dict[Text, Any], Field(max_length=200)] = {}
    """Other values for some entries of the case, the same in all variants."""
    vary: Annotated[dict[Text, str | list[Value]], Field(max_length=64)] = {}
    """Entry -> its values: a list, or a range such as ``"2 mm..8 mm/7"`` or ``"2 mm..8 mm by 1 mm"``; for a sample
    ``"2 mm..8 mm"``."""
    link: Annotated[dict[Text, Text], Field(max_length=64)] = {}
    """Entry -> expression of other entries, beside it or by their whole path, such as
    ``"outer_diameter + 2*fillet_radius"``."""
    points: Text = ""
    """A CSV file of points: entries in its first line, one point a line below, beside this file; they are combined with
    each value that is varied."""
    sample: Sample | None = None
    """A sample of the ranges in place of their grid."""
    fidelity: Literal["auto", "beam", "frame", "solid"] = "auto"
    """Model of a check."""
    accuracy: Text | None = None
    """Discretisation error to reach in every link, such as ``"5 %"``."""
    mass: bool | Literal["rough"] | None = None
    """Whether the links are weighed, ``"rough"`` by length and section; by default where solids are built anyway."""

    @property
    def weighs(self) -> bool | Literal["rough"]:
        """Whether the links are weighed."""
        return self.fidelity in ("auto", "solid") and self.analysis != "motion" if self.mass is None else self.mass

    def axes(self) -> tuple[Axis, ...]:
        """Return what is varied, in order.

        Returns
        -------
        tuple of Axis

        Raises
        ------
        CaseError
            As ``axis``; for a range without count that no sample chooses values of.
        """
        found = tuple(axis(path, stated) for path, stated in self.vary.items())
        for one in found:
            if not one.values and self.sample is None:
                raise CaseError(
                    f"vary {printable(one.path)}: the range does not say how many values it has; write for example "
                    '"2 mm..8 mm/7", or ask for a sample'
                )
        return found


def read_plan(path: Path, changes: Mapping[str, object] | None = None) -> tuple[StudyPlan, Path]:
    """Read a plan.

    Parameters
    ----------
    path : Path
        Of ``study.toml``.
    changes : mapping, optional
        Entries to put in place of those of the file.

    Returns
    -------
    StudyPlan
    Path
        The folder that its names are relative to.

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong.
    """
    return plan_of(read_tables(str(path)) | dict(changes or {})), path.parent


def plan_of(data: Mapping[str, Any]) -> StudyPlan:
    """Validate a plan.

    Parameters
    ----------
    data : mapping
        Its tables.

    Returns
    -------
    StudyPlan

    Raises
    ------
    CaseError
        With one sentence for the first problem.
    """
    try:
        plan = StudyPlan.model_validate(data)
    except ValidationError as error:
        raise CaseError(f"study: {sentence(error, StudyPlan)}") from None
    varied = [*plan.vary, *plan.link]
    if twice := [path for path in plan.vary if path in plan.link]:
        raise CaseError(f"study: '{printable(twice[0])}' is varied and linked; leave one of the two out")
    if not varied and not plan.points:
        raise CaseError('study: nothing varies; state an entry and its values, ENTRY = "2 mm..8 mm/7"')
    if plan.sample is not None and not plan.vary:
        raise CaseError("study: a sample needs ranges or lists that are varied; state them, or leave the sample out")
    return plan


def case_name(plan: StudyPlan, folder: Path) -> str:
    """Return what ``read_case`` takes.

    Parameters
    ----------
    plan : StudyPlan
    folder : Path
        That its names are relative to.

    Returns
    -------
    str
        A built-in name, or a path.
    """
    return plan.case if plan.case in built_in_cases() else str(folder / plan.case)


def table_of(plan: StudyPlan, folder: Path) -> list[dict[str, str]]:
    """Read the file of points.

    Parameters
    ----------
    plan : StudyPlan
    folder : Path
        That its names are relative to.

    Returns
    -------
    list of dict
        One point each: entry -> value; a single point without entries where the plan names no file.

    Raises
    ------
    CaseError
        For a file that cannot be read, a line of another length, and an entry without name or twice.
    """
    if not plan.points:
        return [{}]
    path, shown = folder / plan.points, printable(plan.points)
    try:
        if path.stat().st_size > LARGEST_TABLE:
            raise CaseError(f"points: '{shown}' is larger than {LARGEST_TABLE >> 20} MiB, the limit; split it")
        text = path.read_bytes().decode("utf-8-sig")
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else "it is no UTF-8 text"
        raise CaseError(f"points: '{shown}' cannot be read ({why}); state a CSV file") from None
    try:
        lines = [line for line in csv.reader(text.splitlines(), strict=True) if line and not line[0].startswith("#")]
    except csv.Error as error:
        raise CaseError(f"points: '{shown}' is not valid CSV ({error}); correct it") from None
    head = [name.strip() for name in lines[0]] if lines else []
    if not all(head) or len(set(head)) < len(head) or len(lines) < 2:
        raise CaseError(f"points: '{shown}' needs a first line that names each entry once, and points below it")
    for number, line in enumerate(lines[1:], 1):
        if len(line) != len(head):
            raise CaseError(
                f"points: point {number} of '{shown}' has {len(line)} values for {len(head)} entries; correct that line"
            )
    if clash := [name for name in head if name in plan.vary or name in plan.link]:
        raise CaseError(f"points: '{printable(clash[0])}' is varied or linked as well; state it in one place")
    return [dict(zip(head, (value.strip() for value in line), strict=True)) for line in lines[1:]]
