"""What is kept of results: by content, whole or not at all, within a limit, and never in the way of a run."""

import dataclasses
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.keeping import kept as module
from alula.geometry.keeping.content import digest
from alula.geometry.keeping.kept import HEAD, KeptResults, NotKept, keeping, kept, tally
from alula.geometry.meshing.mesh_settings import MeshSettings
from alula.geometry.parts.part import Pin

CALLS = []


@kept(but=("threads",))
def doubled(values, *, note="", threads=1):
    CALLS.append(threads)
    if note == "late":
        return NotKept(2.0 * values)
    if note == "odd":
        return lambda: values
    return 2.0 * values


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ALULA_CACHE", str(tmp_path / "cache"))
    CALLS.clear()
    return tmp_path / "cache" / "solved"


VALUES = np.arange(6.0).reshape(2, 3)


def test_a_result_is_found_by_content_and_anew_where_asked(folder):
    with keeping() as store:
        first, again = doubled(VALUES), doubled(VALUES.copy(), threads=2)
        assert np.array_equal(first, 2.0 * VALUES)
        assert np.array_equal(first, again)
        assert again.flags.writeable
        assert (len(CALLS), store.found, tally()) == (1, 0, (0, 2)), "what this run found itself is not counted"
        for other in (VALUES + 1e-15, VALUES.T, VALUES.astype(np.float32), VALUES[:1]):
            doubled(other)
        doubled(VALUES, note="other")
    assert len(CALLS) == 6
    doubled(VALUES)
    with keeping(anew=True):
        doubled(VALUES)
    assert (len(CALLS), tally()) == (8, (0, 0)), "nothing is kept outside of a block, and in one that is fresh"
    with keeping():
        doubled(VALUES)
        assert (len(CALLS), tally()) == (8, (1, 1)), "a later run finds it"


def test_what_is_not_to_be_kept_or_cannot_be(folder):
    with keeping():
        for note in ("late", "late", "odd", "odd"):
            doubled(VALUES, note=note)
        for _ in range(2):
            doubled(VALUES, note=object())
    assert len(CALLS) == 6
    assert not [*folder.iterdir()], "nor is a draft left"


def test_other_code_or_libraries_find_nothing(folder, monkeypatch):
    for version in ("one", "other", "one"):
        monkeypatch.setattr(module, "surroundings", lambda version=version: version)
        with keeping():
            doubled(VALUES)
    assert len(CALLS) == 2


def test_surroundings_are_of_all_sources(tmp_path, monkeypatch):
    def told():
        module.sources_digest.cache_clear()
        module.surroundings.cache_clear()
        return module.surroundings()

    here = told()
    for package in ("geometry/keeping", "loads", "fea"):
        (tmp_path / package).mkdir(parents=True)
        (tmp_path / package / "one.py").write_text("a = 1\n")
    monkeypatch.setattr(module, "__file__", str(tmp_path / "geometry" / "keeping" / "kept.py"))
    found = [told()]
    for package in ("geometry/keeping", "loads", "fea"):
        (tmp_path / package / "one.py").write_text("a = 2\n")
        found.append(told())
    (tmp_path / "fea" / "new.toml").write_text("a = 1\n")
    found.append(told())
    monkeypatch.setattr(module.metadata, "version", lambda name: "9")
    found.append(told())
    assert len({here, *found}) == 7
    monkeypatch.undo()
    assert told() == here


@pytest.mark.parametrize("harm", ["truncated", "empty", "changed", "other head", "no pickle"])
def test_a_file_that_is_not_what_was_written_is_removed(folder, harm):
    with keeping() as store:
        doubled(VALUES)
        [path] = folder.iterdir()
        whole = path.read_bytes()
        path.write_bytes(
            {
                "truncated": whole[:-1],
                "empty": b"",
                "changed": whole.replace((2.0 * VALUES).tobytes(), (3.0 * VALUES).tobytes()),
                "other head": b"X" + whole[1:],
                "no pickle": HEAD + module.hashlib.sha256(b"?").digest() + b"?",
            }[harm]
        )
        assert store.get(path.name) is module._MISSING
        assert not path.exists()
        assert np.array_equal(doubled(VALUES), 2.0 * VALUES)
        assert path.read_bytes() == whole


