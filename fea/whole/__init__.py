"""What is checked of the linkage as a whole: what its motor must give, what its links keep clear of, what stays of it.

Hands on ``whole_outcomes``.
"""
