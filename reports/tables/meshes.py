"""Meshes and solver of a link, as plain data and in words."""

from typing import Any

from alula.fea.motion.envelope_result import LinkEnvelope
from alula.fea.refine.discretisation import Discretisation
from alula.fea.solid.solution import SolidSolution
from alula.reports.sentences import told
from alula.reports.tables.data import entries

LEAST_TOLD = 1e-9
"""Solver error below which its size is not stated."""
_SERIES = "sizes values order kind factor index"


def discretisation_record(found: Discretisation) -> dict[str, Any]:
    """Return the convergence of a link over its meshes as plain data.

    Parameters
    ----------
    found : Discretisation

    Returns
    -------
    dict
    """
    return entries(found, "status accuracy") | {
        "sentence": told(found.reason),
        "stress": entries(found.stress, _SERIES),
        "displacement": entries(found.displacement, _SERIES),
        "meshes": [entries(mesh, "elements unknowns error seconds") for mesh in found.meshes],
        "sharp": found.sharp and entries(found.sharp, "place growth theory distance screening"),
    }


def solver_record(answer: SolidSolution | LinkEnvelope) -> dict[str, Any]:
    """Return the solver of a link's displacements, the reason for its choice and its error.

    Parameters
    ----------
    answer : SolidSolution or LinkEnvelope

    Returns
    -------
    dict
    """
    return entries(answer, "solver solver_reason solver_error")


def solver_sentence(answer: SolidSolution) -> str:
    """Return solver, reason and error in words.

    Parameters
    ----------
    answer : SolidSolution

    Returns
    -------
    str
    """
    error = max(answer.solver_error, LEAST_TOLD)
    return f"Solved by {answer.solver} ({told(answer.solver_reason)}), relative error below {error:.0e}"
