"""What the wall of a round tube bears before it buckles or flattens (``docs/theory/walls.md``).

R is the radius of the wall's middle and t its thickness. Stresses are those of the plain section.
"""

import math
from collections.abc import Iterator

from alula.fea.asked.asked import asked_of
from alula.fea.common.reason import reason
from alula.geometry.parts.tube import Tube
from alula.loads.case.case import Case
from alula.loads.records.check_spec import WallCheck
from alula.loads.text.caveat import Caveat, Topic

COMPRESSION, BENDING = 0.901, 0.731
"""Largest shares that imperfections take off the stress of a perfect cylinder (NASA SP-8007)."""
DUCTILE = 0.115
"""Yield strength over ``REPRESENTATIVE`` E t/R up to which a wall yields without buckling: ISO 19902 has D/t of at most
0.069 E/f_y for ductile tubes."""
REPRESENTATIVE = 0.3
"""Elastic stress of a real wall over E t/R (ISO 19902)."""
ELASTIC = 1.911
"""Yield strength over the elastic stress of a real wall from which on yielding takes off nothing: where both meet."""


def perfect_stress(radius: float, thickness: float, modulus: float, poisson: float) -> float:
    """Return the stress at which the wall of a perfect long cylinder buckles, in compression or at its bent side.

    Parameters
    ----------
    radius, thickness : float
        [mm]
    modulus, poisson : float
        Young's modulus [MPa] and Poisson's ratio.

    Returns
    -------
    float
        [MPa]

    References
    ----------
    E t/(R √(3 (1 - ν²))): Timoshenko & Gere, Theory of Elastic Stability, 2nd ed., section 11.1.
    """
    return modulus * thickness / radius / math.sqrt(3.0 * (1.0 - poisson**2))


def knock_down(radius: float, thickness: float, most: float) -> float:
    """Return what imperfections leave of the stress of a perfect cylinder, a curve below nearly all tests.

    Parameters
    ----------
    radius, thickness : float
        [mm]
    most : float
        ``COMPRESSION`` or ``BENDING``.

    Returns
    -------
    float

    References
    ----------
    NASA SP-8007, Buckling of Thin-Walled Circular Cylinders (1968): γ = 1 - most (1 - e^-φ) with φ = √(R/t)/16.
    """
    return 1.0 - most * (1.0 - math.exp(-math.sqrt(radius / thickness) / 16.0))


def flattening_moment(radius: float, thickness: float, modulus: float, poisson: float) -> float:
    """Return the largest moment of a long tube whose section flattens as it bends.

    Parameters
    ----------
    radius, thickness : float
        [mm]
    modulus, poisson : float
        Young's modulus [MPa] and Poisson's ratio.

    Returns
    -------
    float
        [N·mm]

    References
    ----------
    Brazier (1927); derived in ``docs/theory/walls.md``.
    """
    return 2.0 * math.sqrt(2.0) / 9.0 * math.pi * modulus * radius * thickness**2 / math.sqrt(1.0 - poisson**2)


def elastic_stress(radius: float, thickness: float, modulus: float) -> float:
    """Return the stress at which a real wall buckles elastically.

    Parameters
    ----------
    radius, thickness : float
        [mm]
    modulus : float
        Young's modulus [MPa].

    Returns
    -------
    float
        [MPa]

    References
    ----------
    ISO 19902:2020, section 13.2: f_xe.
    """
    return REPRESENTATIVE * modulus * thickness / radius


def yielding_stress(radius: float, thickness: float, modulus: float, strength: float) -> float:
    """Return the stress at which a ductile wall buckles by ISO; infinite where it turns plastically without buckling.

    Parameters
    ----------
    radius, thickness : float
        [mm]
    modulus, strength : float
        Young's modulus and yield strength [MPa].

    Returns
    -------
    float
        [MPa]

    References
    ----------
    ISO 19902:2020, equations 13.2-8 and 13.2-9 and section 11.4.
    """
    elastic = elastic_stress(radius, thickness, modulus)
    share = strength / elastic
    if share <= DUCTILE:
        return math.inf
    return elastic if share >= ELASTIC else min(elastic, strength * min(1.0, 1.047 - 0.274 * share))


def least_yielding_stress(radius: float, thickness: float, modulus: float, ends: tuple[float, float]) -> float:
    """Return the least stress of ``yielding_stress`` for a strength between two ends, one of which may be ductile.

    Beyond ductile walls it rises with strength and modulus: the least is at the least of both.

    Parameters
    ----------
    radius, thickness : float
        [mm]
    modulus : float
        The least Young's modulus [MPa].
    ends : tuple of 2 float
        Least and largest yield strength [MPa].

    Returns
    -------
    float
        [MPa]
    """
    least = max(ends[0], DUCTILE * (1.0 + 1e-9) * elastic_stress(radius, thickness, modulus))
    return yielding_stress(radius, thickness, modulus, least) if least <= ends[1] else math.inf


def wall_of(case: Case, link: str) -> tuple[float, float] | None:
    """Return the radius of the middle of a tube's wall, and its thickness.

    Parameters
    ----------
    case : Case
    link : str

    Returns
    -------
    tuple of 2 float or None
        [mm]; None of what is no hollow tube.
    """
    part = case.part_of(link)
    if not isinstance(part, Tube) or part.inner_diameter == 0.0:
        return None
    return (part.outer_diameter + part.inner_diameter) / 4.0, (part.outer_diameter - part.inner_diameter) / 2.0


def wall_caveats(case: Case) -> Iterator[Caveat]:
    """Yield the tubes whose wall may buckle below the strength of their material, where no check asks for it.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    thin = []
    for link in case.checked_links:
        if (wall := wall_of(case, link)) and link not in asked_of(case, WallCheck):
            material = case.material_of(link)
            stress = perfect_stress(*wall, material.youngs_modulus, material.poissons_ratio)
            if stress * knock_down(*wall, COMPRESSION) < material.allowable:
                thin.append(link)
    if thin:
        yield Caveat(topic=Topic.BUCKLING, what=reason("buckling_of_walls", links=thin), why=reason("thin_wall"))
