"""Mechanisms with a name and closed forms of their own: four-bar, flapping wing, ornithopter.

Hands on their positions, speeds and design figures; the general solver does not know them.
"""
