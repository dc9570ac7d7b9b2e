"""The records of results, and what their numbers need besides: pins, points, limits, what no check looks at.

Hands on ``LinkResult`` and ``CheckResult``.
"""
