"""The case that is open: its text, edits that keep comments and order, undo and redo, and the line of a problem."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.pose import Pose
from alula.loads.case.case_file import parse_tables
from alula.reports.workbench.editing.edits import perform
from alula.reports.workbench.editing.toml_text import TomlText

_MARK = "\ufeff"
"""A byte order mark, which some editors put ahead of a text."""


class Document:
    """The text of one case, its history, and what it states.

    It holds any text, also one that is no TOML; such a text can be replaced, but not edited by entries.

    Attributes
    ----------
    text : str
        The text with its line ends and its byte order mark, if it has one.
    revision : int
        Grows by one with each change, undo and redo.

    Parameters
    ----------
    text : str
        Of the file.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.revision = 0
        self._done: list[str] = []
        self._undone: list[str] = []
        self._gesture = ""
        self._read: tuple[str, dict[str, Any]] | None = None

    @property
    def can_undo(self) -> bool:
        """Whether there is a change to take back."""
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        """Whether a change was taken back."""
        return bool(self._undone)

    def tables(self) -> dict[str, Any]:
        """Return what the text states, which must not be changed.

        Returns
        -------
        dict of str to object
            As ``tomllib`` reads it.

        Raises
        ------
        CaseError
            For text that is no TOML.
        """
        if self._read is None or self._read[0] != self.text:
            self._read = self.text, parse_tables(self.text.removeprefix(_MARK), "case")
        return self._read[1]

    def apply(self, operations: Sequence[Mapping[str, Any]], pose: Pose | None, gesture: str = "") -> None:
        """Make edits, all or none of them.

        Parameters
        ----------
        operations : sequence of mapping
            As ``edits.perform`` takes them.
        pose : Pose, optional
            The pose in which the drawing shows the case; None where it has none yet.
        gesture : str
            Consecutive edits of one gesture that has a name are one step of undo.

        Raises
        ------
        CaseError
            For an edit that cannot be made; nothing has changed then.
        """
        mark = _MARK if self.text.startswith(_MARK) else ""
        draft = TomlText(self.text.removeprefix(_MARK), self.tables())
        for operation in operations:
            perform(draft, operation, pose)
        text = mark + draft.text
        try:
            text.encode()
            made = parse_tables(draft.text, "case")
        except (CaseError, UnicodeEncodeError):  # half a pair of surrogates is no text
            made = None
        if made is None or made != draft.tables:
            raise CaseError("edit: it cannot be written into this text without changing more; write it in the text")
        self.replace(text, gesture)
        self._read = text, made

    def replace(self, text: str, gesture: str = "") -> None:
        """Put another text in its place.

        Parameters
        ----------
        text : str
            Any text.
        gesture : str
            As for ``apply``.
        """
        if text == self.text:
            return
        if not (gesture and gesture == self._gesture and self._done):
            self._done.append(self.text)
        self._undone.clear()
        self.text, self._gesture = text, gesture
        self.revision += 1

    def undo(self, gesture: str = "") -> None:
        """Take the last change back, if there is one.

        Parameters
        ----------
        gesture : str
            One that has a name is taken back where it made the last change.
        """
        if gesture in ("", self._gesture):
            self._step(self._done, self._undone)

    def redo(self) -> None:
        """Make the change that was taken back last once more, if there is one."""
        self._step(self._undone, self._done)

    def _step(self, source: list[str], target: list[str]) -> None:
        if source:
            target.append(self.text)
            self.text, self._gesture = source.pop(), ""
            self.revision += 1

    def line_of(self, problem: str) -> int | None:
        """Return the line of the entry, or of the mistake in TOML, that a ``CaseError`` tells of.

        Parameters
        ----------
        problem : str
            Its sentence.

        Returns
        -------
        int or None
            From 1; that of the nearest entry that holds it where it is missing, None where no entry is named.
        """
        try:
            tables = self.tables()
        except CaseError:
            if found := re.search(r"\(at line (\d+), column \d+\)", problem):
                return int(found[1])
            return self.text.rstrip().count("\n") + 1 if "at end of document" in problem else None
        entry = re.split(r"(?: \(it is .*)?[:,](?:\s|\Z)", problem, maxsplit=1)[0]
        path = [int(key) if key.isdecimal() else key.strip("\"'") for key in entry.split(".")]
        return TomlText(self.text.removeprefix(_MARK), tables).line(path)
