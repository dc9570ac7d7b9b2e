"""Whether links buckle, each by itself, and how their joints hold them.

Hands on ``StraightColumn`` and ``CheckOutcome``s.
"""
