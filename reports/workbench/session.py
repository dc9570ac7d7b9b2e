"""One open case: its document, who answers it, who is told, and the file that it is saved in."""

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from alula.geometry.base.errors import AlulaError, CaseError
from alula.loads.text.explain import printable
from alula.reports.workbench.keeping import Draft, Drafts, Stamp, case_text, digest, plain_name, stamp_of, write_whole
from alula.reports.workbench.stand_in import Document, Solids, Workers

PERIOD = 1.0
"""Seconds from one look at the disk to the next, and from one draft to the next."""
QUIET = 15.0
"""Seconds after which a page that hears nothing is sent a comment: where it is gone, its stream ends."""
MOST_PAGES = 16
"""Pages that hear of changes at once; a browser itself keeps to six connections."""
OPENED = "no case is open; open one first"


class ConflictError(AlulaError):
    """What is asked does not fit how the case stands now; nothing was changed."""


class Page:
    """What a page has not been told yet: of each kind of event the newest, so that a slow one never piles up."""

    def __init__(self) -> None:
        self._waiting: dict[str, str] = {}
        self._any = asyncio.Event()
        self._closed = False

    def put(self, key: str, message: str) -> None:
        """Have a message sent, in place of an earlier one of its kind.

        Parameters
        ----------
        key : str
            The kind.
        message : str
        """
        self._waiting.pop(key, None)
        self._waiting[key] = message
        self._any.set()

    def close(self) -> None:
        """End the stream."""
        self._closed = True
        self._any.set()

    async def messages(self) -> AsyncIterator[str]:
        """Send what waits, and wait for more.

        Yields
        ------
        str
            As a stream of server-sent events takes it.
        """
        yield f"retry: {int(1000 * PERIOD)}\n\n"
        while not self._closed:
            self._any.clear()
            while self._waiting:
                yield self._waiting.pop(next(iter(self._waiting)))
            try:
                await asyncio.wait_for(self._any.wait(), QUIET)
            except TimeoutError:
                yield ": still here\n\n"


