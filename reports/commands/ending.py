"""The end of the program: an exit status and at most one sentence on standard error."""

import codecs
import contextlib
import errno
import io
import logging
import os
import sys
import threading
import time
from collections.abc import Callable, Collection
from typing import NoReturn

from alula.geometry.base.errors import AlulaError, CaseError

INTERRUPTED = 130
CRASHED = 4
PIPE_CLOSED = 141
"""As in a shell: 128 and the number of SIGPIPE."""
GRACE = 1.0
"""Seconds from a signal to the end of a process whose threads do not come back, such as from a factorisation."""
_FULL = (errno.ENOSPC, errno.EDQUOT)

_told = threading.Event()


def run(app: Callable[[], object]) -> NoReturn:
    """Run the command line to its end.

    Parameters
    ----------
    app : callable
        The command line.
    """
    end_cleanly_on_signals()
    make_writable()
    place_for_matplotlib()
    try:
        try:
            status = app()
            sys.exit(status if isinstance(status, int) else 0)  # what else a command returns is no status
        except SystemExit as stop:
            if _pipe_was_closed(stop):
                raise BrokenPipeError from None
            end_if_stopped()
            sys.stdout.flush()  # here, where a full disk can still be explained
            raise
        except BaseException:
            with contextlib.suppress(OSError):
                sys.stdout.flush()
            raise
    except AlulaError as error:
        _stop(str(error), error.exit_status)
    except KeyboardInterrupt:
        _stop("interrupted", INTERRUPTED)
    except MemoryError:
        _stop("memory ran out; use a coarser mesh (solid.mesh_size) or fewer links", CRASHED)
    except BrokenPipeError:
        _abandon_output()
        sys.exit(PIPE_CLOSED)
    except OSError as error:
        _abandon_output()
        missing = "the current folder" if isinstance(error, FileNotFoundError) else "standard output"
        where = f"'{error.filename}'" if error.filename else missing
        remedy = "free space on the disk or choose another place" if error.errno in _FULL else "choose another place"
        if isinstance(error, PermissionError):
            remedy = "check its permissions or choose another place"
        _stop(f"{where} failed ({error.strerror or error}); {remedy}", CRASHED)
    except UnicodeEncodeError as error:
        if os.environ.get("ALULA_TRACEBACK"):
            raise
        _stop(
            f"a name with {error.object[error.start : error.end]!a} cannot be a file name in this locale, whose "
            f"encoding is {error.encoding}; set LC_ALL=C.UTF-8",
            CRASHED,
        )
    except Exception as error:
        if (mistake := _usage(error)) is not None:
            _stop(mistake, CaseError.exit_status)
        if os.environ.get("ALULA_TRACEBACK"):
            raise
        _stop(
            f"internal error of alula, not of the case: {type(error).__name__}: {error}; "
            "set ALULA_TRACEBACK=1 to see where, and please report it",
            CRASHED,
        )


def _usage(error: Exception) -> str | None:
    """Return what typer says of a mistake on the command line, as a sentence; None for any other error."""
    import typer

    usage = typer.BadParameter.__mro__[1]  # UsageError, which typer does not export
    if not isinstance(error, usage):
        return None
    if type(error).__name__ == "NoArgsIsHelpError":  # a command alone: its help, as it stands
        error.show()  # type: ignore[attr-defined]
        sys.exit(CaseError.exit_status)
    from pydantic import BaseModel, ValidationError

    message, context = error.format_message().strip().rstrip("."), getattr(error, "ctx", None)  # type: ignore[attr-defined]
    if message.endswith("is not readable"):
        message += "; check its permissions"
    cause = error.__cause__
    if isinstance(cause, ValidationError):
        from alula.loads.text.explain import sentence

        message = sentence(cause, BaseModel, error.param.opts[-1])  # type: ignore[attr-defined]
    after = " See" if message.endswith("?") else "; see"
    see = "" if context is None else f"{after} {context.command_path} --help"
    return f"{message[:1].lower()}{message[1:]}{see}"


def make_writable() -> None:
    """Let text be written whatever the streams are: closed ones take it and lose it, poor encodings escape it.

    The escapes are those of JSON, so that a record stays one. A stated size of the terminal that is none is left out.
    """

    def escaped(error: UnicodeError) -> tuple[str, int]:
        if not isinstance(error, UnicodeEncodeError):
            raise error
        units = error.object[error.start : error.end].encode("utf-16-be", "surrogatepass").hex()
        return "".join(f"\\u{units[i : i + 4]}" for i in range(0, len(units), 4)), error.end

    for name in ("COLUMNS", "LINES"):  # a width of zero would print nothing
        stated = os.environ.get(name, "")
        if not (stated.isascii() and stated.isdigit() and len(stated) < 10 and int(stated)):
            os.environ.pop(name, None)
    codecs.register_error("alula", escaped)
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115
        elif isinstance(stream, io.TextIOWrapper) and stream.encoding.lower().replace("-", "") != "utf8":
            stream.reconfigure(errors="alula")
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # of a MPLCONFIGDIR that cannot be written


