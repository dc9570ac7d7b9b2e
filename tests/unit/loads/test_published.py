from pathlib import Path

import numpy as np
import pytest
from planar_linkages import joint, link, six_bar
from pydantic import ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.pose import Pose, solve_pose
from alula.loads.records.applied import PointLoad
from alula.loads.sources.published_statics import PublishedStatics, StaticsAudit, audit, read_matrix
from alula.loads.statics.statics import Drive, assemble, solve_statics

NEAR = {"AE": 2.5, "CF": 3.5, "CH": 2.48, "ED": 3.5}
ORDER = ("GF", "CF", "AE", "ED", "CH")
COLUMNS = (*(f"R{name}{axis}" for name in "ABCDEFG" for axis in "xy"), "T")
SIGN = {"CH": 1.0, "CF": -1.0, "ED": -1.0, "AE": 1.0, "GF": 1.0}
"""Sign with which the one unknown of each joint acts on each link, so that the two links of a joint differ."""
WEIGHT = PointLoad(link="CH", point="H", wrench=np.array([0.0, -0.25, 0.0, 0.0, 0.0, 0.0]))


@pytest.fixture(scope="module")
def pose() -> Pose:
    return solve_pose(six_bar(), coordinate="GF", angle=np.radians(228.15), near=NEAR)


