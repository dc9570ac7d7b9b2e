"""Pages in a browser; where Chromium or its driver is not installed these tests are skipped."""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import chromium
import numpy as np
import pytest
import solved
import wing_with_solid

from alula.fea.solid.stress import stress_field


def pytest_collection_modifyitems(items):
    """Skip what needs a browser where there is none, with a sentence that says how to get one."""
    if chromium.programs() is None:
        for item in items:
            if "browser" in getattr(item, "fixturenames", ()):
                item.add_marker(pytest.mark.skip(reason=chromium.MISSING))


@dataclass(frozen=True, kw_only=True)
class WrittenPage:
    """The report of a check, and what it is about.

    Attributes
    ----------
    html : str
    record : dict
        ``result.json``.
    surface : ndarray
        (n, 3) nodes on the surface of the solid [mm].
    stresses : tuple of ndarray
        (n,) stress there under each variant, as the finite elements say [MPa].
    """

    html: str
    record: dict
    surface: np.ndarray
    stresses: tuple[np.ndarray, ...]


@cache
def written() -> WrittenPage:
    """Return the report of the wing of whose links one is a solid; one process of a run writes it."""
    return solved.shared("report of the wing with a solid", _written)


def _written() -> WrittenPage:
    from tempfile import TemporaryDirectory

    from alula.reports.check.folder import write_report

    result = wing_with_solid.result()
    with TemporaryDirectory() as folder:
        write_report(result, Path(folder) / "out")
        html = (Path(folder) / "out" / "report.html").read_text(encoding="utf-8")
        record = json.loads((Path(folder) / "out" / "result.json").read_text(encoding="utf-8"))
    solid = result.load_cases["weight"].links[wing_with_solid.SOLID_LINK].solution
    nodes = np.unique(solid.space.boundary)
    fields = [stress_field(solid.space, case.displacement, E=solid.E, nu=solid.nu) for case in solid.cases]
    stresses = tuple(field.decisive(brittle=False)[nodes] for field in fields)
    return WrittenPage(html=html, record=record, surface=solid.space.nodes[nodes], stresses=stresses)


@pytest.fixture(scope="session")
def page():
    """The written report."""
    return written()


@pytest.fixture(scope="session")
def file(page, tmp_path_factory):
    """The written report as a file, alone in its folder."""
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(page.html, encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """Chromium, for all tests of a process."""
    with chromium.chromium(tmp_path_factory.mktemp("profile")) as started:
        yield started
