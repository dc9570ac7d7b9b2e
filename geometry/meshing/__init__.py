"""From a part to a mesh: CAD solid, sizes, gmsh in a child process, checks of what came back.

Hands on ``TaggedMesh``, whose named surfaces are where loads enter.
"""
