"""The check of a level of tests, test by test.

Hands on sections, records and the folder of reports.
"""
