"""Natural frequencies of built-in links by beams and by solids; writes the table of docs/verification.md.

The lowest in the plane of the linkage, and the lowest out of it. Some three minutes.

    python -m benchmarks.link_frequencies
"""

from collections.abc import Iterator

from alula.fea.vibration.link_modes import LinkModes, link_modes
from alula.loads.case.case_file import read_case
from benchmarks.record import between, stamped
from benchmarks.verification import PAGE

LINKS = {
    "owl-wing-static": ("GF", "AE", "CF", "CH", "ED"),
    "ornithopter": ("rod", "lever-right", "crank"),
    "flapping-wing-chosen": ("crank", "coupler-right", "inner-right", "outer-right", "parallel-right"),
}
"""Of each pair of images the right one."""


def lowest(modes: LinkModes, *, in_plane: bool) -> str:
    """The lowest frequency in or out of the plane, with its band [Hz]."""
    band = next(mode.frequency for mode in modes.modes if (mode.in_plane > 0.5) == in_plane)
    value, low, high = (f"{float(f'{one:.4g}'):,.10g}" for one in (band.value, band.low, band.high))
    return f"{value} ({low} to {high})"


def rows() -> Iterator[str]:
    """The table, line by line."""
    yield "| case, link | mode | by beams | by solid |\n|---|---|--:|--:|\n"
    for name, links in LINKS.items():
        case = read_case(name)
        for link in links:
            print(f"{name}, {link}", flush=True)
            beams, solid = (link_modes(case, link, solid=solid) for solid in (False, True))
            for in_plane, told in ((True, "in the plane"), (False, "out of it")):
                found = (lowest(modes, in_plane=in_plane) for modes in (beams, solid))
                yield f"| {name}, {link} | {told} | {' | '.join(found)} |\n"


if __name__ == "__main__":
    between(PAGE, "link_frequencies", f"{''.join(rows())}\n{stamped('link_frequencies')}")
