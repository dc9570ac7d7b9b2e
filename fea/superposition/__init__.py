"""One link under very many loads: unit loads, their solutions, and the peaks of what is a sum of these.

Hands on ``UnitLoads``, ``UnitSolutions``, ``Peaks`` and the ``Shares`` of ways in which couples are shared.
"""
