"""What studies and samples tell: sections made of the points of a study, and of a case under its tolerances.

Hands on ``study_sections``, ``write_study`` and ``tolerance_sections``.
"""
