"""Processes that answer while a case is edited: one tells poses, one verdicts; the newest text comes first.

Each takes a text through its stages. The first stage always runs to its end, so that numbers follow a drag however fast
it is; the later ones take longer, and are interrupted as soon as there is a newer text. Requests and answers are lines
of JSON on the child's standard input and output. A child ends with this process, whose end closes its input.
"""

import asyncio
import json
import os
import queue
import re
import signal
import sys
import threading
import time
from _thread import interrupt_main
from collections import OrderedDict
from collections.abc import Callable, Mapping
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from alula.geometry.base.child import environment, module_command

Plain = dict[str, Any]
Tell = Callable[[str, Plain], None]
Key = tuple[object, ...]
Kept = OrderedDict[Key, dict[str, dict[str, bytes]]]
"""Text -> stage -> event -> the line that told it last."""

ROLES: Mapping[str, tuple[str, ...]] = {"answers": ("pose", "motion"), "verdicts": ("linear", "whole")}
"""What each process answers, stage after stage, by the name of the module that does."""
_KEPT = 100
"""Texts whose answers are kept, some 200 kilobytes each: the last steps of undo and a drag."""
_LONGEST = 1 << 26
"""Longest line of a child [bytes]."""
_AGAIN = 0.5
"""Seconds after which a stage that has not stopped is interrupted once more: foreign code may swallow an exception, and
what is left behind in order takes less."""


class Workers:
    """What answers the texts of a case. It belongs to the event loop in which it is made.

    Parameters
    ----------
    tell : callable
        Takes the name of an event and its data, with the revision that it is of.
    folder : Path
        That of the case, whose files of parts enter the answers.
    """

    def __init__(self, tell: Tell, folder: Path) -> None:
        self._folder = folder
        kept = Kept()
        self._lines = [_Line(role, tell, kept) for role in ROLES]

    def ask(self, revision: int, text: str, name: str) -> None:
        """Ask for all answers to a text; what is still asked for an older one is left out.

        Parameters
        ----------
        revision : int
            With which answers are told.
        text : str
            Of the case file.
        name : str
            Its path or built-in name.
        """
        asked = _Asked(revision=revision, text=text, name=name, key=(text, name, *_files(self._folder, text)))
        for line in self._lines:
            line.ask(asked)

    async def close(self) -> None:
        """End both processes."""
        await asyncio.gather(*(line.close() for line in self._lines))


def _files(folder: Path, text: str) -> list[tuple[str, int, int]]:
    """Return the files that a text names, from a folder on, with their time and size."""
    found = []
    for name in sorted(set(re.findall(r"""["']([^"'\n]+\.\w+)["']""", text))):
        with suppress(OSError):  # no file
            state = (folder / name).stat()
            found.append((name, state.st_mtime_ns, state.st_size))
    return found


class _Asked(NamedTuple):
    revision: int
    text: str
    name: str
    key: Key


