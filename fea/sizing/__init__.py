"""Which value holds: the least size that passes, the lightest of several, and what limits them.

Hands on ``least_size`` and ``Search``. Variants are computed and kept as those of a study (``alula.fea.study``).
"""
