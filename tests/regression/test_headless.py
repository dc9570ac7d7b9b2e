"""Without display, without EGL, without OSMesa: no stress plots, one warning, the same verdict."""

import sys
from pathlib import Path

import numpy as np
import pytest

from alula.geometry.base.child_server import ServerPool
from alula.reports.figures import figures

FAR = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def scene() -> figures.Scene:
    view = figures.View(
        right=FAR[1], up=FAR[2], toward=FAR[3], focus=FAR[0], half_width=1.0, half_height=1.0, size=(50, 50), cut=None
    )
    return figures.Scene(
        points=FAR, displacement=0.0 * FAR, values=np.arange(4.0), measure="stress", triangles=FACES,
        cells=np.array([[0, 1, 2, 3]]),
        hottest=3, top=3.0, doubt="", scale=1.0, far_side=False, strip=view, close=view,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", "rendering crashed (signal 11)"),
        ("raise ImportError('libEGL.so.1: cannot open shared object file')", "rendering failed (ImportError: libEGL"),
        ("import sys; sys.exit(0)", ""),
    ],
)  # fmt: skip
def test_a_graphics_library_that_is_missing_or_crashes(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, broken: str, told: str
) -> None:
    """The worker is the real one; the library that it imports is not."""
    (tmp_path / "pyvista.py").write_text(broken)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    pictures, warnings = figures.plots_of({"AE": scene(), "GF": scene()}, {"AE": {}, "GF": {}})
    assert pictures == {}
    [warning] = warnings
    assert warning.startswith(f"no stress plot of AE, GF: {told}")


def test_without_pyvista(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figures, "find_spec", lambda name: None)
    monkeypatch.setattr(figures, "_ask", None)
    figures.start_renderer()
    told = f"no stress plot of AE: pyvista is not installed; run {sys.executable} -m pip install 'alula[pictures]'"
    assert figures.plots_of({"AE": scene()}, {"AE": {}}) == ({}, (told,))


def test_without_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR"):
        monkeypatch.delenv(name, raising=False)
    pictures, warnings = figures.plots_of({"AE": scene()}, {"AE": {}})
    assert warnings == ()
    assert pictures["AE"].png().startswith(b"\x89PNG")


def test_a_renderer_that_was_started_early_draws_without_temporary_files(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "none"))  # the child's
    pool = ServerPool()
    monkeypatch.setattr(figures, "_POOL", pool)
    for _ in range(2):
        figures.start_renderer()
    [early] = pool._waiting
    pictures, warnings = figures.plots_of({"AE": scene()}, {"AE": {}})
    assert warnings == ()
    assert pictures["AE"].png().startswith(b"\x89PNG")
    assert pool._waiting == [early]
    pool.close()
