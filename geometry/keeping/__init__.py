"""What does not have to be found anew: results of earlier runs, by the content of all that enters.

Hands on ``kept``, which marks functions whose results may be kept, ``keeping``, which says that they are, and
``write_whole``, by which files stand whole or not at all.
"""
