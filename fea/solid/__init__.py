"""One link as a solid: elements, stiffness, pin pressure, supports, solvers, stress.

Hands on ``SolidSolution`` and ``StressField``.
"""
