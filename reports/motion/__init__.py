"""What a motion tells: its record for ``result.json``, its tables as CSV, its lines for the console.

Hands on ``record``, ``write_tables``, ``print_motion``, and ``series``: speeds, accelerations, momentum and energy.
"""
