"""What acts on links, one class for each kind: its loads at a place, its tangent and energy there, and its mark.

Springs, tendons and stops are records of the case file as well. Hands on ``Acting``.
"""
