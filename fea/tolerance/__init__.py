"""Tolerances: how likely every check passes when places, angles, loads, materials and sizes are a little off.

Hands on ``ToleranceResult``.
"""
