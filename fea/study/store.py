"""The one file of a study: SQLite, written by one process alone, one transaction a finished point.

Tables (``docs/studies.md`` repeats them):

* ``study(name, value)``: the plan as JSON, the versions.
* ``results(id, key, state, verdict, sentence, attempts, seconds, processor)``: one row a variant that was computed;
  ``key`` is the digest of all that its answer depends on.
* ``quantities(id, check_name, subject, load_case, quantity, unit)``: what is known of variants.
* ``numbers(result, quantity, value, low, high, limit_value, verdict)``: one row a number.
* ``points(position, result, parameters)``: which result each point of the present plan has; parameters as JSON.
* The view ``variants``: one row a point with a column for each entry that varies, state, verdict,
  mass and least safety factor.
"""

import json
import math
import os
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from alula.fea.common.verdict import Verdict
from alula.fea.study.numbers import State, VariantNumber, VariantResult
from alula.geometry.base.errors import CannotRunError, CaseError, unwritable
from alula.geometry.base.locks import locked

NAME = "study.sqlite"
VERSION = 1
"""Of the tables; ``_UPGRADES`` brings an older file to it."""
ATTEMPTS = 3
"""Times that a variant is tried whose worker dies."""
_TABLES = """
CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE results (
    id INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE, state TEXT NOT NULL, verdict TEXT, sentence TEXT NOT NULL,
    attempts INTEGER NOT NULL, seconds REAL NOT NULL, processor REAL NOT NULL);
CREATE TABLE quantities (
    id INTEGER PRIMARY KEY, check_name TEXT NOT NULL, subject TEXT NOT NULL, load_case TEXT NOT NULL,
    quantity TEXT NOT NULL, unit TEXT NOT NULL, UNIQUE (check_name, subject, load_case, quantity, unit));
CREATE TABLE numbers (
    result INTEGER NOT NULL REFERENCES results, quantity INTEGER NOT NULL REFERENCES quantities, value REAL, low REAL,
    high REAL, limit_value REAL, verdict TEXT, PRIMARY KEY (result, quantity)) WITHOUT ROWID;
CREATE TABLE points (
    position INTEGER PRIMARY KEY, result INTEGER NOT NULL REFERENCES results, parameters TEXT NOT NULL);
"""
_UPGRADES: Mapping[int, str] = {}
"""Version of a file -> statements that bring it to the next one."""


