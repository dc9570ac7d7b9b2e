"""What can a reader turn in the page? Packs models into data blocks, and holds the script that draws them.

Results: ``link_model`` (a link's surface with its stress and displacements, per variant), ``data_block`` (a record as
text for the page) and ``viewer`` (the script, built by ``make viewer`` from ``source/``).
"""
