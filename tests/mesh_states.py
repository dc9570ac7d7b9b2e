"""What meshes of a link may leave open, for the tests of reports."""

import numpy as np

from alula.fea.refine.convergence import grid_convergence
from alula.fea.refine.discretisation import Discretisation
from alula.fea.refine.refinement import MeshRecord
from alula.fea.refine.singular import SharpPeak

SERIES = grid_convergence([1.0], [5.0], estimate=0.1)


def state(status, screening=None):
    """A discretisation of whatever status, with a sharp edge where the stress beside it is given."""
    sharp = None
    if screening is not None:
        sharp = SharpPeak(
            place=np.zeros(3), angle=4.7, growth=0.4, theory=0.46, distance=1.0, screening=screening, resolved=True
        )
    return Discretisation(
        status=status, accuracy=0.05, stress=SERIES, displacement=SERIES, sharp=sharp, stopped="it may not go on",
        meshes=(MeshRecord(elements=100, unknowns=300, error=0.53, seconds=1.0),),
    )  # fmt: skip
