"""What is checked of the linkage as a whole: what its motor must give, and what its links keep clear of.

Hands on ``whole_outcomes``.
"""
