"""Sections of a check, and the check as a whole: ``whole_check.py`` says which there are and in which order."""
