"""The check by solids in the background: a process that tells how far each link is, its model, and the verdict.

What was solved before is kept (``alula.geometry.keeping.kept``): a changed link alone is solved anew, and what ended
before a check was stopped is found by the next one. A check is stopped by killing its process and the meshers that it
started.

What the page does:

* ``POST /solids {"do": "start"}`` starts it, ``{"do": "stop"}`` stops it.
* The event ``solids`` has ``links``: name -> ``state`` (``waiting``, ``solving``, ``done``, or ``kept`` where all was
  found), ``seconds`` since its state began or that it took, and ``model``, a number that grows with each model of the
  link, from check to check as well; 0 without one. Where it has grown, ``GET /model/{link}`` has the model.
* A model is shown by the viewer that reports have: the page loads ``viewer.js`` as a classic script with ``defer``, and
  ``turnable.css``; then ``window.alulaViewer.show(parent, "link", text)`` takes an element and the answer's text, puts
  the model first into it, and returns an object whose ``remove()`` takes it away again, or null without WebGL. Remove a
  model before another is shown in its place, and where its ``<details>`` or tab is closed: all share one context.
* The event ``verdict`` with ``stage`` ``solids`` has the form of that by hand, so that bands stand side by side: the
  same check, subject and load case in both. Its ``revision`` says which text it is of; where that is not the one of the
  document, it is out of date. It has no changes: those of the verdict by hand stand.
"""

import asyncio
import json
import os
import signal
import tempfile
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from alula.geometry.base.child import environment, last_line, module_command
from alula.geometry.base.errors import AlulaError, CaseError

Plain = dict[str, Any]
Tell = Callable[[str, Plain], None]

ROLE = __name__.rpartition(".")[2]
"""Under which a process of ``alula.reports.workbench.live.workers`` answers with ``STAGES``."""
_LONGEST = 1 << 28
"""Longest line of the process [bytes]: a model with a million nodes on its surface."""


class Solids:
    """The check by solids of the open case. It belongs to the event loop in which it is made.

    Parameters
    ----------
    tell : callable
        Takes the name of an event, ``solids`` or ``verdict``, and its data.
    folder : Path
        That of the case.
    threads : int, optional
    memory : str, optional
        Limits of the process, as ``alula check`` takes them.
    """

    def __init__(self, tell: Tell, folder: Path, threads: int = 2, memory: str | None = None) -> None:
        self._tell, self._folder, self._limits = tell, folder, {"threads": threads, "memory": memory}
        self._run: _Run | None = None
        self._ending: set[asyncio.Task[None]] = set()

    def start(self, revision: int, text: str, name: str) -> None:
        """Begin a check, in place of one that is at work.

        Parameters
        ----------
        revision : int
            With which everything is told.
        text : str
            Of the case file.
        name : str
            Its path or built-in name.
        """
        if self._run is not None:
            self._run.stop()
        self._ending = {task for task in self._ending if not task.done()}
        request = {"stage": ROLE, "text": text, "name": name, **self._limits}
        self._run = _Run(self._tell, self._folder, revision, request)
        self._ending.add(self._run.task)

    def stop(self) -> None:
        """End the check at once; what its links told stands."""
        if self._run is not None:
            self._run.stop("Stopped; what was solved is kept")

    def model(self, link: str) -> Plain:
        """Return the model of a link, as ``alula.reports.turnable.link.link_model`` makes it.

        Parameters
        ----------
        link : str

        Returns
        -------
        dict

        Raises
        ------
        CaseError
            Where there is none.
        """
        found = {} if self._run is None else self._run.models
        if link not in found:
            raise CaseError(f"'{link}': there is no solid of this link; check with solids first")
        model: Plain = json.loads(found[link])
        return model

    async def close(self) -> None:
        """End the check, and wait for all processes that were started."""
        if self._run is not None:
            self._run.stop()
        await asyncio.gather(*self._ending)


