"""A case as it is stated, in a file or in Python, link by link: ``alula.Case``.

What is stated are the tables of a case file. Each entry is held against its model when it is added; whether all names
fit together can be known at the end alone, so that it is asked when the case is used: ``StatedCase.record``.
"""

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import takewhile
from operator import eq
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Self

from annotated_types import MinLen
from pydantic import BaseModel, ValidationError, create_model

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.base.units import BODY_WEIGHT
from alula.geometry.base.version import CASE_SCHEMA_VERSION
from alula.geometry.imported.files_read import files_read
from alula.loads.acting.cycle import of_cycle
from alula.loads.case.case import Case
from alula.loads.case.case_file import (
    Change,
    changed_case,
    changed_tables,
    folder_of,
    keys_of,
    parse_tables,
    read_tables,
    stated_tables,
)
from alula.loads.compose.case_text import case_text, name_files, write_case
from alula.loads.compose.plain import mapping_of, path_text, plain, text_of
from alula.loads.stated.level_file import with_level_file
from alula.loads.stated.part_points import FROM_PART
from alula.loads.text.entries import alike
from alula.loads.text.explain import printable, sentence

Tables = dict[str, Any]
_ANY_POINTS = {"A": ["0 mm", "0 mm"], "B": ["1 mm", "0 mm"]}
"""Of a link whose part says where its points are: they are asked for with all others."""

_NO_FILE = "made"
"""Module of the models that are made here: no source has the texts of their entries."""


