"""A run that is killed at any moment leaves no half of a result, no child and nothing that the next run minds."""

import os
import signal
import subprocess
import sys
import time
from importlib.resources import files
from pathlib import Path

import programs
import pytest

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals are POSIX")

# Ends itself with the n-th request to the file system, for n = 1, 2, ... to the end; then the next run is ended too,
# while it takes back what the first began. The user's own files lie in the folder and beside the pictures.
AT_EVERY_STEP = """
import json, shutil, signal
os.fsync = lambda descriptor: None  # what a killed process has written stays; only the end of the power could lose it
sys.path.insert(0, TESTS)
import programs
target = Path(sys.argv[1]) / "out"
with_earlier = sys.argv[2] == "earlier"
mine = [target / "my.toml", target / "pictures" / "notes.txt"] if with_earlier else []
seen = {"old": 0, "new": 0, "none": 0}

def killed(step, task):
    child = os.fork()
    if child == 0:
        left = step
        def hook(event, arguments):
            nonlocal left
            if event == "open" or event.startswith(("os.", "shutil.", "fcntl.", "tempfile.")):
                left -= 1
                if left == 0:
                    os.kill(os.getpid(), signal.SIGKILL)
        sys.addaudithook(hook)
        task()
        os._exit(0)
    return os.WIFSIGNALED(os.waitpid(child, 0)[1])

step = 0
while True:
    step += 1
    shutil.rmtree(target, ignore_errors=True)
    if with_earlier:
        write_folder(target, fill("old"))
        for path in mine:
            path.write_text("mine")
    ended = not killed(step, lambda: write_folder(target, fill("new")))
    found = programs.text_of(target)
    seen[found] += 1
    if ended:
        break
    assert all(path.read_text() == "mine" for path in mine)
    killed(5 + step * 7 % 80, lambda: output.refuse_unusable(target, "check"))
    if with_earlier:
        # A next run that fails changes nothing, and the earlier result is in its place again.
        def fail(folder):
            raise OSError(28, "No space left on device")
        try:
            write_folder(target, fail)
        except Exception:
            pass
        assert programs.text_of(target) in ("old", "new"), found
    write_folder(target, fill("next"))
    assert programs.text_of(target) == "next"
    assert all(path.read_text() == "mine" for path in mine)
    assert programs.hidden(target) == [], programs.hidden(target)
print(json.dumps({"steps": step, **seen}))
""".replace("TESTS", repr(str(programs.ROOT / "tests")))


@pytest.mark.parametrize("earlier", ["earlier", "fresh"])
def test_killed_at_every_step_of_writing(tmp_path: Path, earlier: str) -> None:
    import json

    done = programs.script(AT_EVERY_STEP, str(tmp_path), earlier)
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    assert seen["steps"] > 60
    assert seen["new"] >= 1
    assert seen["none"] > 15  # while files are moved there is no result.json ...
    assert seen["old"] > (50 if earlier == "earlier" else -1)  # ... and not even then is the earlier result lost


# A real report, drawn once; then written again and again, by processes that are killed after ever more operations.
A_REPORT = """
import itertools, signal
os.fsync = lambda descriptor: None
sys.path.insert(0, TESTS)
import programs
from alula.fea.check.run import check_case
from alula.loads.case.case_file import read_case
from alula.reports.check import folder
from alula.reports.check.folder import write_report
import told
result = told.found(check_case(read_case("knee"), name="starter", fidelity="beam"))
sections = folder.check_sections(result)
whole_page = folder.check_page(result, sections)
drawn = folder.check_pictures(result, whole_page)
page = folder.as_page(whole_page, drawn[0])
folder.check_sections, folder.check_page = lambda *arguments: sections, lambda *arguments: whole_page
folder.check_pictures, folder.as_page = lambda *arguments: drawn, lambda *arguments: page
target = Path(sys.argv[1])
write_report(result, target)
stamp = (target / "result.json").stat().st_mtime_ns
whole = 0
for step in itertools.count(1, 19):
    child = os.fork()
    if child == 0:
        left = step
        def hook(event, arguments):
            global left
            if event == "open" or event.startswith(("os.", "shutil.", "fcntl.", "tempfile.")):
                left -= 1
                if left == 0:
                    os.kill(os.getpid(), signal.SIGKILL)
        sys.addaudithook(hook)
        write_report(result, target)
        os._exit(0)
    killed = os.WIFSIGNALED(os.waitpid(child, 0)[1])
    if (target / "result.json").exists():
        whole += programs.is_whole(target)
    if not killed:
        break
write_report(result, target)
assert programs.is_whole(target)
assert (target / "result.json").stat().st_mtime_ns != stamp
print(step, whole)
""".replace("TESTS", repr(str(programs.ROOT / "tests")))


