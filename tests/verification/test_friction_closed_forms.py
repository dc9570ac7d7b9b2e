"""Friction against closed forms: a lever, a slider-crank near its dead point, a wedge, and the plain iteration."""

import math

import numpy as np
import pytest
from planar_linkages import four_bar, joint, link
from scipy.optimize import brentq

from alula.geometry.linkage.linkage import Linkage
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.loads.records.applied import PointLoad, at_poses
from alula.loads.statics.friction import Friction, solve_friction
from alula.loads.statics.statics import Drive, assemble


def force(on: str, at: str, *components: float) -> PointLoad:
    return PointLoad(link=on, point=at, wrench=np.array([*components, *[0.0] * (6 - len(components))]))


def rubbed(
    linkage: Linkage,
    drive: Drive,
    load: PointLoad,
    coordinate: str,
    values: list[float],
    near: dict[str, float],
    *,
    slides: bool = False,
    sense: float = 1.0,
    most: float = 1.0,
) -> Friction:
    start = {"travel" if slides else "angle": values[0]}
    pose = solve_pose(linkage, coordinate=coordinate, near=near, **start)
    place = solve_motion(pose, values).virtual
    return solve_friction(place, drive, [at_poses(load, place.shape)], sense, most=most)


def effort(linkage: Linkage, drive: Drive, found: Friction, load: PointLoad) -> np.ndarray:
    columns = assemble(found.place, drive, [load]).columns
    return found.unknowns[:, columns.index("P" if drive.coordinate(linkage).slides else "T")]


def bell_crank(friction: float) -> Linkage:
    """A lever at O with arms of 30 mm up to A and 80 mm aside to W; a rod pushes A along x."""
    return Linkage(
        {
            "base": link(ground=True, O=(0.0, 0.0), S=(-50.0, 30.0)),
            "lever": link(O=(0.0, 0.0), A=(0.0, 30.0), W=(80.0, 0.0)),
            "rod": link(A=(0.0, 0.0), B=(-40.0, 0.0)),
            "block": link(B=(0.0, 0.0), Q=(-10.0, 0.0)),
        },
        {
            "O": joint("base", "lever", pin_diameter="24 mm", friction=friction),
            "A": joint("lever", "rod"),
            "B": joint("rod", "block"),
            "S": joint("base", "block", type="slider", points=("S", "B")),
        },
    )


@pytest.mark.parametrize("friction", [0.1, 0.8, 1.9])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_lever(friction: float, sense: float) -> None:
    """P b = W a -+ rho |R| with R = (P, W): a quadratic equation. The coordinate grows clockwise about W's pull."""
    weight, a, b, rho = 5.0, 80.0, 30.0, friction * 12.0
    linkage, drive = bell_crank(friction), Drive(link="block", joint="S")
    load = force("lever", "W", 0.0, -weight)
    found = rubbed(linkage, drive, load, "lever", [0.0], {"rod": 0.0, "block": 0.0}, sense=sense)
    # Moments about O, counter-clockwise: -weight a - push b - sense rho |R| = 0, with the push P on A along x.
    squared = [b**2 - rho**2, 2.0 * weight * a * b, weight**2 * (a**2 - rho**2)]
    roots = np.roots(squared)
    gaps = [abs(-weight * a - p * b - sense * rho * math.hypot(p, weight)) for p in roots]
    expected = float(roots[int(np.argmin(gaps))].real)
    assert min(gaps) < 1e-9
    assert effort(linkage, drive, found, load)[0] == pytest.approx(expected, rel=1e-11)
    assert found.residual[0] < 1e-12
    assert math.isinf(found.lock[0])