def right_system(pose: Pose, turn: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A published system without mistakes: matrix, right-hand side, solution [N, N m]; moments about H for CH."""
    matrix, rhs = np.zeros((15, 15)), np.zeros(15)
    about = {"GF": "G", "CF": "B", "AE": "A", "ED": "E", "CH": "H"}
    for i, name in enumerate(ORDER):
        pole = pose.points[about[name]]
        for point in "ABCDEFG":
            if name in pose.linkage.joints[point].links:
                k, arm = 2 * "ABCDEFG".index(point), (pose.points[point] - pole) / 1000.0
                matrix[3 * i, k] = matrix[3 * i + 1, k + 1] = 1.0
                matrix[3 * i + 2, k : k + 2] = turn * -arm[1], turn * arm[0]
    matrix[8, 14] = turn
    rhs[13] = 0.25
    return matrix, rhs, np.linalg.solve(matrix, rhs)


def text(matrix: np.ndarray, digits: int | None = None) -> str:
    rows = [",".join(repr(float(x)) if digits is None else f"{x:.{digits}f}" for x in row) for row in matrix]
    return "\n".join([",".join(COLUMNS), *rows])


def published(solution: np.ndarray, **change: object) -> PublishedStatics:
    entries: dict[str, object] = {
        "source": "test",
        "exact": "a.csv",
        "printed": "b.csv",
        "links": ORDER,
        "rhs": {"14": 0.25},
        "reactions": tuple(float(x) for x in np.round(solution, 4)),
    }
    return PublishedStatics.model_validate(entries | change)


def of(pose: Pose, matrix: np.ndarray, solution: np.ndarray) -> StaticsAudit:
    return audit(published(solution), text(matrix), text(matrix, 4), pose, [WEIGHT])


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_a_right_system_has_no_wrong_row_and_leaves_nothing(pose: Pose, turn: float) -> None:
    """Whichever way round the source counts its moments."""
    matrix, _, solution = right_system(pose, turn)
    found = of(pose, matrix, solution)
    assert all(row.valid for row in found.rows)
    assert max(row.defect for row in found.rows) < 1e-12
    for left in found.imbalances:
        assert np.linalg.norm(left.force) < 5e-4  # four forces rounded to 5e-5 N each
        assert abs(left.moment) < 0.2  # N mm: those times 0.19 m, and the torque's 5e-5 N m
    assert found.reproduced
    assert found.printed_error <= found.rounding_bound


def test_a_right_system_gives_what_statics_gives(pose: Pose) -> None:
    _, _, solution = right_system(pose)
    reactions = solve_statics(pose, Drive(link="AE", joint="A"), [WEIGHT])
    for i, name in enumerate("ABCDEFG"):
        assert np.linalg.norm(solution[2 * i : 2 * i + 2]) == pytest.approx(reactions.joints[name].magnitude, rel=1e-9)
    assert solution[14] * 1000.0 == pytest.approx(reactions.drive_torque, rel=1e-9)
    assert assemble(pose.placement, Drive(link="AE", joint="A"), []).matrix.shape == (15, 15)


@pytest.mark.parametrize("row", range(15))
def test_a_wrong_coefficient_is_found_in_its_row_and_nowhere_else(pose: Pose, row: int) -> None:
    matrix, _, solution = right_system(pose)
    k = int(np.argmax(np.abs(matrix[row, :14])))
    matrix[row, k] *= -1.3
    found = of(pose, matrix, solution)
    assert [finding.number for finding in found.rows if not finding.valid] == [row + 1]


def test_a_force_of_a_foreign_joint_is_found(pose: Pose) -> None:
    matrix, _, solution = right_system(pose)
    matrix[0, COLUMNS.index("RDx")] = 1.0
    assert [finding.number for finding in of(pose, matrix, solution).rows if not finding.valid] == [1]


def test_a_row_without_forces_is_no_equilibrium_equation(pose: Pose) -> None:
    matrix, _, solution = right_system(pose)
    matrix[8] = 0.0
    matrix[8, 14] = 1.0
    found = of(pose, matrix, solution)
    assert found.rows[8].defect == 1.0
    assert not found.rows[8].valid


def test_imbalances_are_the_sums_at_the_assembled_pose(pose: Pose) -> None:
    """Arbitrary reactions: sums written anew, link by link, about the origin of each link's frame."""
    matrix, _, _ = right_system(pose)
    solution = np.random.default_rng(5).normal(size=15)
    found = of(pose, matrix, solution)
    stated = np.round(solution, 4)
    assert sorted({left.link for left in found.imbalances}) == ["AE", "CF", "CH", "ED", "GF"]
    for left in found.imbalances:
        force, moment = np.zeros(2), 0.0
        for point in "ABCDEFG":
            if left.link in pose.linkage.joints[point].links:
                f = SIGN[left.link] * stated[2 * "ABCDEFG".index(point) :][:2]
                r = pose.points[point] - pose.origins[left.link]
                force, moment = force + f, moment + r[0] * f[1] - r[1] * f[0]
        if left.link == "AE":
            moment += 1000.0 * stated[14]
        if left.link == "CH":
            force = force + np.array([0.0, -0.25])
            moment -= 0.25 * (pose.points["H"] - pose.origins["CH"])[0]
        np.testing.assert_allclose(left.force, force, atol=1e-12)
        assert left.moment == pytest.approx(moment, abs=1e-9)


def test_one_digit_off_is_not_reproduced(pose: Pose) -> None:
    matrix, _, solution = right_system(pose)
    off = np.round(solution, 4)
    off[3] += 1e-4
    found = audit(published(off), text(matrix), text(matrix, 4), pose, [WEIGHT])
    assert not found.reproduced


def test_no_rounding_exceeds_the_bound(pose: Pose) -> None:
    """Random changes of up to half a unit in the fourth decimal, and the worst one for each unknown."""
    matrix, rhs, solution = right_system(pose)
    rounded = (matrix != 0) & (np.abs(matrix) != 1)
    rng = np.random.default_rng(7)
    for _ in range(100):
        changed = matrix + 0.5e-4 * rng.uniform(-1, 1, matrix.shape) * rounded
        found = audit(published(solution), text(matrix), text(changed), pose, [WEIGHT])
        assert np.max(np.abs(found.printed - solution)) <= found.rounding_bound
    worst = 0.0
    for k in range(15):
        inverse = np.linalg.inv(matrix)
        changed = matrix - 0.5e-4 * np.sign(np.outer(inverse[k], solution)) * rounded
        worst = max(worst, abs((np.linalg.solve(changed, rhs) - solution)[k]))
    assert 0.9 * worst < found.rounding_bound - 0.5e-4 < 1.2 * worst  # sharp


def test_links_that_meet_at_the_ground_alone_each_have_a_sign() -> None:
    """Two pendulum-like structures side by side: no joint between the two, so each keeps its own sign."""
    linkage = Linkage(
        {
            "g": link(ground=True, A=(0, 0), B=(96, 0), C=(200, 0), D=(296, 0)),
            "1": link(A=(0, 0), P=(80, 0)),
            "2": link(B=(0, 0), P=(80, 0)),
            "3": link(C=(0, 0), Q=(80, 0)),
            "4": link(D=(0, 0), Q=(80, 0)),
        },
        {
            "A": joint("g", "1"),
            "P": joint("1", "2"),
            "B": joint("g", "2"),
            "C": joint("g", "3"),
            "Q": joint("3", "4"),
            "D": joint("g", "4"),
        },
    )
    pose = solve_pose(linkage, coordinate=None, near={"1": 0.9, "2": 2.2, "3": 0.9, "4": 2.2})
    system = assemble(pose.placement, None, [])
    columns = ",".join(system.columns)
    # Count every force as acting on the link with one sign, in m.
    matrix = np.abs(np.sign(system.matrix)) * np.abs(system.matrix)
    for i, name in enumerate(linkage.moving):
        for k, column in enumerate(system.columns):
            sign = -1.0 if linkage.joints[column[1:-1]].links[0] == name else 1.0
            matrix[3 * i : 3 * i + 3, k] = sign * system.matrix[3 * i : 3 * i + 3, k] / [1, 1, 1000]
    lines = "\n".join([columns, *(",".join(repr(float(x)) for x in row) for row in matrix)])
    stated = PublishedStatics(
        source="t", exact="a", printed="b", links=linkage.moving, rhs={"2": 1.0}, reactions=(0.0,) * 12
    )
    found = audit(stated, lines, lines, pose, [])
    assert all(row.valid for row in found.rows)


def test_three_links_round_a_triangle_have_no_signs() -> None:
    linkage = Linkage(
        {
            "g": link(ground=True, A=(0, 0), B=(60, 0)),
            "1": link(A=(0, 0), P=(60, 0), Q=(60, 40)),
            "2": link(P=(0, 0), R=(40, 0), B=(20, 0)),
            "3": link(Q=(0, 0), R=(40, 0)),
        },
        {"A": joint("g", "1"), "P": joint("1", "2"), "Q": joint("1", "3"), "R": joint("2", "3")},
    )
    assert linkage.mobility == 1
    pose = solve_pose(linkage, coordinate="1", angle=0.2, near={"2": 1.8, "3": 0.9})
    columns = [f"R{name}{axis}" for name in "APQR" for axis in "xy"] + ["T"]
    lines = "\n".join([",".join(columns), *(",".join(map(str, row)) for row in np.eye(9))])
    stated = PublishedStatics(source="t", exact="a", printed="b", links=("1", "2", "3"), rhs={}, reactions=(0.0,) * 9)
    with pytest.raises(CaseError, match="no choice of signs"):
        audit(stated, lines, lines, pose, [])


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("", "cannot be read"),
        ("\n\n", "shape"),
        ("RAx,RAy\n1,2", r"shape \(1, 2\) for 2 columns"),
        ("RAx,RAy\n1,2\n3", "cannot be read"),
        ("RAx,RAy\n1,2\n3,four", "cannot be read.*four.*write numbers"),
        ("RAx,RAy\n1,2\n3,nan", "not finite"),
        ("RAx,RAy\n1,2\n3,1e999", "not finite"),
        ("RAx,RAy\n1," + "2" * 200_000 + "\n3,4", "cannot be read"),
    ],
)
def test_coefficient_files_that_are_none(lines: str, words: str) -> None:
    with pytest.raises(CaseError, match=words) as caught:
        read_matrix(lines)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"rhs": {"0": 1.0}}, "'0' is no equation; number them from 1 to 15"),
        ({"rhs": {"16": 1.0}}, "'16' is no equation"),
        ({"rhs": {"x": 1.0}}, "'x' is no equation"),
        ({"rhs": {"²": 1.0}}, "is no equation"),
        ({"rhs": {"9" * 5000: 1.0}}, "is no equation"),
        ({"reactions": (1.0, 2.0)}, "do not fit together"),
        ({"links": ("GF", "CF")}, "do not fit together"),
    ],
)
def test_entries_that_do_not_fit(pose: Pose, change: dict[str, object], words: str) -> None:
    matrix, _, solution = right_system(pose)
    with pytest.raises(CaseError, match=words):
        audit(published(solution, **change), text(matrix), text(matrix), pose, [WEIGHT])


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("RAx", "QAx", "column 'QAx' is not understood"),
        ("RAx", "RAz", "column 'RAz' is not understood"),
        ("RAx", "RZx", "column 'RZx' names a joint that does not exist; the joints are A, B"),
    ],
)
def test_columns_that_mean_nothing(pose: Pose, old: str, new: str, words: str) -> None:
    matrix, _, solution = right_system(pose)
    lines = text(matrix).replace(old, new, 1)
    with pytest.raises(CaseError, match=words):
        audit(published(solution), lines, lines, pose, [WEIGHT])


def test_a_singular_matrix_is_refused(pose: Pose) -> None:
    matrix, _, solution = right_system(pose)
    matrix[1] = matrix[0]
    with pytest.raises(CaseError, match="singular; check its rows"):
        audit(published(solution), text(matrix), text(matrix), pose, [WEIGHT])


def test_nan_is_no_published_reaction() -> None:
    with pytest.raises(ValidationError, match="finite"):
        published(np.full(15, np.nan))


def test_no_file_is_read_here(pose: Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "open", lambda *a, **k: pytest.fail("a file was opened"))
    matrix, _, solution = right_system(pose)
    before = matrix.copy()
    of(pose, matrix, solution)
    np.testing.assert_array_equal(matrix, before)
