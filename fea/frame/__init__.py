"""All links together as a frame in small displacements: its equations, joint forces, displacement of points.

Hands on ``LinkageFrame``.
"""
