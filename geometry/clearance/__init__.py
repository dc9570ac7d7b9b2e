"""How far the links of an assembly stay from one another.

Hands on ``link_shape``, ``pin_shape``, ``gaps`` and ``least_gap``.
"""
