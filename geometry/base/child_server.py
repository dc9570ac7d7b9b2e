"""A child process that answers one request after another, so that what it has made once serves later requests.

Requests and answers are bytes, on the child's standard input and output. Each is pickled, which tells its end: it is
whole or none. A server takes a place (``alula.geometry.base.child.at_most``) only while it works on a request. Between
requests it waits in a pool, for ``IDLE`` seconds or until this process ends.
"""

import atexit
import os
import pickle
import queue
import subprocess
import threading
import time
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import IO

from alula.geometry.base import child

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

    Attributes
    ----------
    started_with : tuple
        Command and environment.
    topics : set
        What it was asked about, as the pool remembers.
    idle : threading.Timer
        Ends it while it waits in the pool.

    Raises
    ------
    OSError
        If it cannot be started.
    CannotRunError
        After ``stop_all``.
    """

    idle: threading.Timer

    def __init__(self, command: list[str], environment: dict[str, str]) -> None:
        pipe = subprocess.PIPE
        self._process = process = child.start(command, env=environment, stdin=pipe, stdout=pipe, stderr=pipe)
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        self._requests, self._answers, self._errors = process.stdin, process.stdout, process.stderr
        self.started_with = command, environment
        self.topics: set[Hashable] = set()
        self._told = b""
        self._listener = threading.Thread(target=self._listen, daemon=True)  # a full pipe would block the child
        self._listener.start()

    def _listen(self) -> None:
        with suppress(OSError, ValueError):
            while told := self._errors.read(1 << 16):
                self._told = (self._told + told)[-4096:]

    @property
    def alive(self) -> bool:
        """False once it has ended, and in a process that is a fork of the one that started it."""
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
        end = time.monotonic() + time_limit
        timer = threading.Timer(time_limit, self._process.kill)
        timer.daemon = True
        timer.start()
        try:
            with suppress(OSError):  # it has ended, and the missing answer tells
                _send(self._requests, request)
            answer = _receive(self._answers)
        except BaseException:
            self.end()
            raise
        finally:
            timer.cancel()
        if answer is not None:
            return answer
        late = time.monotonic() >= end
        ended = self.end(killed=late)
        raise subprocess.TimeoutExpired(self._process.args, time_limit) if late else ChildEndedError(*ended)

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
        with suppress(OSError), self._process:  # what a child that has ended did not read
            pass
        return self._process.returncode, child.last_line(self._told)


class ServerPool:
    """Servers that wait for further requests, each for those with the command and environment that started it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: list[ChildServer] = []
        self._announced: list[tuple[list[str], dict[str, str]]] = []
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
            server = self._take((command, environment), topic) or ChildServer(command, environment)
            try:
                yield server
            except BaseException:
                server.end()
                raise
            if server.alive:
                server.topics.add(topic)
                self._put(server)

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
        started_with = command, environment
        with self._lock:
            if started_with in self._announced:
                return
            self._announced.append(started_with)
        self._put(ChildServer(command, environment))

    def _take(self, started_with: tuple[list[str], dict[str, str]], topic: Hashable) -> ChildServer | None:
        with self._lock:
            alive = [one for one in self._waiting if one.started_with == started_with and one.alive]
            found = next((one for one in alive if topic in one.topics), alive[-1] if alive else None)
            if found is not None:
                self._waiting.remove(found)
                found.idle.cancel()
        return found

    def _put(self, server: ChildServer) -> None:
        server.idle = threading.Timer(IDLE, self._end, [server])
        server.idle.daemon = True
        with self._lock:
            self._waiting.append(server)
        server.idle.start()

    def _end(self, server: ChildServer) -> None:
        with self._lock:
            if server not in self._waiting:
                return
            self._waiting.remove(server)
        server.end()

    def close(self) -> None:
        """End the servers that wait."""
        for server in tuple(self._waiting):
            server.idle.cancel()
            if server.alive:  # in a fork none is, and the pipes are held by a thread that it has not
                self._end(server)


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
    pickle.dump(told, stream)
    stream.flush()


def _receive(stream: IO[bytes]) -> bytes | None:
    """Return what was sent, or None where the stream ends before."""
    try:
        told: bytes = pickle.load(stream)
    except (EOFError, pickle.UnpicklingError):
        return None
    return told
