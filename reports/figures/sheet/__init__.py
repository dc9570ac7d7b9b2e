"""A sheet on which pictures are drawn: lines, areas and text, axes, places of labels, style.

Hands on ``Canvas`` and ``Axes``.
"""
