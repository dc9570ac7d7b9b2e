"""The bodies of links: kinds of parts with their sections, rules and solids.

Hands on ``Tube``, ``Bar``, ``Disc``, ``Body`` and ``Section``. A new kind derives from ``PartKind``.
"""
