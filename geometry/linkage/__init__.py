"""Where every link stands: links, joints, loop closure, poses and motions.

Hands on ``Linkage``, ``Pose`` and ``Motion``.
"""
