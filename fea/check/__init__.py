"""The check of a case: which model decides which link, and the run from statics to verdict.

Hands on ``check_case``.
"""
