"""What nothing weighs, and a torque on a pin that turns freely, are refused in one sentence."""

from pathlib import Path

import pytest

from alula.geometry.base.errors import CaseError
from alula.geometry.meshing.mesh import mass_properties
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.loads.states import masses
from alula.loads.states.masses import part_mass, rough_masses

LADEN = str(Path(__file__).parent / "four-bar-laden.toml")


def _without_part(tmp_path: Path, *overrides: str) -> Case:
    text = Path(LADEN).read_text(encoding="utf-8").replace('[links.coupler]\npart = "bar"', "[links.coupler]")
    path = tmp_path / "bare.toml"
    path.write_text(text, encoding="utf-8")
    return read_case(str(path), overrides)


def test_a_link_that_nothing_weighs_is_refused_unless_it_is_stated_massless(tmp_path: Path) -> None:
    for override, entry in (
        ("load_cases.turning.carried=true", "load_cases.turning.own_weight"),
        ("load_cases.turning.own_weight=false", "load_cases.turning.speed"),
        (
            'load_cases={still={own_weight=false}}\nmotion={range=["40 deg","60 deg"],speed="3 rpm",inertia=true}',
            "motion.speed",
        ),
    ):
        with pytest.raises(
            CaseError, match=rf"^{entry}: link 'coupler' has neither a part nor a mass.*massless"
        ) as wrong:
            _without_part(tmp_path, *override.split("\n"))
        assert wrong.value.exit_status == 2
    assert _without_part(tmp_path, "load_cases={still={own_weight=false}}").massless == ()
    assert _without_part(tmp_path, 'carried.0={link="coupler", at="A", mass="1 g"}').carried[0].mass == 1e-6
    assert _without_part(tmp_path, 'massless=["coupler"]').massless == ("coupler",)


@pytest.mark.parametrize(
    ("overrides", "sentence"),
    [
        (['massless=["base"]'], "massless: 'base' is not a moving link"),
        (['massless=["crank"]'], "massless: link 'crank' has a part, so it weighs something"),
        (['carried.0.mass="3"'], r"^carried\.0\.mass \(it is '3'\): the mass needs its unit"),
        (['carried.1={link="rocker", at="P"}'], r"^carried\.1\.mass: this entry is missing"),
        (['carried.1={link="rocker", start="O4", mass="1 g"}'], r"^carried\.1\.end: this entry is missing"),
        (["carried.1=3"], r"^carried\.1 \(it is 3\): it must be a table"),
    ],
)
def test_wrong_masses_end_in_one_sentence(overrides: list[str], sentence: str) -> None:
    with pytest.raises(CaseError, match=sentence) as wrong:
        read_case(LADEN, overrides)
    assert "more problems" not in str(wrong.value)


def test_bodies_of_one_shape_are_weighed_once_whatever_their_pins_are_called(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The levers of the ornithopter are alike but for the name of a pin."""
    case, asked = read_case("ornithopter"), []
    monkeypatch.setattr(masses, "_measured", lambda body: asked.append(body) or mass_properties(body))
    right, left = (part_mass(case, name) for name in ("lever-right", "lever-left"))
    assert case.body("lever-right") != case.body("lever-left")
    assert len({*asked}) == 1
    assert (right.mass, *right.centroid) == (left.mass, *left.centroid)
    whole = mass_properties(case.body_to_make("lever-left"))
    assert left.mass == whole.volume * case.material_of("lever-left").density


# ---- torques on pins -------------------------------------------------------------------------------------------


def test_a_torque_on_a_pin_needs_a_drive_there() -> None:
    torque = 'load_cases.turning.moments=[{link="%s", at="%s", moment=%s}]'
    for link, point in (("coupler", "A"), ("rocker", "O4")):
        with pytest.raises(CaseError, match=rf"moments\.0: the pin at '{point}' turns freely and nothing drives it"):
            read_case(LADEN, [torque % (link, point, '"2 N*mm"')])
    read_case(LADEN, [torque % ("crank", "O2", '"2 N*mm"')])  # the drive's own joint
    read_case(LADEN, [torque % ("rocker", "P", '"2 N*mm"')])  # no pin stands there
    read_case(LADEN, [torque % ("coupler", "A", '["1 N*mm", "2 N*mm", "0 N*mm"]')])  # about other axes a pin holds
    read_case(LADEN, [torque % ("rocker", "O4", '"2 N*mm"'), 'joint_model="bonded"'])


def test_rough_masses_are_those_of_the_kernel_but_for_fillets_and_holes() -> None:
    """A tube with cross holes, one without eyes; bars, one with an arm, one tapered; a disc, by the kernel."""
    bare = (
        'parts.tube={shape="tube",material="pvc-paredes-2018",outer_diameter="5 mm",inner_diameter="2.5 mm",'
        'eyes="none",overhang="6 mm"}',
        "drive.transfer=bore-shear",
    )
    for name, overrides, links, apart in (
        ("owl-wing-static", (), "CF", 0.01),
        ("owl-wing-static", bare, "GF", 0.01),
        ("flapping-wing-chosen", (), "outer-right crank", 0.005),
        (
            LADEN,
            (
                'parts.bar={shape="bar",material="pvc-paredes-2018",thickness="3 mm",fillet_radius="0.5 mm",'
                'widths=[["0 mm","10 mm"],["30 mm","6 mm"]],shoulder_radius="1 mm"}',
            ),
            "coupler",
            0.01,
        ),
    ):
        case = read_case(name, overrides)
        rough = rough_masses(case)
        for link in links.split():
            assert rough[link] == pytest.approx(part_mass(case, link).mass, rel=apart)
    disc = read_case("ornithopter")
    assert rough_masses(disc)["crank"] == part_mass(disc, "crank").mass
