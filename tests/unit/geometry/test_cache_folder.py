"""The cache folder is the user's alone, and alula does without where there is none."""

import os
import sys

import pytest

from alula.geometry.keeping.cache_folder import cache_folder

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="rights of folders are those of POSIX")


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    for name in ("ALULA_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(sys, "platform", "linux")
    return tmp_path


def test_place(home, monkeypatch):
    assert cache_folder() == home / ".cache" / "alula"
    assert cache_folder("links") == home / ".cache" / "alula" / "links"
    assert (home / ".cache" / "alula" / "links").stat().st_mode & 0o777 == 0o700
    monkeypatch.setenv("XDG_CACHE_HOME", "not/absolute")
    assert cache_folder() == home / ".cache" / "alula"
    monkeypatch.setenv("XDG_CACHE_HOME", str(home / "xdg"))
    assert cache_folder() == home / "xdg" / "alula"
    monkeypatch.setenv("ALULA_CACHE", str(home / "own"))
    assert cache_folder() == home / "own"
    monkeypatch.setenv("ALULA_CACHE", "")
    assert cache_folder() is None
    monkeypatch.delenv("ALULA_CACHE")
    monkeypatch.setattr(sys, "platform", "darwin")
    assert cache_folder() == home / "Library" / "Caches" / "alula"


@pytest.mark.parametrize("inner", [False, True])
@pytest.mark.parametrize("mode", [0o770, 0o707])
def test_a_folder_that_others_may_write_is_refused(home, mode, inner):
    folder = cache_folder("links")
    (folder if inner else folder.parent).chmod(mode)
    assert cache_folder("links") is None


def test_a_folder_of_another_user_is_refused(home, monkeypatch):
    assert cache_folder() is not None
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert cache_folder() is None


def test_no_place_for_it(home, monkeypatch):
    (home / ".cache").write_text("a file")
    assert cache_folder() is None
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("HOME")
    monkeypatch.setattr("pathlib.Path.home", lambda: (_ for _ in ()).throw(RuntimeError("no home")))
    assert cache_folder() is None
