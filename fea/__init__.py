"""What the loads do: beams, frames, solids, stress, verdicts."""

if __name__ != "alula.fea":
    raise ImportError(f"the name of this package is alula.{__name__}", name=__name__)
