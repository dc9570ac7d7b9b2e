"""What studies and samples tell: the columns of a study, its rows for the console, regression, tables of samples.

Hands on ``read_study``.
"""
