"""What acts on the linkage: the case file, statics, weight, pin pressure."""

if __name__ != "alula.loads":
    raise ImportError(f"the name of this package is alula.{__name__}", name=__name__)
