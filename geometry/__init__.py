"""Where everything is and what it is made of: materials, parts, linkages, poses, meshes."""

if __name__ != "alula.geometry":
    raise ImportError(f"the name of this package is alula.{__name__}", name=__name__)
