"""Natural frequencies of a link by CalculiX, on the same mesh and held in the same way.

Rigid bores are equations between their nodes and two nodes of their own, which have the displacement and the rotation
of ``alula.fea.vibration.rigid_regions`` as unknowns. CalculiX integrates the mass of quadratic tetrahedra at four
points, which is not exact: on coarse meshes its frequencies are up to 0.1 % off those of the exact mass.
"""

import numpy as np
from numpy.typing import NDArray

from alula.fea.calculix import program as calculix
from alula.fea.elements.space import DisplacementSpace
from alula.fea.vibration.link_solid import LinkSolid, conditions, regions
from alula.fea.vibration.rigid_regions import reduced
from alula.geometry.base.errors import CannotRunError
from alula.geometry.base.tidying import scratch_folder


def calculix_frequencies(
    solid: LinkSolid, space: DisplacementSpace, count: int, *, threads: int = 1, time_limit: float = 600.0
) -> NDArray[np.float64]:
    """Let CalculiX find the lowest natural frequencies of a link that carries nothing.

    Parameters
    ----------
    solid : LinkSolid
    space : DisplacementSpace
        Of its mesh.
    count : int
        How many, besides those of rigid motions.
    threads : int, optional
        That CalculiX may use.
    time_limit : float, optional
        [s]

    Returns
    -------
    ndarray, shape (count,)
        Rising [Hz].

    Raises
    ------
    CannotRunError
        Where CalculiX does not answer, or the link carries masses.
    """
    if solid.carried:
        raise CannotRunError("CalculiX is asked for links alone, without what they carry")
    free, whole = solid.holding.free, regions(solid, space)
    with scratch_folder("alula-calculix-") as scratch:
        deck = scratch / "link.inp"
        reduction = reduced(space.nodes, whole)
        inner = space.unknowns
        # Unknowns of the regions stand last in the reduction; in the deck they stand after those of the mesh.
        after = inner - (reduction.matrix.shape[1] - 6 * len(whole))
        equations = []
        for region in whole:
            for row in (3 * region.nodes[:, None] + np.arange(3)).ravel():
                start, stop = reduction.matrix.indptr[row : row + 2]
                terms = zip(reduction.matrix.indices[start:stop], reduction.matrix.data[start:stop], strict=True)
                equations.append([(int(row), 1.0), *((int(u) + after, -float(x)) for u, x in terms if x != 0.0)])
        for condition in conditions(solid, space):
            unknowns = np.flatnonzero(np.abs(condition) > 1e-12)
            unknowns = unknowns[np.argsort(-np.abs(condition[unknowns]))]
            equations.append([(int(u), float(condition[u])) for u in unknowns])
        calculix.write_frequency_deck(
            deck,
            space,
            E=solid.material.youngs_modulus,
            nu=solid.material.poissons_ratio,
            density=solid.material.density,
            equations=equations,
            further=2 * len(whole),
            supports=reduction.held + after,
            count=count + free,
            title="natural frequencies",
        )
        dat, _ = calculix.run(deck, scratch, threads=threads, time_limit=time_limit)
        return calculix.read_frequencies(dat)[free:]