class Store:
    """A study's file. Use ``writing`` for the one that computes, ``reading`` for all others.

    Parameters
    ----------
    connection : sqlite3.Connection
    """

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._db = connection
        self._quantities: dict[tuple[str, ...], int] = {}

    @classmethod
    @contextmanager
    def writing(cls, folder: Path) -> "Iterator[Store]":
        """Open or create the file of a folder, alone.

        Parameters
        ----------
        folder : Path
            It is created where it is not there.

        Yields
        ------
        Store

        Raises
        ------
        CaseError
            For a folder that cannot be made there or that another study is writing, and a file that is none of a study
            or of a newer version.
        CannotRunError
            Where the disk refuses. What was finished before stands.
        """
        try:
            folder.mkdir(parents=True, exist_ok=True)
            held = locked(folder, wait=False)
        except OSError as error:
            told = f"output: '{folder}' cannot be written ({error.strerror}); choose another"
            raise unwritable(told, error) from None
        try:
            if held is None and _can_lock():
                raise CaseError(
                    f"output: another study is writing to '{folder}'; wait for it, or choose another folder"
                )
            with _said(folder, _WRITING), cls._open(folder / NAME, "rwc") as store:
                store._require_known(folder)
                store._prepare()
                yield store
        finally:
            if held is not None:
                os.close(held)

    @classmethod
    @contextmanager
    def reading(cls, folder: Path) -> "Iterator[Store]":
        """Open the file of a folder to look at it, also while it is being written.

        Parameters
        ----------
        folder : Path

        Yields
        ------
        Store

        Raises
        ------
        CaseError
            For a folder without a study, or in which none was begun yet.
        CannotRunError
            Where the file cannot be read.
        """
        if not (folder / NAME).is_file():
            raise CaseError(f"'{folder}' holds no study ({NAME}); give the folder that 'alula study' wrote")
        with (
            _said(folder, "'{file}' cannot be read ({told}); check its permissions, try again, or give another folder"),
            cls._open(folder / NAME, "rw" if os.access(folder, os.W_OK) else "ro") as store,
        ):
            store._require_known(folder)
            if not (store._version() and store.facts()):
                raise CaseError(
                    f"'{folder}' holds no study yet: {NAME} has no plan and no point; compute one into it with "
                    "'alula study CASE --vary ... -o FOLDER'"
                )
            yield store

    @classmethod
    @contextmanager
    def _open(cls, path: Path, mode: str) -> "Iterator[Store]":
        connection = sqlite3.connect(f"{path.absolute().as_uri()}?mode={mode}", uri=True, isolation_level=None)
        try:
            connection.execute("PRAGMA foreign_keys = ON")
            yield cls(connection)
        finally:
            connection.close()

    def _version(self) -> int:
        [version] = self._db.execute("PRAGMA user_version").fetchone()
        return int(version)

    def _require_known(self, folder: Path) -> None:
        tables = self._db.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
        version = self._version()
        if version > VERSION:
            raise CaseError(f"output: the study in '{folder}' was written by a newer alula; install that version")
        if tables and not version:
            raise CaseError(f"output: '{folder / NAME}' is no study of alula; choose another folder")

    def _prepare(self) -> None:
        """Create the tables, or bring them to today's version."""
        self._db.execute("PRAGMA journal_mode = WAL")
        self._db.execute("PRAGMA synchronous = NORMAL")
        with self._transaction():
            if not self._version():
                for statement in filter(str.strip, _TABLES.split(";")):
                    self._db.execute(statement)
                self._db.execute(f"PRAGMA user_version = {VERSION}")
            while (version := self._version()) < VERSION:
                for statement in filter(str.strip, _UPGRADES[version].split(";")):
                    self._db.execute(statement)
                self._db.execute(f"PRAGMA user_version = {version + 1}")

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._db.execute("BEGIN IMMEDIATE")
        try:
            yield
        except BaseException:
            self._quantities.clear()  # some of them may be gone again
            with suppress(sqlite3.Error):  # a full disk has rolled it back already
                self._db.execute("ROLLBACK")
            raise
        self._db.execute("COMMIT")

    def facts(self) -> dict[str, Any]:
        """Return what the study says of itself.

        Returns
        -------
        dict
            ``plan`` and further names; empty for a new file.
        """
        return {name: json.loads(value) for name, value in self._db.execute("SELECT name, value FROM study")}

    def begin(self, facts: Mapping[str, object], paths: Sequence[str]) -> None:
        """Begin or go on with a study: its results stand; another plan's points are assigned anew.

        Parameters
        ----------
        facts : mapping
            What ``facts`` gives back; at least ``plan`` and how many ``points`` it has.
        paths : sequence of str
            The entries that differ between points: columns of the view ``variants``.
        """
        with self._transaction():
            if self.facts().get("plan") != facts["plan"]:
                self._db.execute("DELETE FROM points")
            self._db.execute("DELETE FROM points WHERE position >= ?", (facts["points"],))
            rows = [(name, json.dumps(value)) for name, value in facts.items()]
            self._db.executemany("INSERT OR REPLACE INTO study VALUES (?, ?)", rows)
            self._db.execute("DROP VIEW IF EXISTS variants")
            self._db.execute(_view(paths))

    def known(self) -> dict[str, tuple[State, int]]:
        """Return state and attempts of every variant that was computed, by its key.

        Returns
        -------
        dict of str to tuple
        """
        rows = self._db.execute("SELECT key, state, attempts FROM results")
        return {key: (state, attempts) for key, state, attempts in rows}

    def place(self, positions: Sequence[tuple[int, str, Mapping[str, object]]]) -> None:
        """Assign results that stand to points, in one transaction.

        Parameters
        ----------
        positions : sequence of tuple
            Position, key and parameters of each point.
        """
        with self._transaction():
            for position, key, parameters in positions:
                self._place(position, key, parameters)

    def _place(self, position: int, key: str, parameters: Mapping[str, object]) -> None:
        self._db.execute(
            "INSERT OR REPLACE INTO points SELECT ?, id, ? FROM results WHERE key = ?",
            (position, json.dumps(parameters), key),
        )

    def add(self, position: int, key: str, parameters: Mapping[str, object], answer: VariantResult) -> None:
        """Keep an answer: all of it, or nothing of it. An earlier crash of the same variant counts as an attempt.

        Parameters
        ----------
        position : int
            Of the point.
        key : str
            Of the variant.
        parameters : mapping
            Entry -> value.
        answer : VariantResult
        """
        with self._transaction():
            self._db.execute(
                "INSERT INTO results (key, state, verdict, sentence, attempts, seconds, processor)"
                " VALUES (?, ?, ?, ?, 1, ?, ?) ON CONFLICT (key) DO UPDATE SET state = excluded.state,"
                " verdict = excluded.verdict, sentence = excluded.sentence, attempts = attempts + 1,"
                " seconds = excluded.seconds, processor = excluded.processor",
                (key, answer.state, answer.verdict, answer.sentence, answer.seconds, answer.processor),
            )
            [number] = self._db.execute("SELECT id FROM results WHERE key = ?", (key,)).fetchone()
            self._db.execute("DELETE FROM numbers WHERE result = ?", (number,))
            rows = [
                (number, self._quantity(f), *map(_real, (f.value, f.low, f.high, f.limit)), f.verdict)
                for f in answer.numbers
            ]
            self._db.executemany("INSERT INTO numbers VALUES (?, ?, ?, ?, ?, ?, ?)", rows)
            self._place(position, key, parameters)

    def _quantity(self, found: VariantNumber) -> int:
        named = (found.check, found.subject, found.load_case, found.quantity, found.unit)
        if named not in self._quantities:
            columns = "check_name, subject, load_case, quantity, unit"
            self._db.execute(f"INSERT OR IGNORE INTO quantities ({columns}) VALUES (?, ?, ?, ?, ?)", named)
            wanted = f"SELECT id FROM quantities WHERE ({columns}) = (?, ?, ?, ?, ?)"
            self._quantities[named] = self._db.execute(wanted, named).fetchone()[0]
        return self._quantities[named]

    def counts(self) -> dict[str, int]:
        """Return how many points have each verdict, or state where there is none.

        Returns
        -------
        dict of str to int
        """
        asked = (
            "SELECT coalesce(r.verdict, r.state), count(*) FROM points p JOIN results r ON r.id = p.result GROUP BY 1"
        )
        return dict(self._db.execute(asked))

    def rows(
        self, positions: Sequence[int] | None = None
    ) -> Iterator[tuple[int, dict[str, object], VariantResult, int]]:
        """Yield every point that has a result, in order.

        Parameters
        ----------
        positions : sequence of int, optional
            These points alone.

        Yields
        ------
        tuple
            Position, parameters, answer, attempts.
        """
        asked = (
            "SELECT p.position, p.parameters, r.id, r.state, r.verdict, r.sentence, r.seconds, r.processor, r.attempts"
            " FROM points p JOIN results r ON r.id = p.result"
        )
        if positions is not None:
            asked += f" WHERE p.position IN ({', '.join(str(int(one)) for one in positions)})"
        for position, parameters, number, state, verdict, sentence, seconds, processor, attempts in self._db.execute(
            f"{asked} ORDER BY p.position"
        ):
            answer = VariantResult(
                state=state,
                verdict=Verdict(verdict) if verdict else None,
                sentence=sentence,
                seconds=seconds,
                processor=processor,
            )
            yield position, json.loads(parameters), replace(answer, numbers=self._numbers(number)), attempts

    def _numbers(self, number: int) -> tuple[VariantNumber, ...]:
        asked = (
            "SELECT check_name, subject, load_case, q.quantity, unit, value, low, high, limit_value, verdict"
            " FROM numbers f JOIN quantities q ON q.id = f.quantity WHERE f.result = ? ORDER BY f.quantity"
        )
        return tuple(
            VariantNumber(
                check=check,
                subject=subject,
                load_case=load_case,
                quantity=quantity,
                unit=unit,
                value=_number(value),
                low=_number(low),
                high=_number(high),
                limit=_number(limit),
                verdict=Verdict(verdict) if verdict else None,
            )
            for check, subject, load_case, quantity, unit, value, low, high, limit, verdict in self._db.execute(
                asked, (number,)
            )
        )


