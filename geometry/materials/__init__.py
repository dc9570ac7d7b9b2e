"""What links are made of: material cards, the library of them, laminates that no isotropic card describes, printing.

Hands on ``Material``, ``Fatigue``, ``Printable`` and ``library``, which reads ``materials.toml``.
"""
