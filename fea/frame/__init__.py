"""All links together as a frame: joint forces, displacement of points, large displacement, toggles.

Hands on ``JointForces`` and ``LargeDisplacement``.
"""
