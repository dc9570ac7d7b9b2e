"""What links are made of: shapes, their rules and sections, materials.

Hands on ``Tube``, ``Bar``, ``Disc``, ``Body``, ``Section`` and ``Material``.
"""
