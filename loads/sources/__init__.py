"""What serves the published sources alone: their tables in a case file, their claims, the audit of their equations.

Hands on ``SourceTables``, which ``alula.loads.case`` adds to the core of a case, and ``read_source``; each ``*.toml``
holds the claims of one document.
"""
