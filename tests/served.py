"""A workbench that is served in this process, and what a page asks of it; no worker answers unless one is given."""

import http.client
import json
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

from alula.reports.workbench import app, session


class Quiet:
    """Stands for workers and solids: remembers what is asked, and answers nothing."""

    def __init__(self, tell: Any, folder: Path, *limits: object) -> None:
        self.tell, self.asked = tell, []

    def ask(self, *asked: Any) -> None:
        self.asked.append(asked)

    def stop(self) -> None:
        self.asked.append("stop")

    async def close(self) -> None: ...


class Workbench:
    """What a page sees of a server."""

    def __init__(self, address: str) -> None:
        self.address = address
        self.origin, self.token = address.rstrip("/").rpartition("/")[::2]
        self.port = int(self.origin.rpartition(":")[2])
        self.server: Any = None

    def ask(self, method: str, path: str, body: bytes | None = None, **headers: str) -> tuple[int, Any, bytes]:
        """Return status, headers and body of what is answered to a path below the token."""
        return self.raw(method, f"/{self.token}/{path}", body, **headers)

    def raw(self, method: str, path: str, body: bytes | None = None, **headers: str) -> tuple[int, Any, bytes]:
        """The same for a whole path."""
        line = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        try:
            line.request(method, path, body, {name.replace("_", "-"): value for name, value in headers.items()})
            answer = line.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            line.close()

    def post(self, action: str, **entries: Any) -> tuple[int, dict[str, Any]]:
        """Do as the page does."""
        data = json.dumps(entries).encode()
        status, _, found = self.ask("POST", action, data, Origin=self.origin, Content_Type="application/json")
        return status, json.loads(found)

    @contextmanager
    def events(self, patience: float = 5.0) -> Iterator["Events"]:
        """Listen as a page does; silence ends the test after a time [s]."""
        line = http.client.HTTPConnection("127.0.0.1", self.port, timeout=patience)
        line.request("GET", f"/{self.token}/events")
        try:
            yield Events(line.getresponse())
        finally:
            line.close()

    def document(self) -> dict[str, Any]:
        """Return how the document stands."""
        with self.events() as events:
            return events.next("document")


class Events:
    """A stream of server-sent events."""

    def __init__(self, answer: http.client.HTTPResponse) -> None:
        self.answer = answer

    def next(self, name: str, **entries: Any) -> dict[str, Any]:
        """Return the next event of a name with these entries."""
        event = ""
        for line in self.answer:
            text = line.decode().rstrip("\n")
            if text.startswith("event: "):
                event = text.removeprefix("event: ")
            elif text.startswith("data: ") and event == name:
                data: dict[str, Any] = json.loads(text.removeprefix("data: "))
                if all(data[key] == value for key, value in entries.items()):
                    return data
        raise AssertionError(f"the stream ended without {name} {entries}")


@contextmanager
def serving_of(case: Path | None, folder: Path, workers: Any = Quiet, period: float = 0.05) -> Iterator[Workbench]:
    """Serve a case in a thread until the end of the block; the disk is looked at every few hundredths of a second."""
    made: list[Any] = []
    listening, addresses = threading.Event(), list[str]()

    class Known(app._Server):
        def __init__(self, config: Any) -> None:
            super().__init__(config)
            made.append(self)

    def ready(address: str) -> None:
        addresses.append(address)
        listening.set()

    with (
        patch.object(app, "_Server", Known), patch.object(session, "Workers", workers),
        patch.object(session, "Solids", Quiet), patch.object(session, "PERIOD", period),
    ):  # fmt: skip
        thread = threading.Thread(target=app.serve, args=(case, folder, 0, ready), daemon=True)
        thread.start()
        assert listening.wait(30)
        bench = Workbench(addresses[0])
        bench.server = made[0]
        try:
            yield bench
        finally:
            began = time.monotonic()
            made[0].should_exit = True
            thread.join(10)
            assert not thread.is_alive()
            assert time.monotonic() - began < 1.0, "open streams and workers hold up the end"
