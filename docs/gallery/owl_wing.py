"""
The owl's wing
==============

The built-in case ``owl-wing-static``: a prosthesis of five tubes that bears 0.25 N at its tip.
"""

import alula

report = alula.check("owl-wing-static", fidelity="beam")
report

# %%
# The linkage in its pose, with the forces of its joints.
report.plot_linkage()

# %%
# It fails: it gives way at a fifth of its load.
assert report.verdict == "fail"
print(report.headline)
