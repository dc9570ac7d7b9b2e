"""Figures over a motion: directions, paths, torques, forces, rates, energy, air, safety factors, and the animation.

Hands on ``motion_pictures`` and the figures one by one.
"""
