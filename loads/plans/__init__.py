"""Which variants of a case are wanted: ranges, lists, samples and tables of values, and entries derived from others.

Hands on ``StudyPlan``, ``read_plan``, ``Points`` and ``Variants``.
"""
