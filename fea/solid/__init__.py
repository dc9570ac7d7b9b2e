"""One link as a solid: its displacements, its stress, that on printed layers, and the motion of its bores.

Hands on ``SolidSolution`` and ``StressField``.
"""
