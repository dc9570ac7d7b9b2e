"""What acts on every link in one pose or over a motion: stated loads, weight, inertia, drive.

Hands on loads per load case and ``CaseMotion``.
"""
