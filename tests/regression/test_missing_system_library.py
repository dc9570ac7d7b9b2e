"""On a bare system `import gmsh` raises OSError, since its wheel lacks libGLU and others: that was a traceback."""

from pathlib import Path

import pytest

from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.system_libraries import advice
from alula.geometry.meshing.mesh import COARSE, mesh_body
from alula.geometry.parts.part import Body, Pin, Tube

FAULT = "libGLU.so.1: cannot open shared object file: No such file or directory"


@pytest.fixture
def body() -> Body:
    part = Tube.model_validate(
        {
            "shape": "tube",
            "material": "any",
            "outer_diameter": "5 mm",
            "inner_diameter": "2.5 mm",
            "eye_diameter": "7 mm",
            "eye_thickness": "8 mm",
            "fillet_radius": "1 mm",
        }
    )
    pins = (Pin(name="A", x=0.0, y=0.0, diameter=1.5), Pin(name="B", x=40.0, y=0.0, diameter=1.5))
    return Body(part=part, pins=pins, ends=(), holes=())


def gmsh_that(does: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Put a module of that name before the real one, for child processes."""
    (folder / "gmsh.py").write_text(does, encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(folder))


def test_a_library_that_gmsh_lacks_ends_in_the_one_command(body, tmp_path, monkeypatch):
    gmsh_that(f"raise OSError({FAULT!r})", tmp_path, monkeypatch)
    with pytest.raises(CannotRunError) as caught:
        mesh_body(body)
    sentence = str(caught.value)
    assert sentence == f"gmsh could not be loaded ({FAULT}); {advice()}"
    assert "apt-get install" in sentence
    assert "libglu1-mesa" in sentence
    assert caught.value.exit_status == 4


def test_where_the_libraries_load_the_body_is_built(body):
    assert mesh_body(body, COARSE).volume > 0.0


def test_a_fault_of_gmsh_itself_does_not_blame_the_libraries(body, tmp_path, monkeypatch):
    gmsh_that("def initialize(**_): raise OSError('disk full')", tmp_path, monkeypatch)
    with pytest.raises(CannotRunError) as caught:
        mesh_body(body)
    assert "disk full" in str(caught.value)
    assert "apt-get" not in str(caught.value)
