"""A second opinion on every link: CalculiX on the same mesh, material, supports and nodal loads."""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from alula.fea.calculix import program as calculix
from alula.fea.elements.elasticity import assemble_stiffness, reference_basis
from alula.fea.elements.space import DisplacementSpace
from alula.fea.elements.supports import isostatic_supports, rigid_motions
from alula.fea.outcomes.opinion import Answer, SecondOpinion
from alula.fea.outcomes.result import CheckResult, SolidResult
from alula.fea.solid.solution import SolidCase, SolidSolution
from alula.fea.solid.stress import StressField, von_mises
from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.tidying import scratch_folder

TIME_LIMIT = 900.0
"""Seconds that CalculiX may take for one link."""


def second_opinions(
    result: CheckResult,
    folder: Path,
    *,
    threads: int = 2,
    time_limit: float = TIME_LIMIT,
    progress: Callable[[str], None] = lambda message: None,
) -> tuple[SecondOpinion, ...]:
    """Write ``<link>.inp`` of every link with a solid model into ``folder`` and let CalculiX solve it, if installed.

    Each link stands under the load case whose safety factor's band reaches lowest, with the variant that governs.

    Parameters
    ----------
    result : CheckResult
        Of the check, with its solid models.
    folder : Path
        Where the decks are written.
    threads : int, optional
        That CalculiX may use.
    time_limit : float, optional
        For one link [s].
    progress : callable, optional
        Called with a sentence before each step.

    Returns
    -------
    tuple of SecondOpinion
        One per link with a solid model.
    """
    found = []
    for link in next(iter(result.load_cases.values())).links:
        worst = min(result.load_cases.values(), key=lambda case: case.links[link].severity)
        ours = worst.links[link]
        if not isinstance(ours, SolidResult):
            continue
        progress(f"Asking CalculiX about {link}: {ours.elements} elements ...")
        answer, reason = None, ""
        deck = folder / f"{link}.inp"
        title = f"{link}, load case {worst.name}, {ours.governing.title.replace('°', ' degrees')}; mm, N, MPa"
        write_model(deck, ours.solution, ours.governing_case, title)
        try:
            answer = ask(deck, ours.governing_case.displacement, ours.stress, threads=threads, time_limit=time_limit)
        except CannotRunError as error:
            reason = str(error)
        found.append(
            SecondOpinion(
                link=link,
                load_case=worst.name,
                variant=ours.governing.title,
                deck=deck.name,
                von_mises=ours.stress.peak_at_points.value,
                von_mises_nodal=ours.stress.peak.value,
                displacement=ours.governing_case.displacement_max,
                known=not ours.safety_factor.unknowable,
                answer=answer,
                reason=reason,
            )
        )
    return tuple(found)


def write_model(path: Path, solid: SolidSolution, case: SolidCase, title: str) -> None:
    """Write the deck of one load case of a link.

    The nodal loads are K u: the consistent loads that u was solved for, less what rounding leaves of it. They balance,
    so any 3-2-1 support serves; it is the one of our own solution.

    Parameters
    ----------
    path : Path
        File to be written.
    solid : SolidSolution
        Solution of the link.
    case : SolidCase
        The load case and variant to be written.
    title : str
        First line of the deck, for people.
    """
    space = solid.space
    K = assemble_stiffness(space, E=solid.E, nu=solid.nu)
    loads = (K @ case.displacement.ravel()).reshape(-1, 3)
    # A node without load keeps the rounding of its row: some 1e-16 of the stiffness times the displacement.
    rounding = 1e-13 * np.abs(K.diagonal).max(axis=(1, 2)) * np.abs(case.displacement).max()
    loads[(np.abs(loads) <= rounding[:, None]).all(axis=1)] = 0.0
    supports = isostatic_supports(space.nodes, space.corners)
    calculix.write_deck(path, space, E=solid.E, nu=solid.nu, loads=loads, supports=supports, title=title)


def ask(
    deck: Path, displacement: NDArray[np.float64], stress: StressField, *, threads: int, time_limit: float
) -> Answer:
    """Let CalculiX solve a deck and compare its fields with our displacement (n, 3) and stress.

    Parameters
    ----------
    deck : Path
        The input file.
    displacement : ndarray, shape (n, 3)
        Our displacements [mm].
    stress : StressField
        Our stress.
    threads : int
        That CalculiX may use.
    time_limit : float
        Seconds.

    Returns
    -------
    Answer
        CalculiX's largest values, and how far they lie from ours.

    Raises
    ------
    CannotRunError
        Where it does not answer.
    """
    space = stress.space
    count = stress.at_points.shape[1]
    with scratch_folder("alula-calculix-") as scratch:
        started = time.perf_counter()
        dat, frd = calculix.run(deck, scratch, threads=threads, time_limit=time_limit)
        seconds = time.perf_counter() - started
        u, s = calculix.read_dat(dat, nodes=len(space.nodes), elements=len(space.cells), points=count)
        nodal = calculix.read_frd_stress(frd)
    theirs = _aligned(u, displacement, space)
    scale = np.linalg.norm(displacement, axis=1).max()
    ours = von_mises(stress.at_points)
    gap = von_mises(s[:, _places(space)]) - ours
    return Answer(
        von_mises=float(von_mises(s).max()),
        von_mises_nodal=float(von_mises(nodal).max()),
        displacement=float(np.linalg.norm(theirs, axis=1).max()),
        stress_gap=float(np.abs(gap).max() / ours.max()),
        displacement_gap=float(np.linalg.norm(theirs - displacement, axis=1).max() / scale),
        seconds=seconds,
    )


def _places(space: DisplacementSpace) -> NDArray[np.int64]:
    """Number in CalculiX's order of each of our integration points."""
    ours = reference_basis(space, space.order)[0].T
    theirs = calculix.POINTS[space.order - 1]
    return np.asarray(np.argmin(np.linalg.norm(ours[:, None] - theirs[None], axis=2), axis=1))


def _aligned(
    field: NDArray[np.float64], reference: NDArray[np.float64], space: DisplacementSpace
) -> NDArray[np.float64]:
    """Return the field (n, 3) with the rigid motion added that brings it nearest to the reference."""
    motions = rigid_motions(space.nodes, space.nodes.mean(axis=0)).reshape(6, -1)
    motions[3:] /= np.ptp(space.nodes, axis=0).max()
    amount = np.linalg.solve(motions @ motions.T, motions @ (reference - field).ravel())
    return np.asarray(field + (amount @ motions).reshape(-1, 3))
