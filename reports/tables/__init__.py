"""Results as data and as tables: ``result.json``, the console, claims.

Hands on records that JSON holds and tables for a terminal.
"""
