"""The frame on its deformed shape: large displacement, and how near it is to buckling and to a dead point.

Hands on ``LargeDisplacement``.
"""
