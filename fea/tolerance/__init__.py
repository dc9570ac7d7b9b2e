"""Tolerances: how likely every check passes when places, angles, loads and materials are a little off.

Hands on ``ToleranceResult``.
"""
