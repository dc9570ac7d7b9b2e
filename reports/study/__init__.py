"""Pictures and tables of studies and of samples, and ``study.html``, the page that holds them.

Hands on ``read_study``, ``pictures`` and ``write_study``; ``histogram`` and ``tornado`` take plain arrays.
"""