def test_the_least_recently_used_goes(folder, tmp_path):
    folder.mkdir(parents=True)
    store = KeptResults(folder, limit=4500.0)
    for number, name in enumerate("abcd"):
        store.put(name, bytes(1000))
        os.utime(folder / name, (number + 1, number + 1))
    assert len(store.get("a")) == 1000, "used now"
    store.put("e", bytes(1000))
    assert sorted(path.name for path in folder.iterdir()) == ["a", "c", "d", "e"]
    store.put("large", bytes(2000))
    assert not (folder / "large").exists(), "it would drive out all else"
    (folder / ".left").write_bytes(b"of a killed process")
    (folder / ".new").write_bytes(b"of another process")
    os.utime(folder / ".left", (1, 1))
    store.put("f", b"")
    assert (folder / ".new").exists()
    assert not (folder / ".left").exists()


def test_the_limit_is_stated_with_its_unit(folder, monkeypatch):
    monkeypatch.setenv("ALULA_CACHE_SIZE", "2 MB")
    with keeping() as store:
        assert store.limit == 2e6
    monkeypatch.setenv("ALULA_CACHE_SIZE", "much")
    with pytest.raises(CaseError, match=r"ALULA_CACHE_SIZE: it is 'much'"), keeping():
        pass


@pytest.mark.parametrize("harm", ["none", "open to others", "read only", "gone"])
def test_without_a_folder_all_works_as_before(folder, monkeypatch, harm):
    if harm == "none":
        monkeypatch.setenv("ALULA_CACHE", "")
    else:
        folder.mkdir(mode=0o700, parents=True)
        folder.chmod({"open to others": 0o777, "read only": 0o500, "gone": 0o700}[harm])
        if harm == "read only" and os.geteuid() == 0:  # whom rights do not stop
            monkeypatch.setattr(module, "write_whole", lambda *_, **__: (_ for _ in ()).throw(OSError("read only")))
    with keeping() as store:
        if harm in ("none", "open to others"):
            assert store is None
        if harm == "gone":
            folder.rmdir()
        for _ in range(2):
            assert np.array_equal(doubled(VALUES), 2.0 * VALUES)
    assert len(CALLS) == 2


WRITER = """
import sys, numpy as np
from pathlib import Path
from alula.geometry.keeping.kept import KeptResults
store = KeptResults(Path(sys.argv[1]), 1e9)
print("begun", flush=True)
while True:
    for number in range(3):
        store.put(f"key{number}", np.full(200_000, float(number)))
"""


def test_two_writers_and_one_that_is_killed_leave_whole_files(folder):
    folder.mkdir(parents=True)
    command = [sys.executable, "-c", WRITER, str(folder)]
    writers = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    try:
        for writer in writers:
            assert writer.stdout.readline() == "begun\n"
        store, until, found = KeptResults(folder, 1e9), time.monotonic() + 0.5, 0
        while time.monotonic() < until or found < 10:
            for number in range(3):
                result = store.get(f"key{number}")
                if result is not module._MISSING:
                    found += 1
                    assert (result == number).all()
        assert all(path.name.startswith(".") or path.stat().st_size > 1_600_000 for path in folder.iterdir())
    finally:
        for writer in writers:
            writer.send_signal(signal.SIGKILL)
            writer.wait()
            writer.stdout.close()
    for number in range(3):
        assert (store.get(f"key{number}") == number).all()


def test_content_is_that_of_every_field_and_not_of_identity():
    settings, pin = MeshSettings(size=0.6), Pin(name="A", x=0.0, y=0.0, diameter=1.5)
    assert digest(settings) == digest(dataclasses.replace(settings))
    assert digest([1, "a", None]) == digest([1, "".join(["a"]), None])
    different = [
        settings, pin, 1, 1.0, True, "1", b"1", None, -0.0, 0.0, [], (), {}, set(), {"a": 1}, {"a": 1, "b": 2},
        {"b": 2, "a": 1}, {"a", "b"}, ["ab"], ["a", "b"], np.float64(1.0), np.array(1.0), [[1], 2], [1, [2]], Pin,
        1j, 1 + 0j,
    ]  # fmt: skip
    assert len({digest(one) for one in different}) == len(different)
    assert digest({"a", "b", "c"}) == digest({"c", "b", "a"})
    for unknown in (object(), lambda: 1, KeptResults.get, np.array([object()]), Fake()):
        with pytest.raises(TypeError):
            digest(unknown)


@dataclasses.dataclass
class Fake:
    """A record of other code, of which no sources are known."""
