"""What is found in STEP files that CadQuery wrote (``tests/data/step/make_parts.py`` states their sizes)."""

import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from alula.geometry.base import kernel_child
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.imported import read
from alula.geometry.imported.facts import Bore
from alula.geometry.imported.read import part_facts

FILES = Path(__file__).parents[2] / "data" / "step"
STAND = Rotation.from_rotvec(np.radians(50.0) * np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0))
SHIFT = np.array([30.0, -20.0, 55.0])
ROUND = (0.0, 0.0, 0.0)

SAID_BY_CADQUERY = {
    "plate": (6074.612825522758, 3402.6327261565416, (30.018060942236115, -20.106628685204566, 55.25038384940428)),
    "bell_crank": (3526.1238859864384, 2689.290416456516, (11.265359607931565, 6.225150912661469, 3.098716985413501)),
    "fork": (8414.53102520358, 3956.1681167838497, (21.80008241331552, -2.0, 7.0)),
    "slotted": (10604.054205664146, 5879.704610683574, (29.712233991114243, -20.26393175558233, 55.09649260115372)),
    "lever": (3583.451597919603, 2645.8923307797095, (44.83207621586201, -6.627987316483596, 50.5086529098933)),
    "halves": (1762.9203673205102, 1423.1238898038469, (0.0, 0.0, 2.0)),
    "cross_tube": (2713.0168413358188, 3738.6275020036783, (0.0, 0.0, 0.0)),
    "inch": (11888.09893846636, 5287.956869774374, (0.0, 0.0, 0.0)),
}
"""Volume [mm³], surface [mm²] and centroid [mm]."""


def bores(name: str) -> tuple[Bore, ...]:
    return part_facts(FILES / f"{name}.step").bores


def placed(*point: float) -> np.ndarray:
    """Return where a point of a part that was rotated and shifted lies."""
    return STAND.apply(point) + SHIFT


@pytest.mark.parametrize("name", SAID_BY_CADQUERY)
def test_volume_surface_and_centroid_are_those_of_the_program_that_wrote_the_file(name):
    volume, surface, centroid = SAID_BY_CADQUERY[name]
    facts = part_facts(FILES / f"{name}.step")
    size = np.linalg.norm(np.subtract(facts.high, facts.low))
    assert facts.volume == pytest.approx(volume, rel=1e-6)
    assert facts.surface == pytest.approx(surface, rel=1e-6)
    assert np.allclose(facts.centroid, centroid, rtol=0.0, atol=1e-6 * size)


def test_a_file_in_inches_is_read_in_mm():
    facts = part_facts(FILES / "inch.step")
    assert facts.volume == pytest.approx(25.4**3 * (3.0 * 1.0 * 0.25 - 2.0 * np.pi / 4.0 * 0.25**2 * 0.25), rel=1e-9)
    assert np.allclose(np.subtract(facts.high, facts.low), (76.2, 25.4, 6.35), atol=1e-6)
    assert [bore.diameter for bore in facts.bores] == pytest.approx([6.35, 6.35])


def test_inertia_is_that_of_a_plate_with_two_holes():
    """Parallel axes; a cylinder of radius r and height h has m (3 r² + h²) / 12 across and m r² / 2 along its axis."""

    def parts():
        yield 76.2 * 25.4 * 6.35, (25.4**2 + 6.35**2, 76.2**2 + 6.35**2, 76.2**2 + 25.4**2), 0.0
        hole, r, h = -np.pi * 3.175**2 * 6.35, 3.175, 6.35
        for x in (-25.4, 25.4):
            yield hole, (3.0 * r**2 + h**2, 3.0 * r**2 + h**2, 6.0 * r**2), x

    expected = sum(
        volume * (np.array(twelfths) / 12.0 + x**2 * np.array([0.0, 1.0, 1.0])) for volume, twelfths, x in parts()
    )
    assert np.allclose(part_facts(FILES / "inch.step").inertia, np.diag(expected), rtol=1e-9, atol=1e-6)


def test_bores_of_a_rotated_and_shifted_plate_are_where_its_assembly_puts_them_and_its_boss_is_none():
    one, other = bores("plate")
    assert (one.name, other.name) == ("bore 1", "bore 2")
    for bore, x, diameter in ((one, -20.0, 5.0), (other, 20.0, 6.0)):
        assert np.allclose(bore.centre, placed(x, 0.0, 0.0), atol=1e-9)
        assert abs(np.dot(bore.axis, STAND.apply([0.0, 0.0, 1.0]))) == pytest.approx(1.0, abs=1e-12)
        assert (bore.diameter, bore.length) == pytest.approx((diameter, 5.0))
        assert bore.through
        assert not bore.around
        assert np.allclose(bore.spans, [(-2.5, 2.5)])
        assert (bore.slot, bore.slot_axis) == (0.0, ROUND)


