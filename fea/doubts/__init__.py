"""What leaves the numbers of a load case open, and by how much.

Growth with the load, stiffness of links, ways of sharing couples, play, ranges of air and of friction. Hands on
``Growths`` and ``Doubt``, which has the answers of a cause as ``alula.fea.common.alternatives``.
"""
