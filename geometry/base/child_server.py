"""A child process that answers one request after another, so that what it has made once serves later requests.

Requests and answers are bytes, each behind its length, on the child's standard input and output: an answer is whole or
none. A server takes a place (``alula.geometry.base.child.at_most``) only while it works on a request. Between requests
it waits in a pool, for ``IDLE`` seconds or until this process ends.
"""

import atexit
import os
import queue
import struct
import subprocess
import threading
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import IO

from alula.geometry.base import child

_LENGTH = struct.Struct("<Q")
IDLE = 60.0
"""Seconds after which a server that nobody asks is ended: it holds some hundred megabytes."""


@dataclass
class ChildEndedError(Exception):
    """A server ended without an answer.

    Attributes
    ----------
    status : int
        Exit status, or minus the number of the signal that ended it.
    told : str
        Last line of its standard error.
    """

    status: int
    told: str


class ChildServer:
    """The parent's side. It asks from one thread at a time; after any exception the child is gone.

    Parameters
    ----------
    command : list of str
        Program and arguments.
    environment : dict of str to str
        Its environment variables.

    Raises
    ------
    OSError
        If it cannot be started.
    CannotRunError
        After ``stop_all``.
    """

    def __init__(self, command: list[str], environment: dict[str, str]) -> None:
        pipe = subprocess.PIPE
        self._process = child.start(command, env=environment, stdin=pipe, stdout=pipe, stderr=pipe)
        self._told = b""
        self._listener = threading.Thread(target=self._listen, daemon=True)  # a full pipe would block the child
        self._listener.start()

    def _listen(self) -> None:
        assert self._process.stderr is not None
        with suppress(OSError, ValueError):
            while told := self._process.stderr.read(1 << 16):
                self._told = (self._told + told)[-4096:]

    @property
    def alive(self) -> bool:
        """False once it has ended."""
        return self._process.poll() is None

    def ask(self, request: bytes, time_limit: float) -> bytes:
        """Return the answer to a request.

        Parameters
        ----------
        request : bytes
            What the child's function takes.
        time_limit : float
            Time after which the child is killed [s].

        Returns
        -------
        bytes
            What that function returns.

        Raises
        ------
        subprocess.TimeoutExpired
            At the time limit.
        ChildEndedError
            Where the child has ended, or ends without a whole answer.
        """
        late = threading.Event()

        def stop() -> None:
            late.set()
            self._process.kill()

        assert self._process.stdin is not None
        assert self._process.stdout is not None
        timer = threading.Timer(time_limit, stop)
        timer.daemon = True
        timer.start()
        try:
            with suppress(OSError):  # it has ended, and the missing answer tells
                _send(self._process.stdin, request)
            answer = _receive(self._process.stdout)
        except BaseException:
            self.end()
            raise
        finally:
            timer.cancel()
        if answer is not None:
            return answer
        if late.is_set():
            self.end()
            raise subprocess.TimeoutExpired(self._process.args, time_limit)
        raise ChildEndedError(*self.end(killed=False))

    def end(self, *, killed: bool = True) -> tuple[int, str]:
        """End the child.

        Parameters
        ----------
        killed : bool
            False for one that ends by itself.

        Returns
        -------
        status : int
            Exit status, or minus the number of the signal that ended it.
        told : str
            Last line of its standard error.
        """
        if killed:
            self._process.kill()
        self._process.wait()
        self._listener.join()
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            assert pipe is not None
            with suppress(OSError):  # what a child that has ended did not read
                pipe.close()
        child.forget(self._process)
        return self._process.returncode, child.last_line(self._told)


