"""How an imported part lies in its link.

Hands on ``placed_body``, ``bores_of``, ``place`` and ``points_of_part``.
"""
