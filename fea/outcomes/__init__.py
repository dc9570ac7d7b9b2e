"""From numbers to verdicts: one file a kind of check, each decided on its whole band.

Hands on ``CheckOutcome``s and the records of results.
"""
