"""The kinds of parts that a case may state, each with its sizes, sections, rules and solid.

Hands on ``Part``: ``Tube``, ``Bar``, ``Disc``, ``Plate`` and those from files.
"""
