"""Pictures of studies and of samples.

Hands on ``pictures`` and ``tolerance_pictures``; ``histogram`` and ``tornado`` take plain arrays.
"""
