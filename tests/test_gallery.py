"""The scripts of the gallery run, and what they assert holds."""

import runpy

import pytest
from programs import ROOT

from docs.extensions.gallery import SLOW

FOLDER = ROOT / "docs" / "gallery"
WANTED = {
    "owl_wing", "owl_wing_braking", "flapping_wing", "ornithopter", "synthesis_to_stress", "polycentric_knee", "finger",
    "pylon", "slider_crank_friction", "spring_in_layers", "step_part", "tolerances", "study", "printed_part", "compose",
}  # fmt: skip
SCRIPTS = {file.stem: file.read_text(encoding="utf-8") for file in sorted(FOLDER.glob("*.py"))}


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.converged] if SLOW.search(text) else []) for name, text in SCRIPTS.items()],
)
def test_a_script_runs_and_its_assertions_hold(name: str) -> None:
    """In this process: the scripts share the modules that are imported, and change nothing of them."""
    runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")


def test_the_gallery_has_what_it_promises() -> None:
    assert SCRIPTS.keys() >= WANTED
    for name, text in SCRIPTS.items():
        assert "\nassert " in text or "\n    assert " in text, name
        assert ".plot_" in text or "pictures" in text, name
        assert len(text.splitlines()) <= 90, name
