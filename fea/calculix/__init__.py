"""A second opinion: our mesh and loads solved by CalculiX, and the difference.

Hands on ``second_opinions``.
"""