@dataclass(frozen=True, eq=False, repr=False, init=False)
class StatedCase:
    """A case: a linkage with its pose, drive, parts, load cases and checks.

    It never changes: each method returns another case. Entries, units and rules are those of the case file, where
    ``case.with_link("crank", part="bar", ...)`` is ``[links.crank]``. A number with a unit is text, such as ``"3 mm"``,
    or a quantity of pint; an array of bare numbers is a link's point in mm. What is None is left out. What is added is
    checked at once by itself, and together with all else when the case is used. Its entries are attributes then:
    ``case.parts["bar"].thickness`` is a number in mm, N, MPa.

    Parameters
    ----------
    title : str
        What the case is, in a line.
    folder : str or path, optional
        Where files of parts are sought; when left out, the folder that is the present one now.
    **entries : object
        Further ones of the top level of a case file: ``layer_spacing``, or whole tables such as ``links``.

    Raises
    ------
    CaseError
        For an unknown entry, and a value that breaks its rule.

    Examples
    --------
    >>> import alula
    >>> case = alula.Case("Lever")
    >>> case = case.with_link("base", ground=True, points={"O": ("0 mm", "0 mm")})
    >>> points = {"O": ("0 mm", "0 mm"), "P": ("60 mm", "0 mm")}
    >>> case = case.with_link("lever", part="bar", points=points, end_patch="8 mm")
    >>> case = case.with_joint("O", links=("base", "lever"), pin_diameter="3 mm")
    >>> bar = {"material": "aluminium-6061-t6", "width": "8 mm", "thickness": "4 mm", "fillet_radius": "2 mm"}
    >>> case = case.with_part("bar", shape="bar", **bar)
    >>> case = case.with_pose(coordinate="lever", angle="0 deg").with_drive(link="lever", joint="O")
    >>> case = case.with_load_case("grip", forces=[{"link": "lever", "at": "P", "force": ("0 N", "-5 N")}])
    >>> case = case.with_check("strength", type="safety-factor").with_check("eyes", type="eye", minimum=2.4)
    >>> report = alula.check(case, fidelity="beam")
    >>> print(report.verdict, f"{report.safety_factors['lever'].value:.1f}")
    pass 21.2
    """

    _tables: Tables
    _changes: tuple[Change, ...]
    _folder: str
    _name: str
    _read: Mapping[str, str]

    def __init__(self, title: str | None = None, *, folder: "str | PathLike[str]" = "", **entries: object) -> None:
        tables = {"schema_version": CASE_SCHEMA_VERSION}
        self.__dict__.update(_tables=tables, _changes=(), _folder=_absolute(folder), _name="", _read={})
        self.__dict__.update(_tables=self.with_entries(title=title, **entries)._tables)

    @classmethod
    def _of(
        cls, tables: Tables, changes: tuple[Change, ...], folder: str, name: str, read: Mapping[str, str] | None = None
    ) -> Self:
        made = cls.__new__(cls)
        made.__dict__.update(_tables=tables, _changes=changes, _folder=folder, _name=name, _read=read or {})
        return made

    @classmethod
    def read(cls, name_or_path: "str | PathLike[str]") -> Self:
        """Read a case, as ``alula.read_case`` does.

        Parameters
        ----------
        name_or_path : str or path
            Name of a built-in case, or path of a case file.

        Returns
        -------
        StatedCase
            Checked as a whole.

        Raises
        ------
        CaseError
            With one sentence for whatever is wrong.
        """
        name = path_text(name_or_path, "case")
        with files_read() as read:
            tables = read_tables(name)
        found = cls._of(tables, (), _absolute(folder_of(name)), name, read)
        _ = found.record
        return found

    @classmethod
    def from_dict(cls, tables: Mapping[str, object], *, folder: "str | PathLike[str]" = "") -> Self:
        """Return the case that the tables of a case file state.

        Parameters
        ----------
        tables : mapping of str to object
            As ``tomllib`` reads them, or with values as ``alula.Case`` takes them.
        folder : str or path, optional
            Where files of parts are sought; the present folder when left out.

        Returns
        -------
        StatedCase
            Checked as a whole.

        Raises
        ------
        CaseError
            With one sentence for whatever is wrong.
        """
        found = cls._of(plain(mapping_of(tables, "from_dict", "the tables of a case"), ""), (), _absolute(folder), "")
        _ = found.record
        return found

    @cached_property
    def record(self) -> Case:
        """The case as a whole, which all analyses take.

        Raises
        ------
        CaseError
            With one sentence for what is missing, and for names that do not fit together.
        """
        return changed_case(self._tables, self._changes, self._name, self._folder, self._read)

    def with_values(self, values: Mapping[str, object]) -> Self:
        """Return the case with other values for some entries.

        Parameters
        ----------
        values : mapping of str to object
            New value by the path of its entry, as for ``--set`` of the command: ``"parts.tube.outer_diameter"``, or
            ``"links.AE.points.P.0"`` for the first entry of a list.

        Returns
        -------
        StatedCase
            Checked as a whole, with all that follows from the entries.

        Raises
        ------
        CaseError
            For an entry that the case does not have, and a value that breaks a rule.

        Examples
        --------
        >>> import alula
        >>> case = alula.read_case("owl-wing-static")
        >>> thicker = case.with_values({"parts.tube.outer_diameter": "6 mm"})
        >>> case.parts["tube"].outer_diameter, thicker.parts["tube"].outer_diameter  # mm
        (5.0, 6.0)
        """
        changes = (
            Change(text_of(path, "with_values", "path of an entry"), plain(value, path), "with_values")
            for path, value in mapping_of(values, "with_values", "entries and their values").items()
        )
        found = self._of(self._tables, (*self._changes, *changes), self._folder, self._name, self._read)
        _ = found.record
        return found

    def with_entries(self, **entries: object) -> Self:
        """Return the case with entries of the top level of a case file, in place of those that it has.

        Parameters
        ----------
        **entries : object
            Such as ``layer_spacing="4 mm"``, ``conditions={"temperature": "37 degC"}``, ``carried=[...]``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For an unknown entry, and a value that breaks its rule.
        """
        given = {name: value for name, value in entries.items() if value is not None}
        stated = {name: plain(value, name) for name, value in given.items()}
        for name, value in stated.items():
            _check({name: value}, self._folder)
        tables, others = self._apart_from(*stated)
        return self._of(tables | stated, others, self._folder, "")

    def with_link(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more link.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``ground=True``, ``part="bar"``, ``points={"O": ("0 mm", "0 mm")}``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("links", name, entries, replace)

    def with_joint(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more joint.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``links=("base", "crank")``, ``pin_diameter="3 mm"``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("joints", name, entries, replace)

    def with_part(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more part.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``shape="bar"``, ``material="pla-fdm-xy"``, ``file=Path("lever.step")``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("parts", name, entries, replace)

    def with_material(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more material.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Of its card, such as ``density="1240 kg/m^3"``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("materials", name, entries, replace)

    def with_load_case(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more load case.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``forces=[{"link": "rocker", "at": "P", "force": ("0 N", "-5 N")}]``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("load_cases", name, entries, replace)

    def with_check(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more check.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``type="displacement"``, ``maximum="1 mm"``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("checks", name, entries, replace)

    def with_spring(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more spring.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``joint="O2"``, ``stiffness="20 N*mm/rad"``, ``free_angle="40 deg"``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("springs", name, entries, replace)

    def with_tendon(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more tendon.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``through=[{"link": "base", "at": "S"}, {"link": "crank", "at": "P"}]``, ``tension="5 N"``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("tendons", name, entries, replace)

    def with_stop(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more stop.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            Such as ``joint="O2"``, ``at_most="100 deg"``.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("stops", name, entries, replace)

    def with_hand_calculation(self, name: str, *, replace: bool = False, **entries: object) -> Self:
        """Return the case with one more hand calculation.

        Parameters
        ----------
        name : str
            Its name.
        replace : bool
            True for another in the place of one that has the name.
        **entries : object
            As ``[hand_calculations]`` of the case file has them.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For a name that is taken, an unknown entry, and a value that breaks its rule.
        """
        return self._adding("hand_calculations", name, entries, replace)

    def with_pose(self, **entries: object) -> Self:
        """Return the case with this pose that is checked, in place of the one that it has.

        Parameters
        ----------
        **entries : object
            As ``[pose]`` of the case file has them.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For an unknown entry, and a value that breaks its rule.
        """
        return self.with_entries(pose=entries)

    def with_drive(self, **entries: object) -> Self:
        """Return the case with this drive, in place of the one that it has.

        Parameters
        ----------
        **entries : object
            As ``[drive]`` of the case file has them.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For an unknown entry, and a value that breaks its rule.
        """
        return self.with_entries(drive=entries)

    def with_motion(self, **entries: object) -> Self:
        """Return the case with this motion, in place of the one that it has.

        Parameters
        ----------
        **entries : object
            As ``[motion]`` of the case file has them.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For an unknown entry, and a value that breaks its rule.
        """
        return self.with_entries(motion=entries)

    def without(self, *paths: str) -> Self:
        """Return the case without some entries.

        Parameters
        ----------
        *paths : str
            Each with dots, such as ``"links.crank"``, ``"motion"``, ``"load_cases.lift.forces.0"``. What the table
            ``"ornithopter"`` sets stays when it is removed.

        Returns
        -------
        StatedCase

        Raises
        ------
        CaseError
            For an entry that is not there.
        """
        found = self
        every = [keys_of(text_of(path, "without", "path of an entry")) for path in paths]
        # Of a list the last ones first: where another one is removed, those behind it move.
        for keys in sorted(every, key=lambda keys: [*(-int(key) if key.isdecimal() else 0 for key in keys), 1]):
            if len(keys) == 1 and keys[0] in Case.derived(found._tables):  # what it sets stays
                tables = changed_tables(found._tables, found._changes)
                others: tuple[Change, ...] = ()
            else:  # removed from a list, an entry moves those behind it
                tables, others = found._apart_from(".".join(takewhile(lambda key: not key.isdecimal(), keys)))
            tables = deepcopy(tables)
            _remove(tables, keys)
            found = found._of(tables, others, found._folder, "")
        return found

    def to_dict(self, *, folder: "str | PathLike[str]" = "") -> Tables:
        """Return the tables of a case file that states the case.

        Parameters
        ----------
        folder : str or path, optional
            In which the file is to stand; the present folder when left out. Files of parts below it are named from
            there, others by their whole path; what a level file states stands in the tables themselves.

        Returns
        -------
        dict of str to object
            For ``from_dict``; made anew, so that it may be changed.

        Raises
        ------
        CaseError
            Where values were changed that the case cannot have, or that a table of the case would set again.
        """
        tables = changed_tables(self._tables, self._changes)
        if changed_tables(tables, ()) != tables:
            table = ", ".join(Case.derived(tables))
            raise CaseError(
                f"{table}: this table sets entries that were changed, and would set them again; remove it with "
                f'without("{table}")'
            )
        tables = with_level_file(tables, self._folder, parse_tables)
        name_files(tables, self._folder, Path(_absolute(folder)))
        return tables

    def of_study(self) -> Tables:
        """Return what a study's plan says of its case: the file, or the tables where none states this case.

        Returns
        -------
        dict of str to object
            Entries of ``StudyPlan``.

        Raises
        ------
        CaseError
            For a case that is not complete.
        """
        title = self.record.title
        unchanged = self._name and not self._changes
        return {"case": self._name} if unchanged else {"case": self._name or title, "tables": self.to_dict()}

    def to_toml(self, path: "str | PathLike[str] | None" = None, *, replace: bool = False) -> str:
        """Return the text of a case file that states the case, and write it.

        Comments of a file that it was read from are not in it. Files of parts stay where they are; those below the
        folder of the new file, or the present one without a path, are named from there.

        Parameters
        ----------
        path : str or path, optional
            File to write.
        replace : bool
            True to write over a file that is there.

        Returns
        -------
        str
            Read, it is equal to this case.

        Raises
        ------
        CaseError
            For a case that is not complete, and a file that is there.
        CannotRunError
            Where the file cannot be written.
        """
        _ = self.record
        folder = Path(path_text("case.toml" if path is None else path, "to_toml")).absolute().parent
        stated = case_text(self.to_dict(folder=folder))
        if path is not None:
            write_case(Path(path), stated, replace=replace)
        return stated

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in _attributes():
            raise AttributeError(f"a case has no attribute '{name}'{alike(name, _attributes())}", name=name, obj=self)
        found = getattr(self.record, name)
        return dict(found) if isinstance(found, dict) else found  # a copy: a case never changes

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *_attributes()})

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, StatedCase | Case):
            return NotImplemented
        return self is other or self._meaning == (other if isinstance(other, Case) else other._meaning)

    __hash__ = None  # type: ignore[assignment]  # it holds dictionaries

    @property
    def _meaning(self) -> object:
        """The record, or what is stated so far where that is no whole case."""
        try:
            return self.record
        except CaseError:
            return self._tables, self._changes, self._folder

    def __repr__(self) -> str:
        counts = (
            f"{len(found)} {table.replace('_', ' ') if len(found) != 1 else one}"
            for table, one in (("links", "link"), ("joints", "joint"), ("load_cases", "load case"))
            if isinstance(found := self._tables.get(table, {}), dict)
        )
        return f"Case({printable(str(self._tables.get('title', '')))!r}: {', '.join(counts)})"

    def _adding(self, table: str, name: str, entries: Mapping[str, object], replace: bool) -> Self:
        if not isinstance(replace, bool):
            raise CaseError(f"replace: it must be True or False, not {type(replace).__name__}; write one of them")
        name = text_of(name, table, "name")
        path = f"{table}.{name}"
        tables, others = self._apart_from(path)
        there = tables.get(table, {})
        if name in there and not replace:
            raise CaseError(f"{printable(path)}: there is one of that name already; rename it, or say replace=True")
        if replace and name not in there:
            raise CaseError(f"{printable(path)}: there is none to replace{alike(name, there) or '; leave replace out'}")
        entry = plain(entries, path)
        _check({table: {name: entry}}, self._folder)
        return self._of(tables | {table: there | {name: entry}}, others, self._folder, "")

    def _apart_from(self, *paths: str) -> tuple[Tables, tuple[Change, ...]]:
        """Return tables in which some entries may be stated anew, and the changes that are not about these.

        The others are made in the tables: what they set stands there, and is not set again.
        """
        stated = [keys_of(path) for path in paths]
        about = [c for c in self._changes if any(all(map(eq, keys, keys_of(c.path))) for keys in stated)]
        others = tuple(c for c in self._changes if c not in about)
        return stated_tables(self._tables, about) if about else self._tables, others


def _absolute(folder: object) -> str:
    """Return a folder as it is called from everywhere: the present one may be another when the case is used."""
    return str(Path(path_text(folder, "folder")).absolute())


def _check(tables: Tables, folder: str) -> None:
    """Hold one entry of the top level against its model.

    Raises
    ------
    CaseError
        As for a case file.
    """
    [table] = tables
    if table == "links" and isinstance(tables[table], dict):  # an imported part gives its link the points
        tables = {table: {name: _with_any_points(link) for name, link in tables[table].items()}}
    if of_cycle(table, tables[table]):  # only the file of the cycle tells what it is
        return
    tables = with_level_file(tables, folder, parse_tables)
    try:
        _model_of(table).model_validate(tables, context={"folder": folder, BODY_WEIGHT: 1.0})  # of any body
    except ValidationError as error:
        raise CaseError(sentence(error, Case)) from None


def _with_any_points(link: object) -> object:
    imported = isinstance(link, dict) and "part" in link and link.get("points", FROM_PART) == FROM_PART
    return {**link, "points": _ANY_POINTS} if imported and isinstance(link, dict) else link


@cache
def _model_of(table: str) -> type[BaseModel]:
    """Return a model of one entry of the top level; how many must be there can be known at the end alone."""
    field = Case.model_fields.get(table)
    if field is None:
        return create_model("Stated", __base__=CaseModel, __module__=_NO_FILE)
    kind: Any = field.annotation
    for rule in field.metadata:
        kind = kind if isinstance(rule, MinLen) else Annotated[kind, rule]
    definitions: dict[str, Any] = {table: (kind, ...)}
    return create_model("Stated", __base__=CaseModel, __module__=_NO_FILE, **definitions)


@cache
def _attributes() -> frozenset[str]:
    """Return the names of what a record of a case tells."""
    told = {name for name in dir(Case) if not name.startswith("_") and not hasattr(BaseModel, name)}
    return frozenset(told | Case.model_fields.keys())


def _remove(tables: Tables, keys: list[str]) -> None:
    """Remove an entry from tables that are made for it."""
    here: Any = tables
    for depth, key in enumerate(keys):
        there = printable(".".join(keys[:depth])) or "the case"
        if isinstance(here, list):
            known: tuple[str, ...] = tuple(map(str, range(len(here))))
        else:
            known = tuple(here) if isinstance(here, dict) else ()
        if key not in known:
            path = printable(".".join(keys))
            raise CaseError(f"without '{path}': {there} has no '{printable(key)}'{alike(key, known)}")
        index: Any = int(key) if isinstance(here, list) else key
        if depth == len(keys) - 1:
            del here[index]
        else:
            here = here[index]
