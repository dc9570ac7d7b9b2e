"""From bands to outcomes: what is asked of links, pins, points and the linkage, decided on whole bands.

The numbers of a link with all that leaves them open become a ``LinkResult``; hands on ``CheckOutcome``s.
"""
