"""What does not have to be found anew: results of earlier runs, by the content of all that enters.

Hands on ``kept``, which marks functions whose results may be kept, and ``keeping``, which says that they are.
"""
