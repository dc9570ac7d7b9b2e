"""Whether links buckle, each by itself and the linkage as a whole.

Hands on ``Column`` and ``CheckOutcome``s.
"""
