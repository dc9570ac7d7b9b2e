"""From a solid to a mesh: sizes, gmsh in a child process, meshes from files, checks of what came back.

Hands on ``TaggedMesh``, whose named surfaces are where loads enter.
"""