class _Run:
    """One check in its process."""

    def __init__(self, tell: Tell, folder: Path, revision: int, request: Plain) -> None:
        self._told, self._folder, self._revision, self._request = tell, folder, revision, request
        self._state, self._sentence, self._silent = "running", "Reading the case ...", False
        self._links: dict[str, Plain] = {}
        self._since: dict[str, float] = {}
        self._child: asyncio.subprocess.Process | None = None
        self.models: dict[str, str] = {}
        self.task = asyncio.get_running_loop().create_task(self._work())
        self._tell()

    def stop(self, sentence: str = "") -> None:
        """Kill the process and its children, and tell it; without a sentence nothing is told any more."""
        self._silent = self._silent or not sentence
        if self._state == "running":
            self._end("stopped", sentence)
            self._kill()

    def _kill(self) -> None:
        if self._child is None or self._child.returncode is not None:
            return
        with suppress(ProcessLookupError):
            if hasattr(os, "killpg"):
                os.killpg(self._child.pid, signal.SIGKILL)  # it leads a group of its own
            else:
                self._child.kill()

    def _tell(self) -> None:
        if self._silent:
            return
        now, links = time.monotonic(), {}
        for name, link in self._links.items():
            seconds = now - self._since[name] if link["state"] == "solving" else link["seconds"]
            links[name] = {**link, "seconds": round(seconds, 2)}
        ended = sum(link["state"] in ("done", "kept") for link in links.values())
        so_far = f"Stresses of {ended} of {len(links)} links are solved. " if links and self._state == "running" else ""
        told = {"revision": self._revision, "state": self._state, "sentence": so_far + self._sentence, "links": links}
        self._told("solids", told)

    def _end(self, state: str, sentence: str) -> None:
        self._state, self._sentence = state, sentence
        for link in self._links.values():  # it was not needed, or not reached
            if link["state"] in ("waiting", "solving"):
                link["state"] = "done" if state == "done" else "waiting"
        self._tell()

    async def _work(self) -> None:
        """Start the process, take what it tells, and say how it ended."""
        pipe, status = asyncio.subprocess.PIPE, None
        with tempfile.TemporaryFile() as complaints:
            try:
                self._child = child = await asyncio.create_subprocess_exec(
                    *module_command("alula.reports.workbench.live.workers", ROLE), stdin=pipe, stdout=pipe,
                    stderr=complaints, env=environment(), cwd=self._folder, limit=_LONGEST, start_new_session=True,
                )  # fmt: skip
                assert child.stdin is not None
                assert child.stdout is not None
                child.stdin.write(json.dumps(self._request).encode() + b"\n")
                while self._state == "running" and (line := await child.stdout.readline()):
                    if self._state == "running":  # it may have been stopped meanwhile
                        self._take(json.loads(line))
                child.stdin.close()  # its end
            except (OSError, ValueError) as error:  # it could not be started; a line is no answer
                self._end("failed", f"The check by solids could not be followed: {error}")
            if self._child is not None:
                if self._state != "running":
                    self._kill()
                status = await self._child.wait()
            if self._state == "running":
                complaints.seek(0)
                why = last_line(complaints.read())
                self._end("failed", f"The check by solids ended by itself (status {status}: {why})")

    def _take(self, answer: Plain) -> None:
        """Take what the process told."""
        event, told = answer.get("event"), answer.get("data", {})
        if event == "links":
            self._links = {name: {"state": "waiting", "seconds": 0.0, "model": 0} for name in told["names"]}
            self._sentence = "Joint forces are being solved ..."
        elif event == "link":
            link, now = self._links[name := told["name"]], time.monotonic()
            state = told.get("state", link["state"])
            if state != "solving" and link["state"] == "solving":
                link["seconds"] = now - self._since[name]
            self._since[name], link["state"] = now, state
            if all(one["state"] in ("done", "kept") for one in self._links.values()):
                self._sentence = "The linkage as a whole is being judged ..."
            if "model" in told:
                self.models[name] = told["model"]
                link["model"] = now
        elif event == "verdict":
            if not self._silent:
                self._told("verdict", {"revision": self._revision, **told})
        elif event == "sentence":
            self._sentence = told["sentence"]
        elif event in ("failed", "notice"):  # a notice is of a mistake of alula's own
            self._end("failed", told["sentence"])
            return
        else:  # the stage is done
            self._end("done", "All links are checked.")
            return
        self._tell()


def _check(text: str, name: str, tell: Tell, threads: int, memory: str | None) -> None:
    """Check a text, in the process: tell links, models and the verdict."""
    from alula.fea.check.run import WatchedLink, check_case, effort_of
    from alula.fea.outcomes.result import LinkResult, SolidResult
    from alula.geometry.keeping.kept import keeping
    from alula.reports.turnable.link import link_model
    from alula.reports.words.limits import limited
    from alula.reports.workbench.live.answers import case_of
    from alula.reports.workbench.live.verdicts import verdict_of

    lock, begun = threading.Lock(), time.perf_counter()
    shown: dict[str, str] = {}

    def told(event: str, data: Plain) -> None:
        with lock:  # links are solved side by side
            tell(event, data)

    def model(link: str, results: Mapping[str, LinkResult]) -> Plain:
        """Return the model of a link under the load case that governs it, unless it was told."""
        governing = min(results, key=lambda load_case: results[load_case].severity)
        result = results[governing]
        if shown.get(link) == governing or not isinstance(result, SolidResult):
            return {}
        shown[link] = governing
        return {"model": json.dumps(link_model(link, result, case.links[link].points))}

    def watch(one: WatchedLink) -> None:
        if not one.results:
            shown.pop(one.link, None)
            told("link", {"name": one.link, "state": "solving"})
        else:
            state = "kept" if one.kept else "done"
            told("link", {"name": one.link, "state": state, **model(one.link, one.results)})

    def say(sentence: str) -> None:
        told("sentence", {"sentence": sentence})

    try:
        case = case_of(text, name)
        told("links", {"names": list(case.checked_links)})
        with limited(threads, memory), keeping():
            result = check_case(
                case, name=name, fidelity="solid", threads=threads, effort=effort_of(case), watch=watch, progress=say
            )
        for link in shown.copy():  # other causes may make another load case govern
            later = model(link, {x: one.links[link] for x, one in result.load_cases.items()})
            if later:
                told("link", {"name": link, **later})
        told("verdict", verdict_of(result, "solids", begun))
    except AlulaError as error:
        told("failed", {"sentence": str(error)})


STAGES: Mapping[str, Callable[..., None]] = {ROLE: _check}
"""What the process may be asked."""