def test_lever_locks_where_the_rod_touches_the_friction_circle() -> None:
    """The push acts at the distance b; where that is mu r, no push overcomes the friction that it makes."""
    linkage, drive = bell_crank(2.0), Drive(link="block", joint="S")
    load = force("lever", "W", 0.0, 5.0)  # to lift W against the motion the lever must turn clockwise: sense -1
    near = {"rod": 0.0, "block": 0.0}
    assert math.isinf(rubbed(linkage, drive, load, "lever", [0.0], near, sense=1.0, most=1.2).lock[0])
    locked = rubbed(linkage, drive, load, "lever", [0.0], near, sense=-1.0, most=2.0)
    assert locked.lock[0] == pytest.approx(30.0 / (2.0 * 12.0), rel=1e-5)
    assert np.isnan(locked.unknowns).all()


CRANK, ROD = 20.0, 70.0
RADII = {"A": 3.0, "B": 2.5, "C": 2.0}


def engine(friction: float) -> Linkage:
    pins = {name: {"pin_diameter": f"{2.0 * r} mm", "friction": friction} for name, r in RADII.items()}
    return Linkage(
        {
            "base": link(ground=True, A=(0.0, 0.0), S=(0.0, 0.0)),
            "crank": link(A=(0.0, 0.0), B=(CRANK, 0.0)),
            "rod": link(B=(0.0, 0.0), C=(ROD, 0.0)),
            "block": link(C=(0.0, 0.0), Q=(10.0, 0.0)),
        },
        {
            "A": joint("base", "crank", **pins["A"]),
            "B": joint("crank", "rod", **pins["B"]),
            "C": joint("rod", "block", **pins["C"]),
            "S": joint("base", "block", type="slider", points=("S", "C")),
        },
    )


def spare_arm(angle: float, friction: float) -> float:
    """Arm about A of the rod's line of force, which crosses between the friction circles of B and C, less that of A."""
    b = CRANK * np.exp(1j * angle)
    tilt = math.asin(-b.imag / ROD)
    c = b + ROD * np.exp(1j * tilt)
    rho = {name: friction * r for name, r in RADII.items()}
    line = tilt + math.asin((rho["B"] + rho["C"]) / ROD)  # flatter than the rod, which slopes down
    # A point of the line: B moved square to it by its friction radius, towards A.
    start = b - rho["B"] * 1j * np.exp(1j * line)
    assert abs((np.conj(np.exp(1j * line)) * (c - start)).imag) == pytest.approx(rho["C"], abs=1e-9)
    return float((np.conj(np.exp(1j * line)) * start).imag) - rho["A"]


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_slider_crank_locks_near_its_dead_point(friction: float) -> None:
    """The block turns the crank against a torque where the rod's line of force clears the friction circle of A."""
    angle = brentq(lambda x: spare_arm(x, friction), 1e-3, 1.0)
    linkage, drive = engine(friction), Drive(link="block", joint="S")
    load = force("crank", "B", *[0.0] * 5, -100.0)
    near = {"rod": 0.0, "block": 0.0}
    values = [angle - 1e-4, angle + 1e-4]
    found = rubbed(linkage, drive, load, "crank", values, near)
    assert found.locked.tolist() == [True, False]
    # A share of the friction frees it again: the share at which the line of force touches the circle of A.
    inner = 0.5 * angle
    share = brentq(lambda t: spare_arm(inner, t * friction), 0.0, 1.0)
    assert rubbed(linkage, drive, load, "crank", [inner], near).lock[0] == pytest.approx(share, rel=1e-5)
    # Clear of it, the push is the torque over the spare arm, along the line of force.
    outer = 2.0 * angle
    tilt = math.asin(-CRANK * math.sin(outer) / ROD) + math.asin(friction * (RADII["B"] + RADII["C"]) / ROD)
    pushed = effort(linkage, drive, rubbed(linkage, drive, load, "crank", [outer], near), load)[0]
    assert -pushed == pytest.approx(100.0 / spare_arm(outer, friction) * math.cos(tilt), rel=1e-9)


