"""CalculiX beside the owl wing's solids, on the same meshes; writes the table of docs/verification.md.

Needs CalculiX. Some three minutes.

    python -m benchmarks.second_opinion
"""

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from alula.fea.calculix.second_opinion import second_opinions
from alula.fea.check.run import check_case
from alula.loads.case.case_file import read_case
from benchmarks.record import between, stamped
from benchmarks.verification import PAGE

CASE = "owl-wing-static"


def rows(folder: Path) -> Iterator[str]:
    """The table, line by line; the decks go to a folder."""
    yield (
        "| link | unknowns | von Mises at the integration points, ours / CalculiX [MPa] | differs by at most "
        "| displacement, ours / CalculiX [mm] | differs by at most |\n|---|--:|--:|--:|--:|--:|\n"
    )
    result = check_case(read_case(CASE), name=CASE, fidelity="solid")
    for one in second_opinions(result, folder, progress=print):
        if one.answer is None:
            sys.exit(f"{one.link}: {one.reason}")
        stress, displacement = (f"{100.0 * gap:.3f} %" for gap in (one.answer.stress_gap, one.answer.displacement_gap))
        unknowns = 3 * len(result.load_cases[one.load_case].links[one.link].solution.space.nodes)
        yield (
            f"| {one.link} | {unknowns:,} "
            f"| {one.von_mises:.5g} / {one.answer.von_mises:.5g} | {stress} "
            f"| {one.displacement:.6g} / {one.answer.displacement:.6g} | {displacement} |\n"
        )


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        told = "".join(rows(Path(scratch)))
    between(PAGE, "second_opinion", f"{told}\n{stamped('second_opinion')}")
