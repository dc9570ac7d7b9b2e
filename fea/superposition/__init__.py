"""One link under very many loads: solutions of its unit loads, and the peaks of what is a sum of these.

Hands on ``UnitSolutions``, ``Peaks`` and the ``Shares`` of ways in which couples are shared.
"""