def wedge(angle: float, slot: float, guide: float = 0.0) -> Linkage:
    """A wedge slides along x and lifts a follower, which slides along y, by a pin in its inclined slot."""
    return Linkage(
        {
            "base": link(ground=True, X=(0.0, 0.0), Y=(0.0, 0.0)),
            "wedge": link(X=(0.0, 0.0), W=(0.0, 0.0), E=(5.0, 0.0)),
            "follower": link(Y=(0.0, 0.0), F=(5.0, 0.0)),
        },
        {
            "X": joint("base", "wedge", type="slider"),
            "Y": joint("base", "follower", type="slider", direction="90 deg", friction=guide),
            "W": joint(
                "wedge",
                "follower",
                type="pin-in-slot",
                points=("W", "Y"),
                direction=f"{math.degrees(angle)!r} deg",
                friction=slot,
            ),
        },
    )


def test_wedge() -> None:
    """P = W tan(alpha + phi) up and W tan(alpha - phi) down, which changes its sign at tan(alpha) = mu."""
    drive, load = Drive(link="wedge", joint="X"), force("follower", "Y", 0.0, -10.0)
    for mu in (0.2, 0.6, 1.5):
        phi = math.atan(mu)
        for alpha in (0.1, phi - 1e-3, phi + 1e-3, 1.0):
            linkage = wedge(alpha, mu)
            for sense in (1.0, -1.0):
                found = rubbed(
                    linkage, drive, load, "X", [-20.0], {"wedge": 0.0, "follower": 0.0}, slides=True, sense=sense
                )
                # The wedge goes towards -x to lift the pin, which lies at x = 0 in a slot that rises along +x.
                expected = -10.0 * math.tan(alpha - sense * phi)
                if sense < 0.0 and alpha + phi >= math.pi / 2.0:
                    assert found.locked[0]
                    assert found.lock[0] == pytest.approx(1.0 / math.tan(alpha) / mu, rel=1e-5)
                else:
                    assert effort(linkage, drive, found, load)[0] == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_plain_iteration_ends_at_the_same_forces() -> None:
    """x <- A^-1 (b + friction of x), a contraction for small coefficients, ends where Newton's method does."""
    linkage = four_bar(40.0, 90.0, 70.0, 100.0)
    pins = {"pin_diameter": "8 mm", "friction": 0.3}
    joints = {
        name: record.model_copy(update={"friction": 0.3, "pin_diameter": 8.0})
        for name, record in linkage.joints.items()
    }
    assert pins["friction"] == 0.3
    linkage = Linkage(linkage.links, joints)
    drive, load = Drive(link="crank", joint="A"), force("coupler", "P", 3.0, -7.0)
    values = list(np.radians([40.0, 75.0, 130.0, 250.0]))
    found = rubbed(linkage, drive, load, "crank", values, {"coupler": 0.3, "rocker": 1.2})
    assert found.residual.max() < 1e-12
    place = found.place
    system = assemble(place, drive, [at_poses(load, place.shape)])
    names = list(system.columns)
    turning = {name: place.spin(r.links[1]) - place.spin(r.links[0]) for name, r in joints.items()}
    rng = np.random.default_rng(3)
    for scale in (0.0, 1.0, 1e3):
        x = scale * rng.standard_normal(found.unknowns.shape)
        changes = []
        for _ in range(200):
            right = system.rhs.copy()
            for name, record in joints.items():
                size = np.hypot(x[:, names.index(f"R{name}x")], x[:, names.index(f"R{name}y")])
                moment = -0.3 * 4.0 * size * np.sign(turning[name])
                for body, sign in zip(record.links, (-1.0, 1.0), strict=True):
                    if body != "ground":
                        right[:, 3 * linkage.moving.index(body) + 2] -= sign * moment
            new = np.linalg.solve(system.matrix, right[..., None])[..., 0]
            changes.append(np.abs(new - x).max())
            x = new
        assert np.abs(x - found.unknowns).max() <= 1e-10 * np.abs(found.unknowns).max()
        ratios = np.array(changes[2:12]) / np.array(changes[1:11])
        assert ratios.max() < 0.9
