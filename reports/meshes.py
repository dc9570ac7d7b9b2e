"""What the meshes of a link did to its numbers, as plain data."""

from typing import Any

from fea.convergence import GridConvergence
from fea.discretisation import Discretisation

UNITS = {
    "links.*.discretisation.stress.sizes": "mm",
    "links.*.discretisation.stress.values": "MPa",
    "links.*.discretisation.displacement.sizes": "mm",
    "links.*.discretisation.displacement.values": "mm",
    "links.*.discretisation.meshes.*.seconds": "s",
    "links.*.discretisation.sharp.place": "mm",
    "links.*.discretisation.sharp.distance": "mm",
    "links.*.discretisation.sharp.screening": "MPa",
}


def discretisation_record(found: Discretisation | None) -> dict[str, Any] | None:
    """Return the state of convergence of a link; None where no solid ran."""
    if found is None:
        return None
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


def _series(series: GridConvergence) -> dict[str, Any]:
    return {
        "sizes": list(series.sizes),
        "values": list(series.values),
        "order": series.order,
        "kind": series.kind,
        "factor": series.factor,
        "index": series.index,
    }