def _view(paths: Sequence[str]) -> str:
    """The view of points: one column an entry, then what became of it."""
    columns = [f"""json_extract(p.parameters, '$."{_quoted(path)}"') AS "{path.replace('"', "")}",""" for path in paths]
    return (
        f"CREATE VIEW variants AS SELECT p.position, {' '.join(columns)} r.state, r.verdict, r.sentence, r.attempts,"
        " r.seconds, r.processor, (SELECT f.value FROM numbers f JOIN quantities q ON q.id = f.quantity WHERE"
        " f.result = r.id AND q.quantity = 'mass' AND q.subject = 'the linkage') AS mass_g,"
        " (SELECT CASE WHEN count(*) = count(f.low) THEN min(f.low) END FROM numbers f JOIN quantities q"
        " ON q.id = f.quantity WHERE f.result = r.id AND"
        " q.quantity = 'safety factor') AS least_safety_factor FROM points p JOIN results r ON r.id = p.result"
    )


def _quoted(path: str) -> str:
    return path.replace('"', "").replace("'", "''")


def _real(value: float) -> float | None:
    return None if math.isnan(value) else value


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def _can_lock() -> bool:
    try:
        import fcntl  # noqa: F401
    except ImportError:
        return False
    return True


_WRITING = "output: writing to '{file}' failed ({told}); all points that were finished before stand there"


@contextmanager
def _said(folder: Path, sentence: str) -> Iterator[None]:
    """Turn what SQLite refuses into a sentence, with the file and its words."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        told = str(error)
        if "not a database" in told or "malformed" in told:
            raise CaseError(f"output: '{folder / NAME}' is no study of alula, or it is damaged; move it away") from None
        raise CannotRunError(sentence.format(file=folder / NAME, told=told)) from None
