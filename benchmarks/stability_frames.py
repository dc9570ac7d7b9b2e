"""Rows on frames: mixed stiffness, and buckling."""

from dataclasses import replace

import numpy as np
from scipy.sparse.linalg import splu

from alula.fea.beam.column_factor import AxialForce, column_factors
from alula.fea.elements.elasticity import assemble_stiffness
from alula.fea.elements.space import displacement_space
from alula.fea.elements.supports import isostatic_supports
from alula.fea.frame.linear import FrameSolution, solve_frame
from alula.fea.frame.model import ALL_DOFS, FrameElement, FrameModel, NodeLoad, Support
from alula.fea.nonlinear.stability import buckling_factor
from alula.geometry.parts.part import Section
from benchmarks.stability_report import Row, figure, table, timed
from benchmarks.stability_solids import box

SECTION = Section(area=8.0, i_y=2.0, i_z=3.0, torsion=4.0, half_y=1.0, half_z=1.0, round=False)
YOUNG, LENGTH = 2900.0, 100.0
RATIOS = tuple(10.0**k for k in range(-6, 7, 2))


def stepped(ratio: float) -> tuple[FrameSolution, float, float]:
    """Bar built in at both ends, its second half ``ratio`` times as stiff, under a unit force across and along.

    Returns the solution and the errors of deflection and reaction against the closed form.
    """
    force = np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
    elements = tuple(
        FrameElement(nodes=(i, i + 1), section=SECTION, young=young, poisson=0.38)
        for i, young in enumerate((YOUNG, YOUNG * ratio))
    )
    found = solve_frame(
        FrameModel(
            nodes=np.array([[0.0, 0.0, 0.0], [LENGTH, 0.0, 0.0], [2.0 * LENGTH, 0.0, 0.0]]),
            elements=elements,
            supports=(Support(node=0), Support(node=2)),
            loads=(NodeLoad(node=1, wrench=force),),
        )
    )
    # Two Timoshenko beams side by side at the middle: forces add over common displacement and rotation.
    kappa = SECTION.shear_coefficient(0.38) * SECTION.area / (2.0 * 1.38)
    total = np.zeros((2, 2))
    for sign, stiff in ((1.0, YOUNG), (-1.0, YOUNG * ratio)):
        ei, phi = stiff * SECTION.i_z, 12.0 * SECTION.i_z / (kappa * LENGTH**2)
        total += (
            ei
            / (LENGTH**3 * (1.0 + phi))
            * np.array([[12.0, -6.0 * sign * LENGTH], [-6.0 * sign * LENGTH, (4.0 + phi) * LENGTH**2]])
        )
    deflection = float(np.linalg.solve(total, np.array([1.0, 0.0]))[0])
    axial = 1.0 / (1.0 + ratio)
    return (
        found,
        abs(found.displacements[1, 1] / deflection - 1.0),
        abs(-found.reactions[0, 0] / axial - 1.0),
    )


def bonded(ratio: float) -> tuple[float, float]:
    """Bar of two materials bonded along its length, stretched evenly, ν = 0: errors of displacement and residual.

    Both halves take the same strain, so the exact field is linear whatever the ratio.
    """
    mesh = box((0.0, 0.0, 0.0), (10.0, 2.0, 1.0), (10, 4, 2))
    space = displacement_space(mesh)
    middle = space.nodes[space.cells[:, :4]].mean(axis=1)
    upper = middle[:, 1] > 1.0
    whole = assemble_stiffness(space, E=YOUNG, nu=0.0).full().tocsr()
    half = assemble_stiffness(replace(space, cells=space.cells[upper], curved=space.curved[upper]), E=YOUNG, nu=0.0)
    K = whole + (ratio - 1.0) * half.full().tocsr()
    strain = np.zeros_like(space.nodes)
    strain[:, 0] = 1e-3 * (space.nodes[:, 0] - 5.0)
    load = K @ strain.ravel()
    fixed = isostatic_supports(space.nodes, space.corners)
    free = np.setdiff1d(np.arange(K.shape[0]), fixed)
    exact = strain.ravel()
    found = exact.copy()
    factors = splu(K[free][:, free].tocsc())
    right = load[free] - K[free][:, fixed] @ exact[fixed]
    found[free] = factors.solve(right)
    residual = float(np.abs(K[free][:, free] @ found[free] - right).max() / np.abs(right).max())
    return float(np.abs(found - exact).max() / np.abs(exact).max()), residual


