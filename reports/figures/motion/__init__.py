"""Figures over a motion: directions, paths, torques, forces, rates, energy, air, safety factors, and the animation.

Hands on the figures one by one; the sections of a motion say which it has.
"""
