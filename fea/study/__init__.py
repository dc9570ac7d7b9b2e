"""Many variants of one case, computed side by side and kept in one file: numbers, store, workers, the study itself.

Hands on ``Study``, ``Store`` and ``evaluate``. ``alula.loads.plans`` says which variants there are.
"""
