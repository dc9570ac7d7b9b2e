"""Displacements for given nodal loads: factors and two-level conjugate gradients, and how exact they are.

Hands on ``Factor`` and ``Solved``.
"""
