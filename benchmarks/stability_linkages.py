"""Rows on linkages: dead points, near-Grashof lengths, near-singular synthesis."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from alula.geometry.base.errors import CaseError
from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.continuation import DeadPointError
from alula.geometry.linkage.linkage import Link, Linkage
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import solve_pose
from alula.geometry.mechanisms.fourbar import FourBar
from alula.geometry.mechanisms.grashof import classify
from alula.geometry.mechanisms.synthesis import synthesise
from alula.loads.case.case_file import read_case
from alula.loads.records.applied import Load, PointLoad
from alula.loads.states.actions import acting_loads
from alula.loads.states.masses import part_mass
from alula.loads.statics import statics
from alula.loads.statics.statics import NEARLY_SINGULAR, Drive, Reactions, solve_statics
from benchmarks.stability_report import Row, figure, table, timed

DECADES = tuple(10.0**-k for k in range(10))
"""Distance from the dead point [degrees]."""


def four_bar(a: float, b: float, c: float, d: float) -> Linkage:
    """Crank a, coupler b (P at two fifths of it), rocker c, ground d [mm]."""

    def link(ground: bool = False, **points: float) -> Link:
        return Link(ground=ground, points={name: (f"{x!r} mm", "0 mm") for name, x in points.items()})

    return Linkage(
        {
            "ground": link(ground=True, A=0.0, D=d),
            "crank": link(A=0.0, B=a),
            "coupler": link(B=0.0, P=0.4 * b, C=b),
            "rocker": link(D=0.0, C=c),
        },
        {
            "A": Joint(links=("ground", "crank")),
            "B": Joint(links=("crank", "coupler")),
            "C": Joint(links=("coupler", "rocker")),
            "D": Joint(links=("ground", "rocker")),
        },
    )


@contextmanager
def unguarded() -> Iterator[None]:
    """Without the refusal of nearly singular poses."""
    kept, statics.NEARLY_SINGULAR = statics.NEARLY_SINGULAR, 0.0
    try:
        yield
    finally:
        statics.NEARLY_SINGULAR = kept


Found = tuple[float, Reactions, float, float]
"""Distance with its sign [degrees], reactions, error of the drive torque, seconds."""


def _six_bar() -> Iterator[Found]:
    case = read_case("owl-wing-static", [])
    pose = case.solve_pose()
    motion = solve_motion(pose, np.radians([200.0, 230.0]))
    (dead,) = motion.turning_points("AE")
    masses = {link: part_mass(case, link) for link in case.checked_links}
    load_case = next(iter(case.load_cases.values()))
    moved = solve_motion(pose, [dead])
    column = moved.linkage.moving.index("AE")
    held = solve_statics(
        moved.pose(0), Drive(link="GF", joint="G"), acting_loads(case, load_case, moved.pose(0).placement, masses)
    )
    limit = held.drive_torque / float(moved.second[0, column])
    for side in (1.0, -1.0):
        for distance in DECADES:
            delta = math.radians(side * distance)
            here = solve_motion(pose, [dead + delta]).pose(0)
            loads = acting_loads(case, load_case, here.placement, masses)
            found, seconds = timed(lambda h=here, x=loads: solve_statics(h, Drive(link="AE", joint="A"), x), 3)
            yield side * distance, found, abs(found.drive_torque * delta / limit - 1.0), seconds


def _four_bar(
    linkage: Linkage, exact: Callable[[float], tuple[float, float]], load: Load, torque: Callable[[float], float]
) -> Iterator[Found]:
    for side in (1.0, -1.0):
        for distance in DECADES:
            delta = math.radians(side * distance)
            coupler, rocker = exact(delta)
            # As near as a person would state it: to a hundredth of the distance.
            near = {"coupler": coupler + 0.01 * delta, "rocker": rocker - 0.01 * delta}
            pose = solve_pose(linkage, coordinate="crank", angle=delta, near=near)
            found, seconds = timed(lambda p=pose: solve_statics(p, Drive(link="crank", joint="A"), [load]), 3)
            yield side * distance, found, abs(found.drive_torque / torque(delta) - 1.0), seconds


def kite_angles(theta: float) -> tuple[float, float]:
    """Coupler's and rocker's angle of the folding kite 30, 60, 60, 30 at a crank angle: its isosceles triangle."""
    rocker = theta / 2.0 + math.pi / 2.0 - math.acos(math.sin(theta / 2.0) / 2.0)
    end = 30.0 + 60.0 * np.exp(1j * rocker) - 30.0 * np.exp(1j * theta)
    return float(np.angle(end)), rocker


def kite_torque(theta: float) -> float:
    """Drive torque against a unit moment on the rocker: minus dψ/dθ."""
    return -0.5 - math.cos(theta / 2.0) / 4.0 / math.sqrt(1.0 - math.sin(theta / 2.0) ** 2 / 4.0)


PARALLELOGRAM, KITE = (20.0, 50.0, 20.0, 50.0), (30.0, 60.0, 60.0, 30.0)


def dead_points() -> Row:
    """Drive torque next to dead points, both sides, without the guard."""
    down = PointLoad(link="coupler", point="P", wrench=np.array([0.0, -1.0, 0.0, 0.0, 0.0, 0.0]))
    couple = PointLoad(link="rocker", point="C", wrench=np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]))
    with unguarded():
        found = {
            "six-bar (owl wing, AE drives)": list(_six_bar()),
            "parallelogram": list(
                _four_bar(four_bar(*PARALLELOGRAM), lambda t: (0.0, t), down, lambda t: 20.0 * math.cos(t))
            ),
            "folding kite": list(_four_bar(four_bar(*KITE), kite_angles, couple, kite_torque)),
        }
    made, (errors, condition, residual) = figure(3)
    rows = []
    for name, values in found.items():
        for side, style in ((1.0, "o-"), (-1.0, "x--")):
            own = [v for v in values if v[0] * side > 0.0]
            x = [abs(v[0]) for v in own]
            label = f"{name}, {'beyond' if side > 0.0 else 'before'}"
            errors.loglog(x, [max(v[2], 1e-17) for v in own], style, label=label)
            condition.loglog(x, [v[1].system.condition for v in own], style)
            residual.loglog(x, [max(v[1].residual, 1e-18) for v in own], style)
        kept = [v for v in values if v[1].system.singular_values[-1] >= NEARLY_SINGULAR]
        refused = [v for v in values if v[1].system.singular_values[-1] < NEARLY_SINGULAR]
        last = min(kept, key=lambda v: abs(v[0]))
        # What is left of the limit's own approach does not count as error of the six-bar.
        rows.append(
            (
                name,
                abs(last[0]),
                max(v[2] for v in kept if abs(v[0]) <= 0.01),
                max(v[2] for v in refused),
                last[1].system.condition,
                max(v[1].system.condition for v in refused),
                max(v[1].residual for v in values),
                1e6 * float(np.median([v[3] for v in values])),
            )
        )
    for axes, what in ((errors, "relative error of the drive torque"), (condition, "condition number (scaled)")):
        axes.set(xlabel="distance from the dead point [°]", ylabel=what)
        axes.invert_xaxis()
    residual.set(xlabel="distance from the dead point [°]", ylabel="equilibrium residual / load")
    residual.invert_xaxis()
    condition.axhline(1.0 / NEARLY_SINGULAR, color="k", lw=1, ls=":")
    condition.text(1.0, 1.3 / NEARLY_SINGULAR, "about here the pose is refused", fontsize=8)
    errors.legend(fontsize=7)
    head = (
        "linkage",
        "last accepted distance [°]",
        "largest error accepted, at 0.01° and below",
        "largest error refused",
        "condition at the last accepted",
        "condition at 1e-9°",
        "largest residual",
        "time [µs]",
    )
    return Row(table=table(head, rows), figure=made)


def near_grashof() -> Row:
    """Lengths 20, 50, 40, 70 + ε: class, dead points, and a motion across the change point."""
    gaps = [s * 10.0**-k for s in (1.0, -1.0) for k in range(2, 13, 2)] + [0.0]
    rows = []
    for gap in gaps:
        bar = FourBar(a=20.0, b=50.0, c=40.0, d=70.0 + gap * 180.0)
        kind = classify(a=bar.a, b=bar.b, c=bar.c, d=bar.d)
        dead = [180.0 - math.degrees(abs(p)) for p in bar.input_range().dead_points]
        (ending, error), seconds = timed(lambda b=bar: _through(b))
        rows.append((gap, kind.relation, kind.inversion, dead[0] if dead else "none", ending, error, 1e3 * seconds))
    rows.sort(key=lambda row: row[0])
    made, (axes,) = figure(1)
    for sign, marker in ((1.0, "o-"), (-1.0, "x--")):
        own = [row for row in rows if row[0] * sign > 0.0]
        axes.loglog(
            [abs(row[0]) for row in own],
            [max(row[5], 1e-17) for row in own],
            marker,
            label=f"shortest + longest {'above' if sign > 0 else 'below'} the others",
        )
    axes.axvline(1e-9, color="k", lw=1, ls=":")
    axes.set(xlabel="difference of the sums / perimeter", ylabel="largest error of the rocker's angle [rad]")
    axes.invert_xaxis()
    axes.legend(fontsize=8)
    head = (
        "(s + l - p - q)/perimeter",
        "sums",
        "class",
        "dead point before 180° [°]",
        "motion 90° to 270°",
        "error [rad]",
        "time [ms]",
    )
    return Row(table=table(head, rows), figure=made)


def _through(bar: FourBar) -> tuple[str, float]:
    """How a motion of the crank across 180° ends, and the largest error of the rocker's angle on its way."""
    linkage = four_bar(bar.a, bar.b, bar.c, bar.d)
    start = bar.position(math.pi / 2.0)
    near = {"coupler": float(start.theta3), "rocker": float(start.theta4)}
    pose = solve_pose(linkage, coordinate="crank", angle=math.pi / 2.0, near=near)
    end = 1.5 * math.pi
    try:
        solve_motion(pose, [end])
        said = "goes through"
    except DeadPointError as error:
        end = error.angle
        said = f"{'crossing' if 'cross' in str(error) else 'dead point'} at {math.degrees(end):.7g}°"
    span = end - math.pi / 2.0
    angles = (
        end - span * np.geomspace(1.0, 1e-6, 200) if said != "goes through" else np.linspace(math.pi / 2.0, end, 200)
    )
    motion = solve_motion(pose, angles)
    exact = np.ma.filled(bar.position(angles).theta4, np.nan)
    return said, float(np.nanmax(np.abs(np.angle(np.exp(1j * (motion.angle("rocker") - exact))))))


