"""From numbers to verdicts: one file a kind of check but buckling, each decided on its whole band.

Hands on ``CheckOutcome``s and the records of results.
"""
