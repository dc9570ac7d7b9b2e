"""Buckling of links in compression, and of the linkage as a whole.

A link's factor is Euler's load over the largest compression anywhere along it. Every link is a straight column of its
section, under its largest compression N over its whole length. Both make the answer smaller, never larger. The end
conditions are the least favourable ones that joints leave:

pinned ends     a link whose compression lies between its outermost pins turns freely about them in the linkage's
                plane, k = 1. Out of the plane the pins carry moments, which would give k down to 0.5 between stiff
                neighbours; how stiff they are is not known here, so k = 1 stands there too.
built in, free  k = 2 over the whole length, for the driven link (held in its angle at the drive's joint, free at
                the other end), for compression beyond the outermost pins, and where pins are bonded (the linkage may
                sway). For an overhang this is a lower bound: the slope v of a column held at x = 0 and x = L and free
                at L + a has a zero between the pins, on either side of which ∫v'² ≥ (π/2)² ∫v²/(L + a)².

That the joints stay where they are is taken for granted: sway of the whole linkage is the other outcome, the lowest
factor on all loads at which its linear frame becomes unstable (``fea.corotational.buckling_factor``). It leaves out
how the frame moves before that. Where equilibrium was followed on the deformed shape (``fea.large_displacement``),
that answer rules: a frame may give way below the linear factor, or stiffen and hold beyond it. The outcome then is the
share of the load at which it gave way, or at least 1 where it held the whole.

Bending that goes with the compression grows to 1/(1 - 1/n) of what linear theory gives, n the factor (Timoshenko &
Gere, Theory of Elastic Stability, 2nd ed., section 1.11). EN 1993-1-1:2005 asks for n >= 10 where this is neglected
(5.2.1(3)) and for n >= 3 where a factor may stand for it (section 5.2.2); below 3 stress by linear theory passes no
link, and no linkage whose deformed shape is not known.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from fea.band import Band
from fea.beam import BeamCheck, euler_load
from fea.large_displacement import LargeDisplacement
from fea.verdict import BUCKLING_FACTOR, LINKAGE, CheckOutcome, Verdict, at_least
from geometry.material import Material
from loads.case import Case

NAME = "buckling"
LEAST_LINEAR = 3.0
"""Factor below which stress by linear theory is not relied on."""
SECOND_ORDER = 10.0
"""Factor below which the growth of bending is told."""
NO_COMPRESSION = 1e-9
"""Share of the largest force in the link below which compression is rounding."""
PINNED, BUILT_IN = 1.0, 2.0


@dataclass(frozen=True, kw_only=True)
class Column:
    """A link in compression as a column.

    compression       the largest along the link [N]
    length            between its ends [mm]
    effective_length  k, as a multiple of ``length``
    ends              how they are held, for people
    """

    compression: float
    length: float
    effective_length: float
    ends: str


def column(case: Case, link: str, beam: BeamCheck) -> Column | None:
    """Return the column that stands for a link under a load case; None without compression."""
    _, _, compression = beam.forces.largest(lambda f: -float(f[0]))
    forces = max(float(np.abs(values).max()) for values in (beam.n, beam.v_y, beam.v_z))
    if compression <= NO_COMPRESSION * forces:
        return None
    start, end = (float(x) for x in beam.forces.breaks[[0, -1]])
    first, last = outermost_pins(case, link)
    slack = 1e-9 * (end - start)
    outside = (beam.x < first[0] - slack) | (beam.x > last[0] + slack)
    beyond = bool(np.any(-beam.n[outside] > NO_COMPRESSION * forces))
    length, effective, ends = held(case, link, (start, end), beyond=beyond)
    return Column(compression=compression, length=length, effective_length=effective, ends=ends)


def outermost_pins(case: Case, link: str) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the places of a link's first and last pin along its axis, in its frame [mm]."""
    points, linkage = case.links[link].points, case.linkage
    pins = sorted({points[linkage.point_of(joint, link)] for joint in linkage.joints_of(link)})
    return pins[0], pins[-1]


def held(case: Case, link: str, extent: tuple[float, float], *, beyond: bool) -> tuple[float, float, str]:
    """Return length [mm] and effective length (as its multiple) of a link as a column, and for people how it is held.

    extent  first and last x of what acts on the link [mm]
    beyond  whether it is compressed beyond its outermost pins
    """
    first, last = outermost_pins(case, link)
    reasons = {
        "driven": case.drive is not None and case.drive.link == link,
        "bonded": case.joint_model == "bonded",
        "compressed beyond its pins": beyond,
        "on one pin": first == last,
    }
    why = [reason for reason, holds in reasons.items() if holds]
    if why:
        whole = max(extent[1], last[0]) - min(extent[0], first[0])
        return whole, BUILT_IN, f"built in and free, since it is {' and '.join(why)}"
    return float(np.hypot(last[0] - first[0], last[1] - first[1])), PINNED, "pinned at both ends"


