"""The two tiers of a verdict, link by link, of the built-in cases of ductile parts: the table of ``docs/report.md``.

    python -m benchmarks.tiers [CASE ...]

Each case is checked as solids with the checks that it has, with plastic collapse of all links and, where the formulas
hold, with their eyes. A row has the least numbers of a link over all load cases, with their bands.
"""

import sys

from alula.fea.check.run import check_case
from alula.fea.common.band import Band
from alula.fea.common.verdict import Quantity, Subject
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.reports.words.numbers import band

CASES = ("spring-pedal", "knee", "finger", "slider-crank", "six-bar", "step", "owl-wing-closed")
"""The owl wing's other cases have the same links; the clamp's plates of ``four-bar-synthesis`` are one link thrice."""
COLUMNS = (Quantity.SAFETY_FACTOR, Quantity.PLASTIC_COLLAPSE, Quantity.EYES)
COLLAPSE = 'checks.collapse={type="plastic-collapse", minimum=1.0}'
EYES = 'checks.eyes={type="eye", minimum=1.0, links=["LINK"]}'


def has_round_eyes(name: str, link: str) -> bool:
    """Whether the formulas of eyes hold for a link."""
    try:
        read_case(name, [EYES.replace("LINK", link)])
    except CaseError:
        return False
    return True


def asked(name: str) -> Case:
    """Return a case that asks for all three numbers."""
    links = [link for link in read_case(name).checked_links if has_round_eyes(name, link)]
    return read_case(
        name, [COLLAPSE, *([EYES.replace('"LINK"', ", ".join(f'"{link}"' for link in links))] if links else [])]
    )


def rows(name: str) -> list[str]:
    """Return the rows of a case."""
    case = asked(name)
    checks = [check for of in check_case(case, name=name, fidelity="solid").load_cases.values() for check in of.checks]
    found = []
    for link in case.checked_links:
        own = [[c.value for c in checks if (c.subject, c.quantity) == (Subject.link(link), what)] for what in COLUMNS]
        least = [min(bands, key=lambda of: of.low) if bands else None for bands in own]
        first, last, _ = least
        assert first is not None
        assert last is not None
        found.append(f"| {name} | {link} | {' | '.join(map(_told, least))} | {last.value / first.value:.2g} |")
    return found


def _told(value: Band | None) -> str:
    return "" if value is None else band(value)


if __name__ == "__main__":
    print("| case | link | first yield | plastic collapse | eyes | collapse over first yield |")
    print("|---|---|--:|--:|--:|--:|")
    for case in sys.argv[1:] or CASES:
        print("\n".join(rows(case)), flush=True)