def mixed_stiffness() -> Row:
    """Frames and a bonded bar of two materials."""
    rows = []
    for ratio in RATIOS:
        (found, deflection, reaction), seconds = timed(lambda r=ratio: stepped(r), 3)
        bar, residual = bonded(ratio)
        rows.append((ratio, deflection, reaction, found.residual, found.condition, bar, residual, 1e3 * seconds))
    made, (axes,) = figure(1)
    x = [row[0] for row in rows]
    for column, label in (
        (1, "frame: deflection"),
        (2, "frame: reaction"),
        (3, "frame: residual"),
        (5, "bonded bar: displacement"),
    ):
        axes.loglog(x, [max(row[column], 1e-18) for row in rows], "o-", label=label)
    axes.set(xlabel="ratio of moduli", ylabel="relative error, residual / load")
    axes.legend(fontsize=8)
    head = (
        "ratio", "frame: deflection", "frame: axial reaction", "frame: residual", "frame: condition",
        "bonded bar: displacement", "bonded bar: residual", "frame [ms]",
    )  # fmt: skip
    return Row(table=table(head, rows), figure=made)


def frame_column(stations: list[float], pins: tuple[int, ...], built_in: bool = False) -> float:
    """Critical load [N] in the plane by the frame's stability, pushed at the last station."""
    plane = frozenset({"uz", "rx", "ry"})
    held = [Support(node=i, dofs=plane) for i in range(len(stations)) if i not in pins]
    held += [Support(node=i, dofs=plane | {"uy"} | ({"ux"} if i == 0 else set())) for i in pins]
    if built_in:
        held = [Support(node=0, dofs=ALL_DOFS), *held[:-1]]
    return buckling_factor(
        FrameModel(
            nodes=np.array([[x, 0.0, 0.0] for x in stations]),
            elements=tuple(
                FrameElement(nodes=(i, i + 1), section=SECTION, young=YOUNG, poisson=0.0)
                for i in range(len(stations) - 1)
            ),
            supports=tuple(held),
            loads=(NodeLoad(node=len(stations) - 1, wrench=np.array([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0])),),
        )
    )


def buckling() -> Row:
    """The check's column and its bounds beside the frame's stability, over the overhang."""
    rows, stiffness, ends = [], YOUNG * SECTION.i_z, (0.0, LENGTH)
    for share in (0.0, 0.01, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0):
        over = share * LENGTH
        stations = [0.0, LENGTH] + ([LENGTH + over] if share else [])
        exact, seconds = timed(lambda s=stations: frame_column(s, (0, 1)))
        force = AxialForce(breaks=np.array([0.0, LENGTH + over]), values=np.ones((1, 3, 1)))
        value, own = timed(lambda f=force: float(column_factors(f, stiffness, held=ends)[0]))
        kept = float(column_factors(force, stiffness, built_in=ends)[0])
        euler = np.pi**2 * stiffness / (2.0 * (LENGTH + over)) ** 2
        rows.append((f"{share:g}", euler, value, kept, exact, value / exact, 1e3 * own, 1e3 * seconds))
    made, (axes,) = figure(1)
    named = ("built in and free, whole length", "check: pins let it turn", "check: pins keep its angle", "frame")
    for i, (label, style) in enumerate(zip(named, (":", "x--", "-.", "o-"), strict=True), 1):
        axes.plot([float(row[0]) for row in rows], [row[i] for row in rows], style, label=label)
    axes.set(xlabel="overhang / distance of the pins", ylabel="critical load [N]", yscale="log")
    axes.legend(fontsize=8)
    head = (
        "overhang / span",
        "built in and free [N]",
        "check [N]",
        "pins keep its angle [N]",
        "frame [N]",
        "check / frame",
        "check [ms]",
        "frame [ms]",
    )
    return Row(table=table(head, rows), figure=made)
