"""Equilibrium of pinned links: three equations for each moving link, assembled from the pose; momentum of moving ones.

Hands on ``Reactions``, with the equations for people to see, and ``LinkageMomentum``.
"""