def test_a_report_killed_at_any_time_is_whole_or_not_there(tmp_path: Path) -> None:
    done = programs.script(A_REPORT, str(tmp_path / "out"))
    assert done.returncode == 0, done.stderr
    steps, whole = map(int, done.stdout.split())
    assert steps > 70
    assert whole > 5
    assert programs.hidden(tmp_path / "out") == []


def starter(folder: Path) -> str:
    """Write the starter case, the smallest that ships, and return its path."""
    text = files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8")
    (folder / "case.toml").write_text(text, encoding="utf-8")
    return str(folder / "case.toml")


def _children(pid: int) -> list[int]:
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            parent = int(status.read_text().rpartition(")")[2].split()[1])
        except OSError:  # it has ended meanwhile
            continue
        if parent == pid:
            found.append(int(status.parent.name))
    return found


def _meshing(process: subprocess.Popen[str]) -> list[int]:
    """Wait until a mesher is in the midst of its work, not between two tasks, and return the meshers' numbers."""
    first_seen: dict[int, float] = {}
    for _ in range(1200):
        now = time.monotonic()
        first_seen = {pid: first_seen.get(pid, now) for pid in _children(process.pid)}
        if any(now - seen > 1.5 for seen in first_seen.values()):
            return list(first_seen)
        time.sleep(0.05)
    raise AssertionError("no mesher was started")


def _all_ended(pids: list[int]) -> bool:
    deadline = time.monotonic() + 10.0
    while not all(map(programs.ended, pids)) and time.monotonic() < deadline:
        time.sleep(0.05)
    return all(map(programs.ended, pids))


FINE = ("--fidelity", "solid", "--set", "solid.mesh_size=0.2")
"""Meshes for minutes."""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGHUP])
def test_meshers_end_with_the_run(tmp_path: Path, number: signal.Signals) -> None:
    """The other signals, which take the same way, end runs in native code below."""
    if signal.getsignal(number) is signal.SIG_IGN:
        pytest.skip("the tests were started with nohup, which the command respects")
    out, scratch = tmp_path / "out", tmp_path / "scratch"
    with programs.start("check", starter(tmp_path), *FINE, "-o", str(out), scratch=scratch) as process:
        meshers = _meshing(process)
        begun = time.monotonic()
        process.send_signal(number)
        _, told = process.communicate(timeout=30)
    assert process.returncode == (-9 if number == signal.SIGKILL else 130), told
    assert time.monotonic() - begun < 15.0
    assert programs.gone(scratch)
    assert _all_ended(meshers)
    assert not out.exists()
    assert programs.hidden(tmp_path) == []
    assert "Traceback" not in told