def factor_band(material: Material, factor: float) -> Band:
    """Return the band of a link's buckling factor.

    From a third of the factor of the least modulus, since linear stress is not relied on below 3, to the factor.
    """
    least = min((material.youngs_modulus, *(material.youngs_modulus_range or ()))) / material.youngs_modulus
    return Band(
        value=factor,
        low=least * factor / LEAST_LINEAR,
        high=factor,
        holds=("the modulus", "bending that grows with compression, which linear stress leaves out"),
    )


def buckling_outcomes(case: Case, title: str, beams: Mapping[str, BeamCheck]) -> Iterator[CheckOutcome]:
    """Yield the outcome of every link that is compressed under the load case ``title``.

    A link fails where its compression exceeds Euler's load, whatever its stress says.
    """
    for link, beam in beams.items():
        found = column(case, link, beam)
        if found is None:
            continue
        material, inertia = case.material_of(link), min(beam.section.i_y, beam.section.i_z)
        load = euler_load(material.youngs_modulus, inertia, found.length, found.effective_length)
        value = load / found.compression
        band = factor_band(material, value)
        verdict = at_least(band, 1.0)
        yield CheckOutcome(
            name=NAME,
            link=link,
            load_case=title,
            quantity=BUCKLING_FACTOR,
            unit="",
            value=band,
            limit=1.0,
            verdict=verdict,
            reason=_reason(found, value, verdict),
        )


def linkage_outcome(case: Case, title: str, moved: LargeDisplacement) -> Iterator[CheckOutcome]:
    """Yield the outcome of the linkage as a whole where its frame can buckle under the load case ``title``.

    The band is that of a link, with the least ratio of a stated least modulus to the modulus; where equilibrium was
    followed on the deformed shape, it is what was found there.
    """
    value = moved.buckling
    if value is None or math.isinf(value):
        return
    materials = [case.material_of(link) for link in case.checked_links]
    softest = min(min((m.youngs_modulus, *(m.youngs_modulus_range or ()))) / m.youngs_modulus for m in materials)
    factor = f"all links together become unstable at {value:.3g} times the load by linear theory"
    band = Band(
        value=value,
        low=softest * value / LEAST_LINEAR,
        high=value,
        holds=("the modulus", "displacement that grows with the load, which linear theory leaves out"),
    )
    verdict = at_least(band, 1.0)
    if moved.followed:
        verdict = Verdict.PASS if moved.state == "deformed" else Verdict.FAIL
        at, held = {
            "deformed": (max(value, 1.0), "the linkage holds the whole load"),
            "unstable": (min(value, 1.0), "the linkage has buckled before the whole load acts"),
        }.get(moved.state, (moved.held, f"the linkage gives way at {moved.held:.3g} of the load"))
        band = Band.exact(at, "equilibrium on the deformed shape, followed from no load")
        reason = f"{factor}, but large displacement was followed and rules: {held}"
    elif verdict is Verdict.FAIL:
        reason = f"{factor}, so the linkage gives way"
    elif verdict is Verdict.UNDECIDED:
        reason = f"{factor}; so near to it, joint forces by linear theory do not hold"
    elif value < SECOND_ORDER:
        reason = f"{factor}; displacements are up to {1.0 / (1.0 - 1.0 / value):.3g} times those of linear theory"
    else:
        reason = factor
    yield CheckOutcome(
        name=NAME,
        link=LINKAGE,
        load_case=title,
        quantity=BUCKLING_FACTOR,
        unit="",
        value=band,
        limit=1.0,
        verdict=verdict,
        reason=reason,
    )


def _reason(found: Column, factor: float, verdict: Verdict) -> str:
    load = (
        f"{found.compression:.3g} N compress it, Euler's load is {factor * found.compression:.3g} N "
        f"({found.length:.4g} mm, {found.ends}, k = {found.effective_length:g})"
    )
    if verdict is Verdict.FAIL:
        return f"{load}, so it buckles"
    if verdict is Verdict.UNDECIDED:
        return f"{load}; within {LEAST_LINEAR:g} times the load, stress by linear theory does not hold"
    if factor < SECOND_ORDER:
        return f"{load}; bending is up to {1.0 / (1.0 - 1.0 / factor):.3g} times that of linear theory"
    return load
