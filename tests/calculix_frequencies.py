"""Natural frequencies of a link by CalculiX, on the same mesh and held in the same way: what our own are tried on.

Rigid bores are equations between their nodes and two nodes of their own, which have the displacement and the rotation
of ``alula.fea.vibration.rigid_regions`` as unknowns. CalculiX integrates the mass of quadratic tetrahedra at four
points, which is not exact: on coarse meshes its frequencies are up to 0.1 % off those of the exact mass.
"""

import re

import numpy as np

from alula.fea.calculix import program as calculix
from alula.fea.vibration.link_solid import conditions, regions
from alula.fea.vibration.rigid_regions import reduced
from alula.geometry.base.tidying import scratch_folder


def calculix_frequencies(solid, space, count):
    """Return the lowest natural frequencies [Hz] of a link that carries nothing, besides those of rigid motions."""
    assert not solid.carried
    free, whole = solid.holding.free, regions(solid, space)
    with scratch_folder("alula-calculix-") as scratch:
        path = scratch / "link.inp"
        reduction = reduced(space.nodes, whole)
        # Unknowns of the regions stand last in the reduction; in the deck they stand after those of the mesh.
        after = space.unknowns - (reduction.matrix.shape[1] - 6 * len(whole))
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
        with path.open("w", encoding="ascii") as deck:
            calculix.write_mesh(deck, space, "natural frequencies")
            first = len(space.nodes) + 1
            if whole:
                deck.write("*NODE, NSET=FURTHER\n")
                deck.writelines(f"{i}, 0., 0., 0.\n" for i in range(first, first + 2 * len(whole)))
            write_vibration(deck, solid.material, equations, reduction.held + after, count + free)
        dat, _ = calculix.run(path, scratch, threads=1, time_limit=600.0)
        return frequencies_of(dat.read_text(encoding="ascii"))[free:]


def write_vibration(deck, material, equations, supports, count):
    """Write sums of unknowns (3 node + component) times factors that are zero, the material, supports and the step."""
    for equation in equations:
        deck.write(f"*EQUATION\n{len(equation)}\n")
        terms = [f"{u // 3 + 1}, {u % 3 + 1}, {factor:.12e}" for u, factor in equation]
        deck.writelines(f"{', '.join(terms[i : i + 4])}\n" for i in range(0, len(terms), 4))
    deck.write(f"*MATERIAL, NAME=MATERIAL\n*ELASTIC\n{material.youngs_modulus:.12e}, {material.poissons_ratio:.12e}\n")
    deck.write(f"*DENSITY\n{material.density:.12e}\n*SOLID SECTION, ELSET=EALL, MATERIAL=MATERIAL\n")
    if len(supports):
        deck.write("*BOUNDARY\n")
        deck.writelines(f"{u // 3 + 1}, {u % 3 + 1}, {u % 3 + 1}\n" for u in supports.tolist())
    deck.write(f"*STEP\n*FREQUENCY\n{count}\n*NODE FILE\nU\n*END STEP\n")


def frequencies_of(printed):
    """Return the frequencies of a .dat file, rising; negative where the square is [Hz]."""
    # Number of the mode, square, radians per time, cycles per time, and their imaginary part for a negative square.
    number = r"\s+(-?\d\.\d+E[+-]\d+)"
    rest = printed.partition("E I G E N V A L U E   O U T P U T")[2]
    rows = re.findall(rf"^\s+\d+{number * 4}\s*$", rest.split("P A R T I C I P A T I O N")[0], flags=re.MULTILINE)
    squares = np.array([float(row[0]) for row in rows])
    return np.sign(squares) * np.sqrt(np.abs(squares)) / (2.0 * np.pi)
