"""What every package stands on: units and the model of user input, errors, child processes and locks.

Hands on ``CaseModel``, the kinds of quantities with units, ``CaseError`` and ``CannotRunError``.
"""