CALCULIX = """
import signal
import sys
from pathlib import Path
from alula.fea.calculix import program as calculix
from alula.geometry.base import child
def end(number, frame):
    child.stop_all()
    raise KeyboardInterrupt
signal.signal(signal.SIGTERM, end)
scratch = Path(sys.argv[1])
(scratch / "model").mkdir()
(scratch / "deck.inp").write_text("")
calculix.run(scratch / "deck.inp", scratch / "model", threads=1, time_limit=60.0)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_calculix_ends_with_the_run(tmp_path: Path, number: signal.Signals) -> None:
    program = tmp_path / "ccx"
    program.write_text("#!/bin/sh\nexec /bin/sleep 50\n")
    program.chmod(0o755)
    command = [sys.executable, "-c", CALCULIX, str(tmp_path)]
    with subprocess.Popen(command, env=programs.environment(PATH=str(tmp_path)), stderr=subprocess.PIPE) as process:
        [solver] = _meshing(process)
        assert (tmp_path / "model" / "model.out").exists()
        process.send_signal(number)
        process.communicate(timeout=30)
    assert process.returncode != 0
    assert _all_ended([solver])


# Neither thread comes back from native code for minutes: what the interpreter would clear away has to be gone all the
# same, the child process with it.
NATIVE = """
import hashlib, signal, threading
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell lets what runs in the background ignore it
from concurrent.futures import ThreadPoolExecutor
import alula.reports.commands.ending as ending
from alula.geometry.base import child
from alula.geometry.base.tidying import scratch_folder
def native():
    sleeper = child.start([sys.executable, "-c", "import time; time.sleep(100)"])
    print(sleeper.pid, flush=True)
    hashlib.pbkdf2_hmac("sha256", b"", b"", 10**9)
def fill_and_stay(folder):
    fill("half")(folder)
    if sys.argv[2] == "main":
        native()
    with ThreadPoolExecutor(1) as pool:
        pool.submit(native).result()
def app():
    with scratch_folder("alula-"):
        write_folder(Path(sys.argv[1]), fill_and_stay)
ending.run(app)
"""


@pytest.mark.parametrize(("number", "thread"), [(signal.SIGTERM, "main"), (signal.SIGINT, "pool")])
def test_a_run_in_native_code_ends_within_two_seconds(tmp_path: Path, number: signal.Signals, thread: str) -> None:
    """A factorisation went on for four minutes after SIGTERM, since handlers run between Python's own steps alone."""
    out, scratch = tmp_path / "new" / "out", tmp_path / "scratch"
    scratch.mkdir()
    command = [sys.executable, "-c", programs.WRITING + NATIVE, str(out), thread]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, env=programs.environment(scratch), stdout=pipe, stderr=pipe, text=True
    ) as process:  # fmt: skip
        try:
            assert process.stdout is not None
            sleeper = int(process.stdout.readline())
            time.sleep(0.2)
            begun = time.monotonic()
            process.send_signal(number)
            _, told = process.communicate(timeout=20)
            took = time.monotonic() - begun
        finally:
            process.kill()
    assert process.returncode == 130
    assert took < 2.0 + 2.0  # on a busy machine
    assert told == "alula: interrupted\n"
    assert _all_ended([sleeper])
    assert list(scratch.iterdir()) == []
    assert not out.parent.exists()


def test_interrupted_while_it_writes(tmp_path: Path) -> None:
    """The folder that was being filled is removed, and the exit status is neither a pass nor a failed check."""
    out, scratch = tmp_path / "out", tmp_path / "scratch"
    with programs.start(*programs.BEAM, "-o", str(out), scratch=scratch) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith("Drawing"):
                break
        time.sleep(0.2)
        process.terminate()
        _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in told
    assert not out.exists()
    assert programs.hidden(tmp_path) == []


def test_an_interruption_that_a_library_swallows_still_ends_the_run(tmp_path: Path) -> None:
    """Exceptions in callbacks and destructors are ignored; the earlier result must not be replaced all the same."""
    text = (
        "import signal, alula.reports.commands.ending\n"
        "alula.reports.commands.ending.end_cleanly_on_signals()\n"
        "def swallowing(folder):\n"
        "    fill('new')(folder)\n"
        "    try:\n"
        "        signal.raise_signal(signal.SIGTERM)\n"
        "    except KeyboardInterrupt:\n"
        "        pass\n"
        "write_folder(Path(sys.argv[1]), fill('old'))\n"
        "write_folder(Path(sys.argv[1]), swallowing)\n"
    )
    done = programs.script(text, str(tmp_path / "out"))
    assert done.stderr.strip().endswith("KeyboardInterrupt")
    assert programs.text_of(tmp_path / "out") == "old"
    assert programs.hidden(tmp_path) == []


