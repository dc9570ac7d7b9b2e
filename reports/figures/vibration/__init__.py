"""Pictures of natural frequencies: the shapes of the linkage, and where harmonics of the drive meet them.

Hands on ``shapes_drawing`` and ``campbell_diagram``.
"""
