"""What all of finite elements shares: bands, verdicts, scatter, loads on a link, memory and threads.

Hands on ``Band``, ``CheckOutcome`` and ``LinkLoads``.
"""
