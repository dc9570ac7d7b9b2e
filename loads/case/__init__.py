"""The case: all that a user states, the rules that it must keep, and how it is read.

Hands on ``Case`` and ``read_case``.
"""
