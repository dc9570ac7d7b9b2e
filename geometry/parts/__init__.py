"""What links are made of: kinds of parts with their sections, rules and solids; materials.

Hands on ``Tube``, ``Bar``, ``Disc``, ``Body``, ``Section`` and ``Material``. A new kind derives from ``PartKind``.
"""
