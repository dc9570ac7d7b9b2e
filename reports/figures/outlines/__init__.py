"""Pictures of outlines: links in their layers, where two of them touch, and the box about all of them.

Hands on PNG files as bytes.
"""