def test_the_hub_of_a_bell_crank_is_at_another_height_than_its_arms_and_fillets_are_no_bores():
    found = [(bore.centre, bore.diameter, bore.length, bore.around) for bore in bores("bell_crank")]
    assert found == [
        (pytest.approx((0.0, 0.0, 6.0)), pytest.approx(6.0), pytest.approx(12.0), True),
        (pytest.approx((0.0, 30.0, 2.5)), pytest.approx(5.0), pytest.approx(5.0), False),
        (pytest.approx((40.0, 0.0, 2.5)), pytest.approx(4.0), pytest.approx(5.0), False),
    ]


def test_a_fork_is_one_bore_with_two_spans():
    eye, fork = bores("fork")
    assert np.allclose(eye.spans, [(-8.0, 8.0)])
    assert np.allclose(fork.spans, [(-8.0, -4.0), (4.0, 8.0)])
    assert fork.centre == pytest.approx((45.0, -2.0, 7.0))
    assert fork.axis == pytest.approx((0.0, 1.0, 0.0))
    assert (fork.length, fork.through) == (pytest.approx(16.0), True)


def test_two_half_cylinders_are_one_bore():
    assert [(bore.centre, bore.diameter) for bore in bores("halves")] == [
        (pytest.approx((-14.0, 0.0, 2.0)), pytest.approx(5.0)),
        (pytest.approx((14.0, 0.0, 2.0)), pytest.approx(5.0)),
    ]


def test_pins_straight_through_a_tube_are_forks_and_its_inside_is_a_bore_about_the_axis_of_its_outside():
    one, inside, other = bores("cross_tube")
    for bore, x in ((one, -36.0), (other, 36.0)):
        assert bore.centre == pytest.approx((x, 0.0, 0.0), abs=1e-9)
        assert bore.axis == pytest.approx((0.0, 0.0, 1.0))
        # From where the inner cylinder is lowest beside the pin, sqrt(2.5² - 1.5²), to the top of the outer one.
        assert np.allclose(bore.spans, [(-4.0, -2.0), (2.0, 4.0)], atol=1e-6)
        assert not bore.around
    assert (inside.diameter, inside.length, inside.around) == (pytest.approx(5.0), pytest.approx(90.0), True)
    assert inside.axis == pytest.approx((1.0, 0.0, 0.0))


def test_chamfers_countersinks_and_counterbores_hide_no_bore_and_a_window_is_none():
    """Along the strip: x, z and length of the cylindrical wall, diameter, through."""
    long = 6.0
    expected = [
        (-40.0, 0.0, long - 2.0 * 0.5, 6.0, True),
        (-25.0, (-3.0 + 0.5) / 2.0, long - 2.5, 5.0, True),  # the countersink has 2.5 mm radius at z = 0.5
        (-8.0, 0.0, long, 4.0, True),
        (8.0, 1.0, 4.0, 5.0, False),
        (20.0, 2.0, 2.0, 10.0, True),
        (20.0, -1.0, 4.0, 5.0, True),
        (42.0, 2.0, 2.0, 4.0, False),
        (42.0, -2.0, 2.0, 4.0, False),
    ]
    found = bores("slotted")
    assert len(found) == len(expected)
    left = {bore.name: bore for bore in found}
    for x, z, length, diameter, through in expected:
        [bore] = [bore for bore in left.values() if np.allclose(bore.centre, placed(x, 0.0, z), atol=1e-6)]
        assert (bore.length, bore.diameter) == pytest.approx((length, diameter), rel=1e-9)
        assert bore.through is through
        del left[bore.name]


def test_a_groove_is_no_bore_and_parts_none_and_a_hole_across_it_is_one_of_its_own():
    bore, grease = bores("sleeve")
    assert (bore.diameter, bore.length, bore.through, bore.around) == (
        pytest.approx(10.0),
        pytest.approx(20.0),
        True,
        True,
    )
    assert np.allclose(bore.spans, [(-10.0, 4.0), (5.2, 10.0)])
    assert (grease.diameter, grease.axis, grease.through) == (pytest.approx(3.0), pytest.approx((1.0, 0.0, 0.0)), True)


def test_cylinders_written_as_splines_are_bores():
    found = bores("splines")
    assert [bore.centre for bore in found] == [pytest.approx((x, 8.0, 0.0), abs=1e-9) for x in (-20.0, 20.0)]
    for bore in found:
        assert (bore.diameter, bore.length, bore.through) == (pytest.approx(5.0), pytest.approx(5.0), True)
        assert bore.axis == pytest.approx((0.0, 0.0, 1.0))


def test_the_volume_of_a_sleeve_with_a_hole_across_is_the_integral_over_the_hole():
    """CadQuery itself is 1.9e-6 below it, since the kernel integrates over faces with curved borders by few points."""

    def across(y: float) -> float:
        return 2.0 * np.sqrt(1.5**2 - y**2) * (np.sqrt(15.0**2 - y**2) - np.sqrt(5.0**2 - y**2))

    ring = np.pi * (15.0**2 - 5.0**2) * 20.0 - np.pi * (5.6**2 - 5.0**2) * 1.2
    assert part_facts(FILES / "sleeve.step").volume == pytest.approx(ring - quad(across, -1.5, 1.5)[0], rel=1e-6)


