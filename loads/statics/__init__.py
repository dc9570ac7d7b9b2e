"""Equilibrium of pinned links: three equations for each moving link, assembled from the pose.

Hands on ``Reactions``, with the equations for people to see.
"""