def synthesis() -> Row:
    """Three precision points closing in on each other: error of the lengths against condition number."""
    truth = FourBar(a=40.0, b=30.0, c=50.0, d=60.0)
    loop = truth.driven_by_coupler()
    rows = []
    for k in np.arange(0.0, 7.5, 0.5):
        spread = 10.0**-k
        theta = np.radians(70.0) + spread * np.array([-0.5, 0.0, 0.5])
        psi = np.asarray(loop.position(theta).theta4, dtype=float)
        try:
            found, seconds = timed(lambda t=theta, p=psi: synthesise(t, p, d=60.0), 3)
        except CaseError as error:
            rows.append((spread, _condition(theta, psi), "refused", str(error).split(":")[0], "-"))
            continue
        made = np.array([found.four_bar.a, found.four_bar.b, found.four_bar.c])
        # The loop's first two vectors may stand in either order.
        error = float(np.abs(made / np.array([truth.a, truth.b, truth.c]) - 1.0).max())
        warned = [f.sentence for f in found.findings if f.kind == "conditioning"]
        rows.append((spread, found.condition, error, "warns" if warned else "silent", 1e3 * seconds))
    made_figure, (axes,) = figure(1)
    kept = [row for row in rows if not isinstance(row[2], str)]
    axes.loglog([row[1] for row in kept], [max(row[2], 1e-17) for row in kept], "o-", label="error of the lengths")
    axes.loglog([row[1] for row in kept], [2.2e-16 * row[1] for row in kept], "k:", label="rounding × condition number")
    for at, what in ((1e6, "warned"), (1e12, "refused")):
        axes.axvline(at, color="r", lw=1, ls="--")
        axes.text(at / 4.0, 1e-13, what, rotation=90, color="r", fontsize=8)
    axes.set(xlabel="condition number", ylabel="relative error of the lengths")
    axes.legend(fontsize=8)
    head = ("spread of the points [rad]", "condition number", "error of the lengths", "the program", "time [ms]")
    return Row(table=table(head, rows), figure=made_figure)


def _condition(theta: np.ndarray, psi: np.ndarray) -> float:
    return float(np.linalg.cond(np.column_stack([np.cos(psi), -np.cos(theta), np.ones(3)])))
