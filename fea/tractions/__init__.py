"""What acts on a link as a solid: pressure of pins, pushes in slots, thrust, couples, weight, as nodal loads.

Hands on force densities, and ``LinkTractions``: the ``SurfaceLoad`` of every kind on a link, for checks and envelopes.
"""
