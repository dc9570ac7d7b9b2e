"""What checks ask for: which quantities of which subjects, against which limits, and what nothing asks for.

Hands on ``Asked``, which makes a ``CheckOutcome`` of a band.
"""
