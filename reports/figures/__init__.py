"""All pictures: the linkage, diagrams and stress here, each other kind in a folder of its own.

``sheet`` is what they are drawn on. Hands on PNG files as bytes.
"""
