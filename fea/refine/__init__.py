"""How fine is fine enough: error estimates, series of meshes, singular edges, sizes of the next mesh.

Hands on ``RefinedSolid`` with the band of every number.
"""
