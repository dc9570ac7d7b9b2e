"""What each test of a standard's level says, in a pose or over the states of its profile.

Hands on ``check_level`` and its ``LevelResult``.
"""
