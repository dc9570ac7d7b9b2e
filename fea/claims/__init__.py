"""Published figures re-derived from the case and its results.

Hands on the verdict on each claim.
"""
