"""Speeds and accelerations of four-bar and slider-crank in closed form.

R. L. Norton, Design of Machinery, 5th ed., chapters 4, 6 and 7. The general solver is checked against them;
angles are in rad, arguments broadcast.
"""

from types import SimpleNamespace

import numpy as np


def four_bar_motion(bar, theta2, omega2, alpha2=0.0, *, branch="open"):
    """Return theta3, theta4 and their rates omega3, omega4, alpha3, alpha4."""
    theta2, omega2, alpha2 = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (theta2, omega2, alpha2)))
    position = bar.position(theta2, branch=branch)
    t3, t4 = np.asarray(position.theta3), np.asarray(position.theta4)
    sine = np.sin(t4 - t3)
    w3 = bar.a * omega2 / bar.b * np.sin(t4 - theta2) / -sine
    w4 = bar.a * omega2 / bar.c * np.sin(theta2 - t3) / sine
    A, B, D, E = bar.c * np.sin(t4), bar.b * np.sin(t3), bar.c * np.cos(t4), bar.b * np.cos(t3)
    C = bar.a * (alpha2 * np.sin(theta2) + omega2**2 * np.cos(theta2)) + E * w3**2 - D * w4**2
    F = bar.a * (alpha2 * np.cos(theta2) - omega2**2 * np.sin(theta2)) - B * w3**2 + A * w4**2
    size = bar.b * bar.c * sine
    return SimpleNamespace(
        theta3=t3, theta4=t4, omega3=w3, omega4=w4, alpha3=(C * D - A * F) / size, alpha4=(C * E - B * F) / size
    )


def slider_crank_motion(a, b, c, theta2, omega2, alpha2=0.0, *, branch="open"):
    """Return theta3 (at the slider, towards the crank pin), d, and their rates; c is the offset, open means d > 0."""
    theta2, omega2, alpha2 = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (theta2, omega2, alpha2)))
    along, across = a * np.cos(theta2), a * np.sin(theta2)
    rise = across - c
    run = np.sqrt((b - rise) * (b + rise)) * (1.0 if branch == "open" else -1.0)
    omega3 = -along * omega2 / run
    alpha3 = (along * alpha2 - across * omega2**2 + rise * omega3**2) / -run
    return SimpleNamespace(
        theta3=np.arctan2(rise, -run),
        d=along + run,
        omega3=omega3,
        d_dot=-across * omega2 + rise * omega3,
        alpha3=alpha3,
        d_ddot=-across * alpha2 - along * omega2**2 + rise * alpha3 - run * omega3**2,
    )
