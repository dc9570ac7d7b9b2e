"""The same over a motion: loads of every pose, peaks and their bands, fatigue, verdicts.

Hands on ``envelope_case``, and ``check_level``: tests of a level, some of which are loads that change over time.
"""
