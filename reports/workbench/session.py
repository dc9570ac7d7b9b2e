"""One open case: its document, who answers it, which pages are told, and the file that it is saved in."""

import asyncio
import json
from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import AlulaError, CaseError
from alula.geometry.linkage.pose import Pose
from alula.loads.compose.starting import case_files, write_new
from alula.loads.text.explain import printable
from alula.loads.text.file_text import LARGEST_FILE
from alula.reports.workbench.editing.document import Document
from alula.reports.workbench.editing.edits import EMPTY
from alula.reports.workbench.editing.toml_text import value_at
from alula.reports.workbench.keeping import Drafts, case_text, digest, plain_name, writable, write_file
from alula.reports.workbench.live.answers import case_of
from alula.reports.workbench.live.solids import Solids
from alula.reports.workbench.live.workers import Workers

PERIOD = 1.0
"""Seconds from one look at the disk to the next, and from one draft to the next."""
QUIET = 15.0
"""Seconds after which a page that hears nothing is sent a comment, which tells whether it is still there."""
MOST_PAGES = 16
"""Pages that hear of changes at once: each holds a connection."""
DRAWING = "empty"
"""What one starts from who draws all links, beside the built-in cases."""


class ConflictError(AlulaError):
    """What a page asks does not fit how the case stands now; nothing was changed."""


class Listener:
    """What a page has not been told yet: of each kind of event the newest, so that nothing piles up for a slow one."""

    def __init__(self) -> None:
        self._waiting: dict[str, str] = {}
        self._any = asyncio.Event()
        self._closed = False

    def put(self, kind: str, message: str) -> None:
        """Have a message sent, in place of one of its kind that waits.

        Parameters
        ----------
        kind, message : str
        """
        self._waiting.pop(kind, None)
        self._waiting[kind] = message
        self._any.set()

    def close(self) -> None:
        """End the stream."""
        self._closed = True
        self._any.set()

    async def messages(self) -> AsyncIterator[str]:
        """Yield what waits and what comes, as a stream of server-sent events takes it."""
        yield f"retry: {1000 * PERIOD:.0f}\n\n"
        while not self._closed:
            self._any.clear()
            while self._waiting:
                yield self._waiting.pop(next(iter(self._waiting)))
            try:
                await asyncio.wait_for(self._any.wait(), QUIET)
            except TimeoutError:
                yield ": still here\n\n"