class ServerPool:
    """Servers that wait for further requests, each for those with the command and environment that started it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: list[_Waiting] = []
        self._announced: list[tuple[int, list[str], dict[str, str]]] = []
        atexit.register(self.close)

    @contextmanager
    def server(self, command: list[str], environment: dict[str, str], topic: Hashable) -> Iterator[ChildServer]:
        """Lend a server, a new one where none waits; it is ended after an exception.

        Parameters
        ----------
        command : list of str
            Program and arguments.
        environment : dict of str to str
            Its environment variables.
        topic : hashable
            What the request is about: a server that was asked about it before comes first.

        Yields
        ------
        ChildServer
            The server. One that has been ended does not come back.

        Raises
        ------
        OSError
            If it cannot be started.
        CannotRunError
            After ``stop_all``.
        """
        with child.place():
            started_with = os.getpid(), command, environment
            found = self._take(started_with, topic)
            server, topics = (found.server, found.topics) if found else (ChildServer(command, environment), set())
            try:
                yield server
            except BaseException:
                server.end()
                raise
            if server.alive:
                self._put(_Waiting(server, started_with, topics | {topic}))

    def start(self, command: list[str], environment: dict[str, str]) -> None:
        """Start a server that will be asked soon, the first time that it is announced.

        Parameters
        ----------
        command : list of str
            Program and arguments.
        environment : dict of str to str
            Its environment variables.

        Raises
        ------
        OSError
            If it cannot be started.
        CannotRunError
            After ``stop_all``.
        """
        started_with = os.getpid(), command, environment
        with self._lock:
            if started_with in self._announced:
                return
            self._announced.append(started_with)
        self._put(_Waiting(ChildServer(command, environment), started_with, set()))

    def _take(self, started_with: object, topic: Hashable) -> "_Waiting | None":
        with self._lock:
            alive = [w for w in self._waiting if w.started_with == started_with and w.server.alive]
            found = next((w for w in alive if topic in w.topics), alive[-1] if alive else None)
            if found is not None:
                self._waiting.remove(found)
                found.timer.cancel()
        return found

    def _put(self, waiting: "_Waiting") -> None:
        waiting.timer = threading.Timer(IDLE, self._end, [waiting])
        waiting.timer.daemon = True
        with self._lock:
            self._waiting.append(waiting)
        waiting.timer.start()

    def _end(self, waiting: "_Waiting") -> None:
        with self._lock:
            if waiting not in self._waiting:
                return
            self._waiting.remove(waiting)
        waiting.server.end()

    def close(self) -> None:
        """End the servers that wait."""
        for waiting in tuple(self._waiting):
            waiting.timer.cancel()
            if waiting.started_with[0] == os.getpid():
                self._end(waiting)


@dataclass(eq=False)
class _Waiting:
    """A server that waits, what it was started with (by which process, command, environment), and its topics."""

    server: ChildServer
    started_with: tuple[int, list[str], dict[str, str]]
    topics: set[Hashable]
    timer: threading.Timer = field(init=False)


class ChildService:
    """The child's side: takes requests from standard input, and alone writes to standard output.

    What libraries print there is discarded.
    """

    def __init__(self) -> None:
        self._requests: queue.Queue[bytes] = queue.Queue()
        self._in, self._out = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.close(nowhere)
        self._lock, self._due = threading.Lock(), False

    def run(self, answer: Callable[[bytes], None]) -> None:
        """Answer requests until the parent ends, and this process with it.

        Parameters
        ----------
        answer : callable
            Takes a request, and gives its answer to ``reply``.
        """
        threading.Thread(target=self._read, daemon=True).start()
        while True:
            request = self._requests.get()
            self._due = True
            answer(request)

    def _read(self) -> None:
        while (request := _receive(self._in)) is not None:
            self._requests.put(request)
        os._exit(1)

    def reply(self, answer: bytes) -> bool:
        """Answer the present request, unless that has been done.

        Parameters
        ----------
        answer : bytes
            The answer.

        Returns
        -------
        bool
            False where no request waits for an answer.
        """
        with self._lock:
            if not self._due:
                return False
            self._due = False
            _send(self._out, answer)
            return True


def _send(stream: IO[bytes], told: bytes) -> None:
    stream.write(_LENGTH.pack(len(told)) + told)
    stream.flush()


def _receive(stream: IO[bytes]) -> bytes | None:
    """Return what was sent, or None where the stream ends before."""
    head = _exactly(stream, _LENGTH.size)
    return None if head is None else _exactly(stream, *_LENGTH.unpack(head))


def _exactly(stream: IO[bytes], count: int) -> bytes | None:
    parts: list[bytes] = []
    while count:
        part = stream.read(min(count, 1 << 24))
        if not part:
            return None
        parts.append(part)
        count -= len(part)
    return b"".join(parts)
