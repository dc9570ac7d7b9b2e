"""All links together as a frame: joint forces, displacement of points, large displacement, stability.

Hands on ``JointForces`` and ``LargeDisplacement``.
"""
