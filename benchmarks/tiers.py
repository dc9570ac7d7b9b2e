"""The two tiers of a verdict, link by link, of the built-in cases of ductile parts: the table of ``docs/report.md``.

    python -m benchmarks.tiers [CASE ...]

Each case is checked as solids, with plastic collapse of all its links and, where the formulas hold, with their eyes. A
row has the least numbers of a link over all load cases, with their bands.
"""

import sys
from contextlib import suppress
from pathlib import Path

import alula
from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.verdict import Quantity, Subject
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.reports.words.numbers import band
from benchmarks.record import between, stamped

CASES = ("spring-pedal", "knee", "finger", "slider-crank", "six-bar")
"""Some minutes of a processor; others by name."""
PAGE = Path(__file__).resolve().parents[1] / "docs" / "report.md"
HEAD = """\
| case | link | first yield | plastic collapse | eyes | collapse over first yield |
|---|---|--:|--:|--:|--:|
"""
COLUMNS = (Quantity.SAFETY_FACTOR, Quantity.PLASTIC_COLLAPSE, Quantity.EYES)


def asked(name: str) -> Case:
    """Return a case that asks for all three numbers, of eyes where their formulas hold."""
    stated = alula.read_case(name).with_check("collapse", type="plastic-collapse", minimum=1.0, replace=True)
    for link in stated.record.checked_links:
        with suppress(CaseError):
            more = stated.with_check(f"eyes of {link}", type="eye", minimum=1.0, links=[link])
            _ = more.record
            stated = more
    return stated.record


def rows(name: str) -> list[str]:
    """Return the rows of a case."""
    case, found = asked(name), list[str]()
    checks = [check for of in check_case(case, name=name, fidelity="solid").load_cases.values() for check in of.checks]
    for link in case.checked_links:
        own = [[c.value for c in checks if (c.subject, c.quantity) == (Subject.link(link), what)] for what in COLUMNS]
        least = [min(bands, key=lambda of: of.low) if bands else Band.unknown() for bands in own]
        ratio = least[1].value / least[0].value
        found.append(f"| {name} | {link} | {band(least[0])} | {band(least[1])} | {band(least[2])} | {ratio:.2g} |")
    return found


def main() -> None:
    """Print the table; that of the usual cases goes to its page."""
    table = HEAD
    for case in sys.argv[1:] or CASES:
        table += "".join(f"{row}\n" for row in rows(case))
        print(table, flush=True)
    if not sys.argv[1:]:
        between(PAGE, "tiers", f"{table}\n{stamped('tiers')}")


if __name__ == "__main__":
    main()
