"""What a user writes, as text: arithmetic with units, shares, and sentences about what is wrong with it.

Hands on ``sentence`` for errors, ``evaluate`` for expressions, and readers of accuracy and scatter.
"""
