"""What is missing is found by loading it, and the advice is one command."""

import ctypes
import shutil

import pytest

from alula.geometry.base import system_libraries


def without(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    """Let the loader find every library but those of `names`."""

    def load(library: str) -> None:
        if library in names:
            raise OSError(f"{library}: cannot open shared object file: No such file or directory")

    monkeypatch.setattr(ctypes, "CDLL", load)
    monkeypatch.setattr("sys.platform", "linux")


def test_nothing_is_missing_where_all_load(monkeypatch):
    without(monkeypatch)
    assert system_libraries.missing_packages() == []


def test_a_missing_library_names_its_package(monkeypatch):
    without(monkeypatch, "libGLU.so.1", "libgomp.so.1")
    assert system_libraries.missing_packages() == ["libglu1-mesa", "libgomp1"]


@pytest.mark.parametrize(
    ("missing", "packages"),
    [
        (["libEGL.so.1"], []),
        (["libOSMesa.so.8"], []),
        (["libEGL.so.1", "libOSMesa.so.8"], ["libegl1"]),
    ],
)
def test_one_renderer_is_enough(monkeypatch, missing, packages):
    without(monkeypatch, *missing)
    assert system_libraries.missing_packages() == packages


def test_other_systems_need_nothing(monkeypatch):
    without(monkeypatch, "libGLU.so.1")
    monkeypatch.setattr("sys.platform", "darwin")
    assert system_libraries.missing_packages() == []


def test_a_library_that_does_not_exist_does_not_load():
    assert not system_libraries.loads("libalula-does-not-exist.so.1")


@pytest.mark.parametrize(("sudo", "start"), [("/usr/bin/sudo", "sudo sh -c '"), (None, "su -c '")])
def test_the_advice_is_one_command(monkeypatch, sudo, start):
    without(monkeypatch, "libGLU.so.1")
    monkeypatch.setattr(shutil, "which", lambda _: sudo)
    advice = system_libraries.advice()
    assert advice.startswith(f"install the system libraries with: {start}apt-get update && apt-get install ")
    assert advice.endswith(" libglu1-mesa'")


def test_the_advice_names_all_packages_when_none_is_found_missing(monkeypatch):
    without(monkeypatch)
    advice = system_libraries.advice()
    assert "libglu1-mesa" in advice
    assert "libgomp1" in advice
    assert "libegl1" in advice


@pytest.mark.parametrize(
    ("arguments", "expected"), [([], "libglu1-mesa\n"), (["--advice"], "su -c 'apt-get update && apt-get install")]
)
def test_the_set_up_reads_packages_or_advice(monkeypatch, capsys, arguments, expected):
    without(monkeypatch, "libGLU.so.1")
    monkeypatch.setattr(shutil, "which", lambda _: None)
    monkeypatch.setattr("sys.argv", ["system_libraries", *arguments])
    system_libraries.main()
    assert capsys.readouterr().out.startswith(expected)
