"""Whether the wall of a thin tube may buckle before its material yields."""

import math
from collections.abc import Iterator

from alula.fea.common.reason import reason
from alula.geometry.parts.tube import Tube
from alula.loads.case.case import Case
from alula.loads.text.caveat import Caveat, Topic


def wall_stress(radius: float, thickness: float, modulus: float) -> float:
    """Return the compressive stress at which the wall of a round tube may buckle.

    A long cylinder under axial compression, knocked down for imperfections; bending lets a wall bear somewhat more.

    Parameters
    ----------
    radius, thickness : float
        Of the wall's middle, and of the wall [mm].
    modulus : float
        Young's modulus [MPa].

    Returns
    -------
    float
        [MPa]

    References
    ----------
    NASA SP-8007, Buckling of thin-walled circular cylinders (1968): 0.6 γ E t/R with γ = 1 - 0.901 (1 - e^-φ),
    φ = √(R/t)/16; as handbooks quote it, unchecked.
    """
    knock_down = 1.0 - 0.901 * (1.0 - math.exp(-math.sqrt(radius / thickness) / 16.0))
    return 0.6 * knock_down * modulus * thickness / radius


def wall_caveats(case: Case) -> Iterator[Caveat]:
    """Yield the tubes whose wall may buckle below the strength of their material, which no check looks at.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    thin = []
    for link in case.checked_links:
        part, material = case.part_of(link), case.material_of(link)
        if isinstance(part, Tube) and part.inner_diameter > 0.0:
            wall = (part.outer_diameter - part.inner_diameter) / 2.0
            if wall_stress(part.outer_diameter / 2.0 - wall / 2.0, wall, material.youngs_modulus) < material.allowable:
                thin.append(link)
    if thin:
        yield Caveat(
            topic=Topic.BUCKLING,
            what=reason("buckling_of_walls", links=thin),
            why=reason("thin_wall"),
        )
