"""The same over a motion: loads of every pose, unit solutions, peaks, fatigue, verdicts.

Hands on ``envelope_case``.
"""
