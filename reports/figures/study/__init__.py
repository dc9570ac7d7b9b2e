"""Pictures of studies and of samples.

Each takes arrays (``points.py``) and returns a figure, which ``png`` writes; ``tolerance_pictures`` takes a result.
"""
