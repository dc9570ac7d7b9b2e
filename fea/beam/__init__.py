"""One link by hand: internal forces, section stress, stress concentrations, columns, calibrated factors.

Hands on ``BeamCheck``, critical locations, where stress may peak, and column factors.
"""