class _Line:
    """One process, and what it is asked."""

    def __init__(self, role: str, tell: Tell, kept: Kept) -> None:
        self._role, self._stages, self._tell, self._kept = role, ROLES[role], tell, kept
        self._asked: _Asked | None = None
        self._at_work: tuple[Key, str] | None = None
        self._child: asyncio.subprocess.Process | None = None
        self._new = asyncio.Event()
        self._task = asyncio.get_running_loop().create_task(self._run())

    def ask(self, asked: _Asked) -> None:
        self._asked = asked
        self._new.set()
        if self._at_work is not None and self._at_work[0] != asked.key and self._at_work[1] != self._stages[0]:
            self._send({"stop": True})

    async def close(self) -> None:
        self._task.cancel()
        with suppress(asyncio.CancelledError):
            await self._task
        await self._end()

    async def _end(self) -> None:
        self._at_work = None
        if self._child is not None and self._child.returncode is None:
            self._child.kill()
            await self._child.wait()

    def _send(self, request: Plain) -> None:
        assert self._child is not None
        assert self._child.stdin is not None
        with suppress(ConnectionError):  # it has ended, and the missing answer tells
            self._child.stdin.write(json.dumps(request).encode() + b"\n")

    async def _run(self) -> None:
        with suppress(OSError):  # the first text tells
            await self._start()
        while True:
            await self._new.wait()
            self._new.clear()
            asked = self._asked
            assert asked is not None
            for stage in self._stages:
                if stage != self._stages[0] and self._new.is_set():
                    break
                try:
                    await self._answer(asked, stage)
                except Exception as error:  # it cannot be started, a line is no answer, or a mistake of alula's own
                    wrong = f"the {stage} of this text was not found: {error}"
                    self._tell("notice", {"revision": asked.revision, "sentence": wrong})
                    await self._end()

    async def _start(self) -> None:
        pipe, command = asyncio.subprocess.PIPE, module_command(__name__, self._role)
        self._child = await asyncio.create_subprocess_exec(
            *command, stdin=pipe, stdout=pipe, stderr=asyncio.subprocess.DEVNULL, env=environment(), limit=_LONGEST
        )

    async def _answer(self, asked: _Asked, stage: str) -> None:
        """Tell what a stage answers to a text, from what is kept where it was answered before."""
        known = self._kept.setdefault(asked.key, {})
        self._kept.move_to_end(asked.key)
        while len(self._kept) > _KEPT:
            self._kept.popitem(last=False)
        if stage in known:
            for line in known[stage].values():
                self._heard(asked, json.loads(line))
            return
        if self._child is None or self._child.returncode is not None:
            await self._start()
        self._at_work = asked.key, stage
        told = await self._told(asked, stage)
        self._at_work = None
        if told is not None:
            known[stage] = told

    def _heard(self, asked: _Asked, answer: Plain) -> None:
        self._tell(answer["event"], {"revision": asked.revision, **answer["data"]})

    async def _told(self, asked: _Asked, stage: str) -> dict[str, bytes] | None:
        """Return what the process told, None where it was stopped."""
        assert self._child is not None
        assert self._child.stdout is not None
        told: dict[str, bytes] = {}
        self._send({"stage": stage, "text": asked.text, "name": asked.name})
        while line := await self._child.stdout.readline():
            answer = json.loads(line)
            if "done" in answer:
                return told if answer["done"] else None
            told[answer["event"]] = line
            self._heard(asked, answer)
        ended = f"the process that answers the {stage} of a text ended by itself (status {await self._child.wait()})"
        again = f"{ended}; it is started anew, and this text is not asked of it again"
        self._tell("notice", {"revision": asked.revision, "sentence": again})
        await self._start()
        return told  # the same text would end it again


class _StoppedError(KeyboardInterrupt):
    """A stage is to end, since there is a newer text."""


class _Service:
    """The child's side: takes one request at a time, and alone writes to standard output."""

    def __init__(self) -> None:
        self._requests: queue.Queue[Plain] = queue.Queue()
        self._in, self._out = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
        nowhere = os.open(os.devnull, os.O_RDWR)
        os.dup2(nowhere, 0)
        os.dup2(nowhere, 1)
        self._stoppable, self._stop = False, False

    def run(self, stages: Mapping[str, Callable[..., None]]) -> None:
        """Answer requests until the parent ends, and this process with it."""
        signal.signal(signal.SIGINT, self._interrupted)
        threading.Thread(target=self._read, daemon=True).start()
        while True:
            request = self._requests.get()
            stage = request.pop("stage")
            try:
                self._stoppable = True
                self._interrupted()  # a stop may be there already
                stages[stage](tell=self._tell, **request)
                self._stoppable, done = False, True
            except _StoppedError:
                self._stoppable, done = False, False
            except Exception as error:  # a mistake of alula's own, which leaves the next text to be answered
                self._stoppable, done = False, not self._stop  # a library may tell another error where ours was raised
                wrong = f"the {stage} of this text was not found: {type(error).__name__}: {error}"
                if done:
                    self._write({"event": "notice", "data": {"sentence": wrong}})
            self._write({"done": done})

    def _interrupted(self, *_: object) -> None:
        """Raise in the main thread, which alone takes signals and says whether it may be stopped."""
        if self._stop and self._stoppable:
            raise _StoppedError

    def _read(self) -> None:
        for line in self._in:
            request = json.loads(line)
            if "stop" in request:
                self._stop = True
                threading.Thread(target=self._press, daemon=True).start()
            else:
                self._stop = False
                self._requests.put(request)
        os._exit(1)

    def _press(self) -> None:
        while self._stop and self._stoppable:
            interrupt_main(signal.SIGINT)
            time.sleep(_AGAIN)

    def _tell(self, event: str, data: Plain) -> None:
        self._stoppable = False  # a line is whole or none
        self._write({"event": event, "data": data})
        self._stoppable = True
        self._interrupted()

    def _write(self, answer: Plain) -> None:
        self._out.write(json.dumps(answer, allow_nan=False).encode() + b"\n")
        self._out.flush()


if __name__ == "__main__":
    _Service().run(import_module(f"alula.reports.workbench.live.{sys.argv[1]}").STAGES)  # imported while the page loads
