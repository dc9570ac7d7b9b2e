"""What links are made of: material cards and whether they are usual, the library, laminates, printing.

Hands on ``Material``, ``Fatigue``, ``Printable`` and ``library``, which reads ``materials.toml``.
"""
