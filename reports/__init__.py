"""What a person needs to see: console, HTML, JSON, figures, VTU."""

if __name__ != "alula.reports":
    raise ImportError(f"the name of this package is alula.{__name__}", name=__name__)
