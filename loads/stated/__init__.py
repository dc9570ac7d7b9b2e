"""What a case leaves to files beside it, and what these state: points of imported parts, tests of a level.

Hands on tables of a case, before it is validated, and ``LevelSpec``.
"""