def place_for_matplotlib() -> None:
    """Give matplotlib one folder for its caches where HOME cannot be written, which goes with this process.

    By itself it makes one in every process, and those of children that are killed stay.
    """
    homes = {"XDG_CONFIG_HOME": "~/.config", "XDG_CACHE_HOME": "~/.cache"}
    places = [os.path.expanduser(os.environ.get(name) or usual) for name, usual in homes.items()]
    if os.environ.get("MPLCONFIGDIR") or all(map(_can_be_written, places)):
        return
    import atexit
    import shutil
    import tempfile

    from alula.geometry.base.tidying import owed

    with contextlib.suppress(OSError):
        made = os.environ["MPLCONFIGDIR"] = tempfile.mkdtemp(prefix="alula-")
        atexit.register(owed(lambda: shutil.rmtree(made, ignore_errors=True)))


def _can_be_written(folder: str) -> bool:
    """Say whether a folder takes a new one, or can be made."""
    while not os.path.lexists(folder) and os.path.dirname(folder) != folder:
        folder = os.path.dirname(folder)
    return os.path.isdir(folder) and os.access(folder, os.W_OK)


def end_cleanly_on_signals() -> None:
    """Let a signal to end do what Ctrl-C does: stop the children, remove half-written folders, end with 130.

    Blocks that the interruption leaves do so. Where one does not come to its end in time, it is done without them.
    """
    import signal

    def end(number: int, frame: object) -> None:
        for other in ending:
            signal.signal(other, signal.SIG_IGN)  # a second one would cut the cleaning short
        from alula.geometry.base.child import stop_all

        stop_all()
        raise KeyboardInterrupt

    told = sys.unraisablehook

    def tell(unraisable: "sys.UnraisableHookArgs") -> None:
        """Stay silent on the interruption that a callback swallowed; ``end_if_stopped`` makes up for it."""
        from alula.geometry.base.child import stopped

        if not (stopped() and isinstance(unraisable.exc_value, KeyboardInterrupt)):
            told(unraisable)

    sys.unraisablehook = tell
    names = ("SIGINT", "SIGTERM", "SIGHUP")
    found = [getattr(signal, name) for name in names if hasattr(signal, name)]
    # One that is ignored stays so: nohup says that the end of the terminal is to be survived.
    ending = [number for number in found if signal.getsignal(number) is not signal.SIG_IGN]
    for number in ending:
        signal.signal(number, end)
    _end_at_the_latest(ending)


def _end_at_the_latest(ending: Collection[int]) -> None:
    """End the process ``GRACE`` after a signal even if no thread of it comes back from native code.

    Python runs the handler of a signal in the main thread, when that comes back. The system's own handler tells the
    number of the signal to a socket at once, and a thread waits there.
    """
    import signal
    import socket

    ours, theirs = socket.socketpair()
    theirs.setblocking(False)
    signal.set_wakeup_fd(theirs.detach(), warn_on_full_buffer=False)

    def wait() -> None:
        while ours.recv(1)[0] not in ending:
            pass
        time.sleep(GRACE)
        from alula.geometry.base.child import stop_all
        from alula.geometry.base.tidying import tidy_all

        stop_all()
        tidy_all()
        if not _told.is_set():
            _tell_now("interrupted")
        os._exit(INTERRUPTED)

    threading.Thread(target=wait, daemon=True).start()


def _tell_now(sentence: str) -> None:
    """Write to standard error past Python's own stream, which another thread may hold, if that does not block."""
    import select

    with contextlib.suppress(OSError, ValueError):
        if select.select([], [2], [], 0.0)[1]:
            os.write(2, f"alula: {sentence}\n".encode())


def progress(message: str) -> None:
    """Tell what is begun on standard error, and end the program first if it was told to stop.

    Parameters
    ----------
    message : str
    """
    end_if_stopped()
    print(message, file=sys.stderr, flush=True)


def end_if_stopped() -> None:
    """End where a signal was to end the process but a library swallowed it."""
    from alula.geometry.base.child import stopped

    if stopped():
        raise KeyboardInterrupt


def _pipe_was_closed(stop: SystemExit) -> bool:
    """Return True if typer took a closed pipe for the end, with the status that means a failed check."""
    cause = stop.__context__
    return isinstance(cause, OSError) and cause.errno == errno.EPIPE


def _abandon_output() -> None:
    """Keep the interpreter from trying once more to write what could not be written."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _stop(sentence: str, status: int) -> NoReturn:
    _told.set()
    print(f"alula: {' '.join(sentence.split())}", file=sys.stderr)
    sys.exit(status)
