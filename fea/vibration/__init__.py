"""Natural frequencies: at which frequencies the linkage, and each of its links, rings.

Results: frequencies with bands, and their shapes, at poses over the motion.
"""