def test_an_interruption_in_a_destructor_prints_no_traceback(tmp_path: Path) -> None:
    """Python told of it with "Exception ignored in ..." before the one sentence; other faults there are still told."""
    text = (
        "import signal, alula.reports.commands.ending\n"
        "class Fragile:\n"
        "    def __init__(self, act): self.act = act\n"
        "    def __del__(self): self.act()\n"
        "def app():\n"
        "    Fragile(lambda: 1 // 0)\n"
        "    Fragile(lambda: signal.raise_signal(signal.SIGTERM))\n"
        "    raise SystemExit(0)\n"
        "alula.reports.commands.ending.run(app)\n"
    )
    done = programs.script(text)
    assert done.returncode == 130
    assert done.stderr.count("Exception ignored in") == 1
    assert "ZeroDivisionError" in done.stderr
    assert "KeyboardInterrupt" not in done.stderr
    assert done.stderr.strip().endswith("alula: interrupted")


def test_leftovers_of_a_living_run_stay(tmp_path: Path) -> None:
    """Another run into the same folder is at work: its half-written folder is not cleared away."""
    text = (
        "def slow(folder):\n"
        "    fill('slow')(folder)\n"
        "    print('half', flush=True)\n"
        "    sys.stdin.readline()\n"
        "write_folder(Path(sys.argv[1]), slow)\n"
    )
    out = tmp_path / "out"
    command = [sys.executable, "-c", programs.WRITING + text, str(out)]
    with subprocess.Popen(
        command, env=programs.environment(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as slow:
        assert slow.stdout is not None
        assert slow.stdout.readline() == "half\n"
        done = programs.script("write_folder(Path(sys.argv[1]), fill('quick'))", str(out))
        assert done.returncode == 0, done.stderr
        assert programs.text_of(out) == "quick"
        assert {path.name for path in out.glob(".alula-*/")} != set()
        slow.communicate("\n", timeout=60)
    assert slow.returncode == 0
    assert programs.text_of(out) == "slow"
    assert programs.hidden(tmp_path) == []


def test_a_folder_of_the_users_own_is_no_leftover(tmp_path: Path) -> None:
    own = [".alula-notes/mine.txt", ".alula/new/mine.txt", ".alula-12345678/new", ".alula-12345678/mine.txt"]
    for path in (tmp_path / "out" / name for name in own):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("mine")
    assert programs.script("write_folder(Path(sys.argv[1]), fill('a'))", str(tmp_path / "out")).returncode == 0
    assert all((tmp_path / "out" / name).read_text() == "mine" for name in own)
    assert programs.text_of(tmp_path / "out") == "a"


def test_runs_into_one_folder_at_the_same_time(tmp_path: Path) -> None:
    """Four processes write twenty results each: whenever one is there, it is whole; the last to finish stays."""
    out = tmp_path / "out"
    text = "for i in range(20): write_folder(Path(sys.argv[1]), fill(sys.argv[2] + str(i)))"
    command = [sys.executable, "-c", programs.WRITING + text, str(out)]
    running = [
        subprocess.Popen([*command, name], env=programs.environment(), stderr=subprocess.PIPE, text=True)
        for name in "abcd"
    ]
    looked = 0
    while any(process.poll() is None for process in running):
        try:
            looked += bool((out / "result.json").read_text().endswith('"}'))
        except FileNotFoundError:  # while files are moved
            continue
    for process in running:
        _, told = process.communicate()
        assert process.returncode == 0, told
    assert looked > 0
    assert programs.text_of(out)[1:] == "19"
    assert programs.hidden(tmp_path) == []