class Session:
    """An open case, or none yet, in the event loop in which it is made.

    What a page asks is an asynchronous method, which raises a ``ConflictError``, ``CaseError`` or ``CannotRunError``
    with one sentence and has changed nothing then.

    Parameters
    ----------
    folder : Path
        In which cases are opened, and where files stand that they name.
    threads : int, optional
    memory : str, optional
        As for ``Solids``.

    Attributes
    ----------
    folder : Path
    path : Path
        The file of the open case.
    new : str
        What the page calls a new case until its user does.
    document : Document or None
        None before a case is open.
    solids : Solids
    """

    def __init__(self, folder: Path, threads: int = 2, memory: str | None = None) -> None:
        self.folder, self.path, self.new = folder, folder, "my-case.toml"
        self.document: Document | None = None
        self._stored = ""  # the text that the file held when it was last read or written
        self._disk: str | None = None
        self._always = False
        self._problem: dict[str, Any] | None = None
        self._drafts: Drafts | None = None
        self._draft: str | None = None  # what an earlier server kept, until it is taken or not
        self._since = 0.0  # when it kept that, in seconds since 1970
        self._drafted = ""
        self._pages: set[Listener] = set()
        self._last: dict[str, str] = {}
        self._notice = ""
        self._files = asyncio.Lock()
        self._workers, self.solids = Workers(self.tell, folder), Solids(self.tell, folder, threads, memory)
        self._watch = asyncio.create_task(self._watched())

    # What pages are told.

    def listen(self) -> Listener:
        """Return a page that hears how everything stands, and of all that changes from now on.

        Returns
        -------
        Listener
        """
        if len(self._pages) >= MOST_PAGES:
            raise ConflictError(f"{MOST_PAGES} pages show this workbench already; close one of them")
        page = Listener()
        self._pages.add(page)
        self._tell_document()
        for kind, message in self._last.items():
            page.put(kind, message)
        self._last = {kind: message for kind, message in self._last.items() if not kind.startswith("notice")}
        return page

    def leave(self, page: Listener) -> None:
        """Forget a page that is gone.

        Parameters
        ----------
        page : Listener
        """
        self._pages.discard(page)

    def tell(self, name: str, data: dict[str, Any]) -> None:
        """Tell all pages of an event; a ``problem`` becomes part of the document's.

        Parameters
        ----------
        name : str
        data : dict
            With the ``revision`` that it is about.
        """
        newest = self.document is not None and data.get("revision") == self.document.revision
        if name == "problem":
            if newest:
                self._find(str(data["sentence"]))
            return
        if name == "drawn" and newest and self._problem is not None and not data.get("problem"):
            self._problem = None
            self._tell_document()
        kind = f"{name} {data['sentence'] if name == 'notice' else data.get('stage', '')}"
        message = f"event: {name}\ndata: {json.dumps(data, ensure_ascii=False, allow_nan=False)}\n\n"
        if name not in ("notice", "document") or (name == "notice" and not self._pages):
            self._last[kind] = message
        for page in self._pages:
            page.put(kind, message)

    def _say(self, sentence: str) -> None:
        """Tell a sentence, unless it is the one that was told last."""
        if sentence != self._notice:
            self._notice = sentence
            self.tell("notice", {"sentence": sentence})

    def _find(self, sentence: str) -> None:
        self._problem = {"sentence": sentence, "line": self.opened().line_of(sentence)}
        self._tell_document()

    def _tell_document(self) -> None:
        document, path = self.document or Document(""), self.path if self.document else None
        state = {
            "revision": document.revision,
            "text": document.text,
            "name": path and path.name,
            "path": path and str(path),
            "saved": self.saved,
            "always": self._always,
            "undo": document.can_undo,
            "redo": document.can_redo,
            "tables": _plain(document),
            "problem": self._problem,
            "disk": self._disk,
            "draft": None if self._draft is None else self._since,
        }
        self.tell("document", state)

    # What changes the document.

    async def edit(self, revision: int, operations: Sequence[Mapping[str, Any]], gesture: str) -> None:
        """Change the case by operations, which were made on a revision and are undone with others of their gesture."""
        if not all(isinstance(one, Mapping) for one in operations):
            raise CaseError("operations: each must be an object")
        text = self.opened(revision).text
        pose = await asyncio.to_thread(self._posed, text)
        self.opened(revision).apply(operations, pose, gesture)
        self._changed()

    async def write(self, revision: int, text: str, gesture: str) -> None:
        """Put another text in place of the one of a revision."""
        self.opened(revision).replace(text, gesture)
        self._changed()

    async def undo(self, revision: int | None, gesture: str = "", *, redo: bool = False) -> None:
        """Take back the last change, if it is of this gesture, or make the one anew that was taken back last."""
        document = self.opened(revision)
        document.redo() if redo else document.undo(gesture)
        self._changed()

    async def take_draft(self, take: bool) -> None:
        """Take what an earlier server kept, or let it go."""
        document, draft = self.opened(), self._draft
        if draft is None:
            raise ConflictError("no unsaved changes of this case are kept")
        self._draft = None
        if take:
            document.replace(draft)
        elif self._drafts is not None:
            self._drafts.drop()
        self._changed()

    async def check_solids(self, do: str) -> None:
        """Start or stop the check by solids."""
        document = self.opened()
        if do == "start":
            self.solids.start(document.revision, document.text, str(self.path))
        else:
            self.solids.stop()

    def opened(self, revision: int | None = None) -> Document:
        """Return the document, which has to be the one that a page knows.

        Parameters
        ----------
        revision : int, optional
            That the page knows.

        Returns
        -------
        Document
        """
        if self.document is None:
            raise ConflictError("no case is open; open one first")
        if revision is not None and revision != self.document.revision:
            raise ConflictError("the case has changed meanwhile, on another page or on the disk; look, and do it again")
        return self.document

    def _posed(self, text: str) -> Pose | None:
        """Return the pose of a text that balances by itself; other poses an edit finds on its own."""
        with suppress(AlulaError):
            if value_at(Document(text).tables(), ("pose", "equilibrium")):
                return solve_case_statics(case_of(text, str(self.path)), str(self.path)).pose
        return None

    def _changed(self) -> None:
        """Tell how the document stands after a change, and have it answered."""
        if self._draft is not None and self._set_aside(self._draft, "was not taken"):
            self._draft = None
        document = self.opened()
        self._tell_document()
        self._workers.ask(document.revision, document.text, str(self.path))

    # The file.

    @property
    def saved(self) -> bool:
        """Whether the file holds the text that is shown."""
        return self.document is None or (self.document.text == self._stored and self._disk in (None, "read-only"))

    async def open(self, path: str, starter: str = "", as_: str = "") -> None:
        """Open a case of the folder, or a built-in one that is copied there first."""
        async with self._files:
            if not self.saved:
                raise ConflictError("changes of the open case are not saved; save it first")
            file = self.folder / plain_name(as_ if starter else path, ".toml")
            if starter:
                write_new({file: EMPTY.encode()} if starter == DRAWING else case_files(starter, file))
            self.load(file, new=bool(starter))
            self.solids.stop()  # nobody waits for those of the case before

    def load(self, file: Path, *, new: bool = False) -> None:
        """Open a case, and offer what was not saved of it.

        Parameters
        ----------
        file : Path
            In the session's folder.
        new : bool, optional
            Whether it was made just now: what was not saved is of another one of its name.
        """
        text, revision = case_text(file), self.document.revision + 1 if self.document else 0
        if self._drafts is not None:
            self._drafts.close()
        self.path, self.document, self._drafts = file, Document(text), None
        self.document.revision = revision  # answers about the case before are not taken for its own
        self._always, self._problem, self._draft, self._last = False, None, None, {}
        self._stand(text)
        self._drafts = Drafts(file)
        if not self._drafts.alone:
            self._say("this case is open in another alula as well; what is not saved here is not kept")
        kept, base, self._since = self._drafts.kept()
        other = kept is not None and kept != text and (new or base != digest(text))
        if other and self._set_aside(kept or "", "was made from another text than the file has now"):
            kept = None
        self._changed()
        self._draft = None if kept == text else kept
        self._tell_document()

    async def save(self, always: bool | None = None) -> None:
        """Write the text into the file, from now on by itself if ``always`` says so."""
        async with self._files:
            self._look()
            if self._disk == "changed":
                raise ConflictError("another program has changed the file; take its text over, or overwrite it")
            await self._save("" if self._disk == "deleted" else self._stored)
            self._always = self._always if always is None else always
            self._tell_document()

    async def overwrite(self) -> None:
        """Write the text into the file, whatever stands there."""
        async with self._files:
            await self._save()

    async def reload(self) -> None:
        """Take the text of the file over; what was here comes back by undo."""
        async with self._files:
            document, text = self.opened(), case_text(self.path)
            document.replace(text)
            self._stand(text)
            self._changed()

    async def _save(self, over: str | None = None) -> None:
        """Write the text into the file, unless something else stands there than what it is written over."""
        text = self.opened().text
        if not text.strip() or len(text.encode()) > LARGEST_FILE:
            raise CaseError("the text is empty or larger than 1 MiB, so no case; it was not saved")
        await asyncio.to_thread(write_file, self.path, text, over)
        self._stand(text)
        self._tell_document()

    def _stand(self, text: str) -> None:
        """Take a text for the one that the file holds."""
        self._stored, self._disk, self._drafted, self._notice = text, None, "", ""
        if self.saved and self._drafts is not None and self._draft is None:
            self._drafts.drop()

    def _look(self) -> None:
        """See what another program has done to the file: where nothing is unsaved here, its text is taken over."""
        document, before, saved = self.opened(), self._disk, self.saved
        try:
            text, access = case_text(self.path), None if writable(self.path) else "read-only"
        except (CaseError, OSError) as error:
            there = self.path.exists()
            self._disk = "changed" if there else "deleted"
            self._say(str(error) if there else f"'{printable(self.path.name)}' is gone; save to write it anew")
        else:
            if document.text == self._stored != text:
                document.replace(text)
                self._stand(text)
                self._say("another program has changed the file; its text is taken over, and undo takes it back")
                self._changed()
            elif text == document.text != self._stored or (text == self._stored and before in ("changed", "deleted")):
                self._stand(text)
            self._disk = access if text == self._stored else "changed"
        if (self._disk, self.saved) != (before, saved):
            self._tell_document()

    async def _watched(self) -> None:
        while True:
            await asyncio.sleep(PERIOD)
            try:
                await self._tick()
            except Exception as error:  # whatever it is, the next look and draft are due
                self._say(str(error))

    async def _tick(self) -> None:
        """Look at the disk, and keep what is not saved."""
        async with self._files:
            if self.document is None:
                return
            self._look()
            text = self.document.text
            if self._always and not self.saved and self._disk is None:
                try:
                    await self._save(self._stored)
                except AlulaError as error:
                    self._say(str(error))
            if not self.saved and text != self._drafted and self._drafts is not None and self._draft is None:
                await asyncio.to_thread(self._drafts.keep, text, self._stored)
                self._drafted = text

    def _set_aside(self, draft: str, why: str) -> bool:
        """Give a draft a file of its own, and say so; where that fails it is still offered, and no other is kept."""
        place = self._drafts.set_aside(draft) if self._drafts is not None else None
        told = "cannot be set aside, and is still offered" if place is None else f"{why}; it stands in '{place}'"
        self._say(f"what was not saved earlier {told}")
        return place is not None

    async def close(self) -> None:
        """Keep what is not saved, and end streams and workers."""
        self._watch.cancel()
        for page in self._pages:
            page.close()
        if self._drafts is not None:
            if not self.saved and self._draft is None:
                with suppress(AlulaError):
                    self._drafts.keep(self.opened().text, self._stored)
            self._drafts.close()
        await asyncio.gather(self._workers.close(), self.solids.close())


def _plain(document: Document) -> Any:
    """Return the tables of a document as JSON has them, with times and what is no number as text, or None."""
    try:
        return json.loads(json.dumps(document.tables(), default=str), parse_constant=str)
    except CaseError:
        return None
