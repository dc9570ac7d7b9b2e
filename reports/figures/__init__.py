"""Pictures: the linkage, diagrams, stress plots, motion and envelope.

Hands on PNG files as bytes.
"""
