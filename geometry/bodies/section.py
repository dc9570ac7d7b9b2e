"""Cross-sections in closed form: areas, second moments, torsion and shear."""

import math
from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class Section:
    """A cross-section normal to x, symmetric about y and z.

    Attributes
    ----------
    area : float
        A [mm²].
    i_y : float
        Second moment about y, for bending out of the linkage's plane [mm⁴].
    i_z : float
        Second moment about z, for bending in the linkage's plane [mm⁴].
    torsion : float
        Torsion constant J [mm⁴].
    half_y, half_z : float
        Distance of the extreme fibre from the axis along y and z [mm].
    round : bool
        Whether it is a circular tube or rod, else a rectangle.
    radius_ratio : float
        Inner over outer radius of a tube.
    """

    area: float
    i_y: float
    i_z: float
    torsion: float
    half_y: float
    half_z: float
    round: bool
    radius_ratio: float = 0.0

    @property
    def width(self) -> float:
        """Size along y, in the linkage's plane [mm]."""
        return 2.0 * self.half_y

    @property
    def height(self) -> float:
        """Size along z, along the pins [mm]."""
        return 2.0 * self.half_z

    def across(self, along: Literal["y", "z"]) -> float:
        """Return the size of the section across a hole.

        Parameters
        ----------
        along : {"y", "z"}
            Direction of the hole's axis.

        Returns
        -------
        float
            The size along the other axis [mm].
        """
        return self.width if along == "z" else self.height

    def shear_coefficient(self, nu: float) -> float:
        """Return Timoshenko's shear coefficient.

        Hollow circle: 6(1+ν)(1+m²)² / [(7+6ν)(1+m²)² + (20+12ν)m²]; rectangle: 10(1+ν)/(12+11ν).

        Parameters
        ----------
        nu : float
            Poisson's ratio.

        Returns
        -------
        float
            The coefficient.

        References
        ----------
        Cowper, J. Appl. Mech. 33 (1966) 335-340, table 1.
        """
        if not self.round:
            return 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
        m2 = self.radius_ratio**2
        return 6.0 * (1.0 + nu) * (1.0 + m2) ** 2 / ((7.0 + 6.0 * nu) * (1.0 + m2) ** 2 + (20.0 + 12.0 * nu) * m2)


def ring(outer_diameter: float, inner_diameter: float) -> Section:
    """Return the section of a circular tube.

    Parameters
    ----------
    outer_diameter, inner_diameter : float
        Diameters [mm]; an inner one of 0 is that of a rod.

    Returns
    -------
    Section
        The section.

    References
    ----------
    Roark's Formulas for Stress and Strain, 8th ed., table A.1, case 16.
    """
    outer, inner = outer_diameter / 2.0, inner_diameter / 2.0
    second = math.pi / 4.0 * (outer**4 - inner**4)
    return Section(
        area=math.pi * (outer**2 - inner**2),
        i_y=second,
        i_z=second,
        torsion=2.0 * second,
        half_y=outer,
        half_z=outer,
        round=True,
        radius_ratio=inner / outer,
    )


def rectangle(width: float, thickness: float) -> Section:
    """Return the section of a rectangle.

    J = a b³ (16/3) (1 - 192/π⁵ b/a Σ tanh(nπa/2b)/n⁵), n odd, of half-sides a >= b, with Σ 1/n⁵ = 1.0045237628 taken
    out of the sum.

    Parameters
    ----------
    width, thickness : float
        Sides along y, in the linkage's plane, and along z [mm].

    Returns
    -------
    Section
        The section.

    References
    ----------
    Timoshenko & Goodier, Theory of Elasticity, 3rd ed., section 109.
    """
    a, b = max(width, thickness) / 2.0, min(width, thickness) / 2.0
    series = 1.0045237627951 - sum(2.0 / (math.exp(min(n * math.pi * a / b, 700.0)) + 1.0) / n**5 for n in (1, 3, 5))
    return Section(
        area=width * thickness,
        i_y=width * thickness**3 / 12.0,
        i_z=thickness * width**3 / 12.0,
        torsion=16.0 / 3.0 * a * b**3 * (1.0 - 192.0 / math.pi**5 * b / a * series),
        half_y=width / 2.0,
        half_z=thickness / 2.0,
        round=False,
    )
