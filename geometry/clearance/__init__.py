"""How far the links of an assembly stay from one another, and what room they take up.

Hands on ``link_shape``, ``pin_shape``, ``gaps``, ``least_gap`` and ``reaches``.
"""
