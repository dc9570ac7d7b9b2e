"""Euler's column, as a closed form to compare with."""

import math


def euler_load(young: float, inertia: float, length: float, effective_length: float = 1.0) -> float:
    """Critical load π² E I/(k L)² [N] of a column (Gere & Goodno, 8th ed., section 11.3 and table 11-1).

    ``effective_length`` k: 1 pinned at both ends, 0.5 built in at both, 0.699 built in and pinned, 2 built in and free.
    E in MPa, I in mm⁴, L in mm.
    """
    return math.pi**2 * young * inertia / (effective_length * length) ** 2
