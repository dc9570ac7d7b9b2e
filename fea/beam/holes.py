"""Handbook stresses at eyes and cross holes, for the hand calculations; a solid model is more accurate.

Loads in N and N·mm, lengths in mm, stresses in MPa.
"""

from alula.geometry.base.errors import CannotRunError


def net_tension(force: float, eye_diameter: float, hole_diameter: float, thickness: float) -> float:
    """Return the mean tension F/((D - d) t) in the section through the hole of an eye that its pin pulls.

    Parameters
    ----------
    force : float
        Of the pin [N].
    eye_diameter : float
        Width D of the eye [mm].
    hole_diameter : float
        d [mm].
    thickness : float
        t [mm].

    Returns
    -------
    float
        Mean stress [MPa].

    Raises
    ------
    CannotRunError
        Where the hole leaves no section.

    References
    ----------
    Budynas & Nisbett, Shigley's Mechanical Engineering Design, 9th ed., chapter 8.
    """
    if not (0.0 < hole_diameter < eye_diameter and thickness > 0.0):
        raise CannotRunError(
            f"a hole of {hole_diameter:g} mm leaves no section in an eye of {eye_diameter:g} x {thickness:g} mm"
        )
    return abs(force) / ((eye_diameter - hole_diameter) * thickness)


def tube_hole_factors(outer_diameter: float, inner_diameter: float, hole_diameter: float) -> tuple[float, float]:
    """Return the stress concentration factors of a tube with a transverse hole.

    They are polynomial fits, used here for d_i/D <= 0.9 and d/D <= 0.4. In bending the hole opens at the extreme fibre.
    Converged solid models lie up to some 10 % lower in tension and more in bending.

    Parameters
    ----------
    outer_diameter : float
        D of the tube [mm].
    inner_diameter : float
        d_i of the tube [mm].
    hole_diameter : float
        d [mm].

    Returns
    -------
    tuple of 2 float
        In tension and in bending, on the gross section.

    Raises
    ------
    CannotRunError
        Outside of that range.

    References
    ----------
    Pilkey & Pilkey, Peterson's Stress Concentration Factors, 3rd ed., 2008, chapter 4.
    """
    r, h = inner_diameter / outer_diameter, hole_diameter / outer_diameter
    if not (0.0 <= r <= 0.9 and 0.0 < h <= 0.4):
        raise CannotRunError(
            f"the handbook's factors for a cross hole hold up to d_i/D = 0.9 and d/D = 0.4, not {r:.3g} and {h:.3g}"
        )
    tension = (
        3.0
        + (0.427 - 6.770 * r + 22.698 * r**2 - 16.670 * r**3) * h
        + (11.357 + 15.665 * r - 60.929 * r**2 + 41.501 * r**3) * h**2
    )
    bending = (
        3.0
        + (-6.250 - 0.585 * r + 3.115 * r**2) * h
        + (41.000 - 1.071 * r - 6.746 * r**2) * h**2
        + (-45.000 + 1.389 * r + 13.889 * r**2) * h**3
    )
    return tension, bending
