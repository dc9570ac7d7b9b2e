"""What the commands tell that check no linkage: a part from CAD, the materials, a synthesis.

Their sections, as those of a check are in ``alula.reports.check``.
"""
