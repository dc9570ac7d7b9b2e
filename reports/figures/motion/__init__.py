"""Figures over a motion: directions, paths, torques, forces, rates, energy, air, safety factors, and the animation.

Hands on ``draw_figures`` and the figures one by one.
"""
