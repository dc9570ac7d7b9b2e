"""How two links hold on to one another: joints, and how pins sit in their holes.

Hands on ``Joint``.
"""
