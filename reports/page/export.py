"""VTU files of the solid models, for ParaView and its like (written by meshio)."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from alula.fea.solid.stress import COMPONENTS, StressField
from alula.geometry.base.errors import CannotRunError

PRINCIPAL = ("first", "second", "third")


def write_vtu(path: Path, displacement: NDArray[np.float64], stress: StressField) -> None:
    """Write displacement and stress of a solid as an unstructured grid of (quadratic) tetrahedra.

    Point data have their units in their names: displacement, von Mises stress, principal stresses, and components of
    the stress tensor. Coordinates are those of the undeformed link in its own frame [mm].

    Parameters
    ----------
    path : Path
        File to write.
    displacement : array
        (n, 3) at the nodes of ``stress.space`` [mm].
    stress : StressField

    Raises
    ------
    CannotRunError
        If the file cannot be written.
    """
    import meshio

    space = stress.space
    data = {
        "displacement [mm]": displacement,
        "von Mises stress [MPa]": stress.von_mises,
        **{f"{name} principal stress [MPa]": stress.principal[:, i] for i, name in enumerate(PRINCIPAL)},
        **{f"stress {name} [MPa]": stress.nodal[:, i] for i, name in enumerate(COMPONENTS)},
    }
    kind = "tetra" if space.order == 1 else "tetra10"
    # Single precision halves the file, and its seven digits are more than the model has.
    fields = {name: np.ascontiguousarray(values, dtype=np.float32) for name, values in data.items()}
    mesh = meshio.Mesh(space.nodes, [(kind, space.cells)], point_data=fields)
    try:
        mesh.write(path, file_format="vtu")
    except OSError as error:
        raise CannotRunError(f"'{path}' cannot be written ({error.strerror}); choose another folder") from None