def test_of_a_bore_that_is_open_the_share_of_its_circle_is_told():
    """Bores of 6 mm with a keyway of 2 mm, a slit of 1 mm, a hole across, a blind keyway, and 2 mm from an end."""
    found = {round(bore.centre[0]): bore.share for bore in bores("open_bores") if bore.diameter > 5.0}
    keyway, slit, end = np.arcsin(1.0 / 3.0), np.arcsin(0.5 / 3.0), np.arccos(2.0 / 3.0)
    assert found == pytest.approx(
        {-50: 1.0 - keyway / np.pi, -30: 1.0 - slit / np.pi, -5: 1.0, 35: 1.0, 58: 1.0 - end / np.pi}, abs=1e-6
    )


def test_the_bore_of_a_thread_is_that_inside_it():
    """Of 5 mm and as long as its crest, 1.1 turns of 1 mm and 0.12 mm; not the hole of 6 mm in which the thread is."""
    assert [(bore.diameter, bore.length) for bore in bores("threaded")] == [
        (pytest.approx(5.0), pytest.approx(1.22, abs=1e-3)),
        (pytest.approx(5.0), pytest.approx(4.0)),
    ]


def test_an_elongated_hole_is_a_slot():
    [slot] = [bore for bore in bores("slotted") if bore.slot]
    assert (slot.slot, slot.diameter) == pytest.approx((10.0, 4.0))
    way = STAND.apply([np.cos(np.radians(30.0)), np.sin(np.radians(30.0)), 0.0])
    assert abs(np.dot(slot.slot_axis, way)) == pytest.approx(1.0, abs=1e-9)


def test_several_solids_and_none_are_refused_with_what_there_is():
    with pytest.raises(CaseError, match=r"'two_solids.step' holds 2 solids \(10 x 10 x 10 mm; 20 x 10 x 5 mm\)"):
        part_facts(FILES / "two_solids.step")
    with pytest.raises(CaseError, match=r"'shell.step' holds only surfaces without volume \(4\)"):
        part_facts(FILES / "shell.step")


HEADER = b"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
EMPTY = HEADER + b"FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "is empty"),
        (b"solid knee\nendsolid", "is no STEP file: it does not begin with 'ISO-10303-21;'; export"),
        (bytes(range(256)) * 40, "is no STEP file"),
        ((FILES / "inch.step").read_bytes()[:5000], "is cut off"),
        (EMPTY, "holds no solid|cannot be read as STEP"),
        (HEADER + bytes(range(256)) * 40 + b"END-ISO-10303-21;", "holds no solid|cannot be read as STEP"),
    ],
    ids=["empty", "text", "bytes", "cut off", "no data", "bytes inside"],
)
def test_what_is_no_step_file_is_refused_in_a_sentence(content, sentence, tmp_path):
    file = tmp_path / "knee.step"
    file.write_bytes(content)
    with pytest.raises(CaseError, match=sentence) as caught:
        part_facts(file)
    assert "knee.step" in str(caught.value)


def test_no_file_a_folder_and_one_that_is_too_large_are_refused(tmp_path):
    with pytest.raises(CaseError, match="there is no file"):
        part_facts(tmp_path / "knee.step")
    with pytest.raises(CaseError, match="is a folder"):
        part_facts(tmp_path)
    large = tmp_path / "large.step"
    large.write_bytes(HEADER)
    os.truncate(large, 200_000_001)
    with pytest.raises(CaseError, match="has more than the 200 MB that are read"):
        part_facts(large)


@pytest.mark.parametrize("name", ["Kniehebel groß.step", "膝.stp", os.fsdecode(b"gro\xdf.step")])
def test_any_name_of_a_file_will_do(name, tmp_path, monkeypatch):
    monkeypatch.setattr(read, "_known", {})
    shutil.copy(FILES / "inch.step", tmp_path / name)
    monkeypatch.chdir(tmp_path)
    assert len(part_facts(Path(name)).bores) == 2


def test_a_kernel_that_takes_too_long_is_stopped(monkeypatch):
    monkeypatch.setattr(read, "_known", {})
    monkeypatch.setattr(read, "TIME_LIMIT", 1e-4)
    with pytest.raises(CannotRunError, match=r"reading 'slotted.step', was stopped after its time limit of 0.0001 s"):
        part_facts(FILES / "slotted.step")


def test_a_kernel_that_crashes_on_a_file_is_contained(monkeypatch):
    script = "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)"
    monkeypatch.setattr(read, "_known", {})
    monkeypatch.setattr(kernel_child, "_command", lambda: [sys.executable, "-c", script])
    with pytest.raises(CannotRunError, match=r"reading 'slotted.step', crashed \(SIGSEGV\); export the part anew"):
        part_facts(FILES / "slotted.step")
