"""What the meshes of a link did to its numbers, as plain data."""

from typing import Any

from fea.motion.envelope_result import LinkEnvelope
from fea.refine.convergence import GridConvergence
from fea.refine.discretisation import Discretisation
from fea.solid.solution import SolidSolution

LEAST_TOLD = 1e-9
"""Error of a solver below which its size says nothing to anybody."""
UNITS = {
    "links.*.discretisation.accuracy": "1",
    "links.*.discretisation.stress": "1",
    "links.*.discretisation.displacement": "1",
    "links.*.discretisation.meshes": "1",
    "links.*.discretisation.stress.sizes": "mm",
    "links.*.discretisation.stress.values": "MPa",
    "links.*.discretisation.displacement.sizes": "mm",
    "links.*.discretisation.displacement.values": "mm",
    "links.*.discretisation.meshes.*.seconds": "s",
    "links.*.discretisation.sharp.place": "mm",
    "links.*.discretisation.sharp.distance": "mm",
    "links.*.discretisation.sharp.screening": "MPa",
    "links.*.solver_error": "share of the solution, in the energy norm",
}


def discretisation_record(found: Discretisation) -> dict[str, Any]:
    """Return the state of convergence of a link."""
    sharp = found.sharp
    return {
        "status": found.status,
        "accuracy": found.accuracy,
        "stress": _series(found.stress),
        "displacement": _series(found.displacement),
        "meshes": [
            {"elements": mesh.elements, "unknowns": mesh.unknowns, "error": mesh.error, "seconds": mesh.seconds}
            for mesh in found.meshes
        ],
        "sharp": None
        if sharp is None
        else {
            "place": [float(x) for x in sharp.place],
            "growth": sharp.growth,
            "theory": sharp.theory,
            "distance": sharp.distance,
            "screening": sharp.screening,
        },
        "sentence": found.sentence,
    }


def solver_record(answer: SolidSolution | LinkEnvelope) -> dict[str, Any]:
    """Return which solver gave a link's displacements, why it was chosen and the error it left."""
    return {"solver": answer.solver, "solver_reason": answer.solver_reason, "solver_error": answer.solver_error}


def solver_sentence(answer: SolidSolution) -> str:
    """Return the same for people."""
    error = max(answer.solver_error, LEAST_TOLD)
    return f"Solved by {answer.solver} ({answer.solver_reason}), with a relative error below {error:.0e}"


def _series(series: GridConvergence) -> dict[str, Any]:
    return {
        "sizes": list(series.sizes),
        "values": list(series.values),
        "order": series.order,
        "kind": series.kind,
        "factor": series.factor,
        "index": series.index,
    }
