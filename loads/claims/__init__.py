"""Published systems of equations, audited row by row against the linkage's own equilibrium.

Hands on ``StaticsAudit``.
"""
