"""Grashof's condition and the inversions of the four-bar."""

from dataclasses import dataclass

EQUALITY_TOLERANCE = 1e-9
"""Relative to the sum of the lengths: closer sums are told as equal (a change point)."""

_LINKS = ("input", "coupler", "output", "ground")
_GRASHOF = {
    "ground": ("double-crank", "GCCC"),
    "input": ("crank-rocker", "GCRR"),
    "coupler": ("double-rocker", "GRCR"),
    "output": ("rocker-crank", "GRRC"),
}
_CHANGE_POINT = {"ground": "SCCC", "input": "SCRR", "coupler": "SRCR", "output": "SRRC"}
_TRIPLE_ROCKER = {"ground": "RRR1", "input": "RRR2", "coupler": "RRR3", "output": "RRR4"}


@dataclass(frozen=True, kw_only=True)
class Grashof:
    """Grashof's sums and the class that follows; sums in the unit of the lengths.

    Attributes
    ----------
    shortest : str
        Name of the shortest link.
    longest : str
        Name of the longest link.
    shortest_plus_longest : float
        Sum of their lengths.
    other_two : float
        Sum of the other two lengths.
    relation : str
        ``less``, ``equal`` or ``greater``: shortest plus longest against the other two.
    inversion : str
        crank-rocker, double-crank, double-rocker, rocker-crank, change point, parallelogram, kite, rhombus or triple-
        rocker.
    barker : str
        Barker's code for the same (C. R. Barker 1985; Norton, 5th ed., chapter 2).
    """

    shortest: str
    longest: str
    shortest_plus_longest: float
    other_two: float
    relation: str
    inversion: str
    barker: str

    @property
    def satisfied(self) -> bool:
        """Whether at least one link can turn fully: s + l ≤ p + q."""
        return self.relation != "greater"

    @property
    def sentence(self) -> str:
        """Return the finding in one plain sentence."""
        sums = (
            f"shortest plus longest ({self.shortest} and {self.longest}) are {self.shortest_plus_longest:.10g}, "
            f"the other two {self.other_two:.10g}"
        )
        if self.relation == "less":
            return f"Grashof {self.inversion}: {sums}, so the {self.shortest} link turns fully against the others."
        if self.relation == "equal":
            return f"Special Grashof ({self.inversion}): {sums}, equal, so the links pass through a change point."
        return f"Non-Grashof triple-rocker: {sums}, so no link turns fully."


def classify(*, a: float, b: float, c: float, d: float, tolerance: float = EQUALITY_TOLERANCE) -> Grashof:
    """Classify a four-bar.

    s + l < p + q: Grashof, the inversion named after the shortest link; equality: special Grashof (change point); else
    triple-rocker, Barker's code after the longest link.

    Parameters
    ----------
    a, b, c, d : float
        Positive lengths of input, coupler, output and ground, of one unit.
    tolerance : float
        Difference of the sums that counts as none, over the sum of all lengths.

    Returns
    -------
    Grashof
        Sums and class.

    References
    ----------
    R. L. Norton, Design of Machinery, 5th ed., chapter 2 (the Grashof condition and Barker's classification).
    """
    lengths = dict(zip(_LINKS, (a, b, c, d), strict=True))
    order = sorted(_LINKS, key=lambda link: lengths[link])
    shortest, longest = order[0], order[-1]
    outer = lengths[shortest] + lengths[longest]
    inner = lengths[order[1]] + lengths[order[2]]
    margin = tolerance * (a + b + c + d)
    if abs(outer - inner) <= margin:
        relation = "equal"
        inversion, barker = _special(a, b, c, d, margin, shortest)
    elif outer < inner:
        relation = "less"
        inversion, barker = _GRASHOF[shortest]
    else:
        relation = "greater"
        inversion, barker = "triple-rocker", _TRIPLE_ROCKER[longest]
    return Grashof(
        shortest=shortest,
        longest=longest,
        shortest_plus_longest=outer,
        other_two=inner,
        relation=relation,
        inversion=inversion,
        barker=barker,
    )


def _special(a: float, b: float, c: float, d: float, margin: float, shortest: str) -> tuple[str, str]:
    opposite = abs(a - c) <= margin and abs(b - d) <= margin
    adjacent = (abs(a - b) <= margin and abs(c - d) <= margin) or (abs(a - d) <= margin and abs(b - c) <= margin)
    if opposite and adjacent:
        return "rhombus", "S3X"
    if opposite:
        return "parallelogram", "S2X"
    if adjacent:
        return "kite", "S2X"
    return "change point", _CHANGE_POINT[shortest]
