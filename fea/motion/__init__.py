"""The same over a motion: loads of every pose, peaks and their bands, fatigue, verdicts.

Hands on ``envelope_case``.
"""
