"""From a part's file to what is found in it: the solid's volume, centroid and inertia, and its bores.

Hands on ``PartFacts``. What asks the geometry kernel runs in its child process.
"""
