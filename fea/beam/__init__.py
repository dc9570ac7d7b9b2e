"""One link by hand: internal forces, section stress, stress concentrations, columns, calibrated factors.

Hands on ``BeamCheck``, the spots that may bear a peak, and column factors.
"""