class Session:
    """An open case, or none yet. All of it runs in the event loop that it is made in; files are written beside it.

    Parameters
    ----------
    folder : Path
        In which cases are opened, and whose files they name.

    Attributes
    ----------
    folder : Path
    path : Path or None
        The file of the open case.
    document : Document or None
    disk : str or None
        ``changed``, ``deleted`` or ``read-only``, where the file is so.
    always : bool
        Whether changes are saved as one goes.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.path: Path | None = None
        self.document: Document | None = None
        self.disk: str | None = None
        self.always = False
        self._stored = ""  # the text of the file as it was last read or written
        self._drafted = ""
        self._stamp: Stamp | None = None
        self._problem: dict[str, Any] | None = None
        self._draft: Draft | None = None
        self._drafts: Drafts | None = None
        self._pages: set[Page] = set()
        self._last: dict[str, str] = {}
        self._told = ""
        self._files = asyncio.Lock()
        self._workers = Workers(self.tell, folder)
        self.solids = Solids(self.tell, folder)
        self._watch = asyncio.create_task(self._watched())

    @property
    def saved(self) -> bool:
        """Whether the file holds the text that is shown."""
        return self.document is None or (self.document.text == self._stored and self.disk != "deleted")

    # What pages are told.

    def listen(self) -> Page:
        """Return a page that hears of all that changes, and first of how everything stands.

        Returns
        -------
        Page

        Raises
        ------
        ConflictError
            For one page too many.
        """
        if len(self._pages) >= MOST_PAGES:
            raise ConflictError(f"{MOST_PAGES} pages show this workbench already; close one of them")
        page = Page()
        for key, message in {"document": self._message("document", self._state()), **self._last}.items():
            page.put(key, message)
        self._pages.add(page)
        return page

    def leave(self, page: Page) -> None:
        """Forget a page that is gone.

        Parameters
        ----------
        page : Page
        """
        self._pages.discard(page)

    def tell(self, name: str, data: dict[str, Any]) -> None:
        """Tell all pages what a worker found.

        Parameters
        ----------
        name : str
            Of the event; ``problem`` becomes part of the document's.
        data : dict
            With the ``revision`` that it is about.
        """
        newest = self.document is not None and data.get("revision") == self.document.revision
        if name == "problem":
            if newest:
                self._find(str(data["sentence"]))
            return
        if name == "drawn" and newest and self._problem is not None:
            self._problem = None
            self._tell_document()
        key = f"{name} {data.get('stage', '')}"
        message = self._message(name, data)
        if name != "notice":
            self._last[key] = message
        for page in self._pages:
            page.put(key, message)

    def notice(self, sentence: str) -> None:
        """Tell all pages a sentence, unless it is the one that they were told last.

        Parameters
        ----------
        sentence : str
        """
        if sentence != self._told:
            self._told = sentence
            self.tell("notice", {"sentence": sentence})

    @staticmethod
    def _message(name: str, data: Mapping[str, Any]) -> str:
        return f"event: {name}\ndata: {json.dumps(data, ensure_ascii=False, allow_nan=False)}\n\n"

    def _find(self, sentence: str) -> None:
        assert self.document is not None
        self._problem = {"sentence": sentence, "line": self.document.line_of(sentence)}
        self._tell_document()

    def _state(self) -> dict[str, Any]:
        document = self.document
        return {
            "revision": document.revision if document else 0,
            "text": document.text if document else "",
            "name": self.path.name if self.path else None,
            "path": str(self.path) if self.path else None,
            "saved": self.saved,
            "undo": bool(document and document.can_undo),
            "redo": bool(document and document.can_redo),
            "problem": self._problem,
            "disk": self.disk,
            "draft": self._draft is not None,
            "always": self.always,
        }

    def _tell_document(self) -> None:
        for page in self._pages:
            page.put("document", self._message("document", self._state()))

    # What changes the document.

    def edit(self, revision: int, operations: Sequence[Mapping[str, Any]], gesture: str) -> None:
        """Change the case by operations.

        Parameters
        ----------
        revision : int
            The revision that they were made on.
        operations : sequence of mapping
        gesture : str
            Edits that follow one another with the same one are undone together.

        Raises
        ------
        ConflictError
            Where the case has changed since.
        CaseError
            For an operation that cannot be.
        """
        document = self._at(revision)
        document.apply(operations, None, gesture)
        self._changed()

    def write(self, revision: int, text: str, gesture: str) -> None:
        """Change the text of the case.

        Parameters
        ----------
        revision : int
        text : str
        gesture : str
            As for ``edit``.

        Raises
        ------
        ConflictError
            Where the case has changed since.
        """
        self._at(revision).replace(text, gesture)
        self._changed()

    def undo(self) -> None:
        """Take back the last change."""
        self._document().undo()
        self._changed()

    def redo(self) -> None:
        """Make the change anew that was taken back last."""
        self._document().redo()
        self._changed()

    def _document(self) -> Document:
        if self.document is None:
            raise ConflictError(OPENED)
        return self.document

    def _at(self, revision: int) -> Document:
        document = self._document()
        if revision != document.revision:
            raise ConflictError("the case has changed meanwhile, on another page or on the disk; look, and do it again")
        return document

    def _changed(self) -> None:
        """Go on from a change."""
        if self._draft is not None:  # the one who was asked has gone on without it
            self._set_aside(self._draft, "was not taken")
            self._draft = None
        self._answer()

    def _answer(self) -> None:
        """Tell how the document stands, and have it answered."""
        document = self._document()
        try:
            document.tables()
        except CaseError as error:
            self._find(str(error))
            return
        self._tell_document()
        self._workers.ask(document.revision, document.text, str(self.path))

    def check_solids(self, start: bool, fidelity: str) -> None:
        """Start or stop the check by solids.

        Parameters
        ----------
        start : bool
        fidelity : str
            As for ``alula check``.
        """
        document = self._document()
        if start:
            self.solids.start(document.revision, document.text, str(self.path), fidelity)
        else:
            self.solids.stop()

    # The file.

    async def open(self, name: str) -> None:
        """Open a case of the folder.

        Parameters
        ----------
        name : str
            Of its file.

        Raises
        ------
        ConflictError
            Where changes of the open case are not saved.
        CaseError
            For a file that cannot be read.
        """
        async with self._files:
            if not self.saved:
                raise ConflictError("changes of the open case are not saved; save it first")
            path = self.folder / plain_name(name, ".toml")
            stamp, text, before = stamp_of(path), case_text(path), self.document
            if self._drafts is not None:
                self._drafts.close()
            self.path, self.document, self._drafts = path, Document(text), None
            if before is not None:
                self.document.revision = before.revision + 1  # answers about the case before are not taken for its
            self.always, self._problem, self._draft, self._last = False, None, None, {}
            self._stand(text, stamp)
            self._drafts = Drafts(path)
            if not self._drafts.alone:
                self.notice("this case is open in another alula as well; what is not saved here is not kept")
            kept = self._drafts.kept()
            if kept is not None and kept.base != digest(text):
                self._set_aside(kept, "belongs to another text than the file has now")
            elif kept is not None and kept.text != text:
                self._draft = kept
            self._answer()

    def take_draft(self, take: bool) -> None:
        """Take the changes that an earlier server kept, or let them go.

        Parameters
        ----------
        take : bool

        Raises
        ------
        ConflictError
            Where there are none.
        """
        document, draft = self._document(), self._draft
        if draft is None or self._drafts is None:
            raise ConflictError("no unsaved changes are kept of this case")
        self._draft = None
        if take:
            document.replace(draft.text)
            self._changed()
        else:
            self._drafts.drop()
            self._tell_document()

    async def save(self, always: bool | None = None) -> None:
        """Write the text into the file.

        Parameters
        ----------
        always : bool, optional
            Whether to do so from now on whenever it changes; as it was unless given.

        Raises
        ------
        ConflictError
            Where another program has changed the file.
        CaseError, CannotRunError
            As ``write_whole``.
        """
        async with self._files:
            self._document()
            self._look()
            if self.disk == "changed":
                raise ConflictError("another program has changed the file; take its text over, or overwrite it")
            self.always = self.always if always is None else always
            await self._save()

    async def overwrite(self) -> None:
        """Write the text into the file, whatever stands there.

        Raises
        ------
        CaseError, CannotRunError
            As ``write_whole``.
        """
        async with self._files:
            self._document()
            await self._save()

    async def reload(self) -> None:
        """Take the text of the file over; what was here can be had again by undo.

        Raises
        ------
        CaseError
            As ``case_text``.
        """
        async with self._files:
            document, path = self._document(), self._file()
            stamp, text = stamp_of(path), case_text(path)
            if text != document.text:
                document.replace(text)
            self._stand(text, stamp)
            self._changed()

    def _file(self) -> Path:
        assert self.path is not None
        return self.path

    async def _save(self) -> None:
        text, path = self._document().text, self._file()
        await asyncio.to_thread(write_whole, path, text)
        self._stand(text, stamp_of(path))
        self._tell_document()

    def _stand(self, text: str, stamp: Stamp | None) -> None:
        """Take a text for what the file holds."""
        self._stored, self._drafted, self._stamp = text, "", stamp
        self.disk = "read-only" if stamp is not None and not stamp.writable else None
        self._told = ""
        if self._drafts is not None and self._draft is None and self.saved:
            self._drafts.drop()

    def _look(self) -> None:
        """See whether another program has changed the file; without changes here its text is taken over."""
        document, path, stamp = self._document(), self._file(), stamp_of(self._file())
        if stamp == self._stamp and (stamp is not None or self.disk == "deleted"):
            return
        was_saved, before = document.text == self._stored, self.disk
        self._stamp, self.disk = stamp, "changed"
        if stamp is None:
            self.disk = "deleted"
            self.notice(f"'{printable(path.name)}' is gone; save to write it anew")
        else:
            try:
                text = case_text(path)
            except CaseError as error:
                self.notice(str(error))
            else:
                if text in (self._stored, document.text):
                    self._stand(text, stamp)
                elif was_saved:
                    document.replace(text)
                    self._stand(text, stamp)
                    self.notice("another program has changed the file; its text is taken over, and undo takes it back")
                    self._changed()
        if self.disk != before:
            self._tell_document()

    async def _watched(self) -> None:
        while True:
            await asyncio.sleep(PERIOD)
            try:
                await self.tick()
            except AlulaError as error:
                self.notice(str(error))

    async def tick(self) -> None:
        """Look at the disk, and keep what is not saved.

        Raises
        ------
        CaseError, CannotRunError
            As ``write_whole``.
        """
        if self.document is None:
            return
        async with self._files:
            self._look()
            if self.always and not self.saved and self.disk is None:
                await self._save()
            elif not self.saved and self.document.text != self._drafted and self._drafts is not None:
                text = self.document.text
                await asyncio.to_thread(self._drafts.keep, text, self._stored)
                self._drafted = text

    def _set_aside(self, draft: Draft, why: str) -> None:
        """Keep a draft in a file of its own, and say where."""
        with contextlib.suppress(AlulaError):
            place = self._drafts.set_aside(draft) if self._drafts is not None else None
            if place is not None:
                self.notice(f"what was not saved earlier {why}; it stands in '{place}'")

    async def close(self) -> None:
        """Keep what is not saved, and end the streams and the workers."""
        self._watch.cancel()
        for page in self._pages:
            page.close()
        with contextlib.suppress(AlulaError):
            if self.document is not None and not self.saved and self._drafts is not None:
                self._drafts.keep(self.document.text, self._stored)
        await asyncio.gather(self._workers.close(), self.solids.close())
        if self._drafts is not None:
            self._drafts.close()
