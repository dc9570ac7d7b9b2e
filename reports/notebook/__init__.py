"""What a notebook and a script see: results with their numbers by name, tables and pictures.

Hands on the reports that the functions of ``alula`` return.
"""
