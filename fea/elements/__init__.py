"""What equilibrium of a link as a solid is written with: nodes, elements, integration, stiffness, rigid motions.

Hands on ``DisplacementSpace``, ``Quadrature`` and ``SymmetricBlockMatrix``.
"""
