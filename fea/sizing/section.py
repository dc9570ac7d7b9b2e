"""Sizes of a part that go together: what follows its section, and a section that passes.

Proportions of a link are its sizes over the width of its section (``alula.fea.beam.calibration``). A section that is
changed alone leaves fillet, eyes, pins and patches of loads behind; each of them is brought to the nearest end of its
range, rounded inwards. Distances between eyes, holes and loads are those of the linkage: nothing is brought to them.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress

from alula.fea.beam.calibration import Calibration, calibration_of, uncalibrated
from alula.fea.check.run import check_case
from alula.fea.common.change import rounded
from alula.fea.common.verdict import CheckOutcome, Subject, Verdict, deciding
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.parts.bar import Bar
from alula.geometry.parts.tube import Tube
from alula.loads.case.case import Case
from alula.loads.case.case_file import keys_of

Sizes = dict[str, str]
"""Entry -> its size, with its unit."""

_FACTORS = (1.0, 1.1, 1.2, 1.3, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0)
"""On a size of a section: steps of a tenth and more, since what is told is a section that does, not the least."""
_TRIES = 6
_MORE = 1.1
"""Factor on the section modulus of the next try where no margin tells one: the least step between sections."""
_SECTION = {"bar": ("width", "thickness"), "tube": ("outer_diameter", "inner_diameter")}
"""Entries of a part; the first one counts twice for bending in the plane. A tube keeps the ratio of both."""
_TO_WIDTH = {
    "fillet_radius": "fillet over width",
    "thickness": "thickness over width",
    "inner_diameter": "inner over outer diameter",
    "eye_diameter": "eye diameter over width",
    "eye_thickness": "eye thickness over width",
}
"""Entry of a part -> its proportion."""
_INWARDS = 1e-9
"""Share of a size that is rounding."""


def following(case: Case, part: str) -> Sizes:
    """Return the sizes that have to follow the section of a part, so that hand calculation is calibrated for its links.

    Parameters
    ----------
    case : Case
    part : str
        Its name.

    Returns
    -------
    dict of str to str
        Entry -> size, of the part, of pins and patches; with a smaller width where its links are too short for the one
        that it has. Empty where nothing has to, or where that does not do.
    """
    kind, links = case.parts[part], _links(case, part)
    if not isinstance(kind, Tube | Bar) or not any(_outside(case, link) for link in links):
        return {}
    entry = f"parts.{part}.{_SECTION[kind.shape][0]}"
    for factor in _FACTORS:
        found = {} if factor == 1.0 else {entry: _text(kind.section.width / factor, digits=2)}
        with suppress(CaseError):
            found |= _brought(case.with_values(found), part)
            if not any(_outside(case.with_values(found), link) for link in links):
                return found
    return {}


def larger(case: Case, name: str, checks: Sequence[CheckOutcome]) -> Sizes:
    """Return a larger section of the part that decides, with what follows it, with which the case passes by hand.

    Sections that hand calculation is calibrated for are tried from the lightest on that has the section modulus which
    it lacks, ``_TRIES`` in all; after each the margin that is left says what the next one must have.

    Parameters
    ----------
    case : Case
    name : str
        Its path or built-in name.
    checks : sequence of CheckOutcome
        All of the case, by hand, which do not all pass.

    Returns
    -------
    dict of str to str
        Entry -> size; empty where the worst check is of no link with a section to enlarge, or none tried passes.
    """
    subject, needed = _lacking(checks)
    part = case.links[subject.name].part if subject.kind == "link" else None
    entries = _SECTION.get(case.parts[part].shape, ()) if part else ()
    if part is None or not entries or any(entry not in case.parts[part].model_fields_set for entry in entries):
        return {}
    sizes = {entry: getattr(case.parts[part], entry) for entry in entries}
    both = case.parts[part].shape == "tube"
    grown = [(a * b, a * a * b, (a, b)) for a in _FACTORS for b in _FACTORS if a * b > 1.0 and (a == b or not both)]
    tried = 0
    for _, modulus, factors in sorted(grown):
        if tried == _TRIES:
            break
        if modulus < needed:
            continue
        found = {
            f"parts.{part}.{entry}": _text(factor * size, digits=2)
            for (entry, size), factor in zip(sizes.items(), factors, strict=True)
            if size and factor > 1.0
        }
        try:
            found |= _brought(case.with_values(found), part)
            changed = case.with_values(found)
            if any(_outside(changed, link) and not _outside(case, link) for link in case.checked_links):
                continue
            tried += 1
            result = check_case(changed, name=name, fidelity="beam", threads=1)
        except (CaseError, CannotRunError):
            continue
        if result.verdict is Verdict.PASS:
            return found
        needed = modulus * _lacking([one for told in result.load_cases.values() for one in told.checks])[1]
    return {}


def stated(case: Case, sizes: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    """Yield each size that is to be changed with what it is now.

    Parameters
    ----------
    case : Case
    sizes : mapping
        Entry -> size.

    Yields
    ------
    tuple of (str, str, str)
        Entry, size as it is and as it would be.
    """
    for path, size in sizes.items():
        table, name, entry = keys_of(path)
        yield path, _text(getattr(getattr(case, table)[name], entry)), size


def _lacking(checks: Sequence[CheckOutcome]) -> tuple[Subject, float]:
    """Return what the check that decides is about, and by which factor that lacks strength or stiffness at the most."""
    subject = deciding(checks)[0].subject
    left = [one.margin for one in checks if one.subject == subject and 0.0 < one.margin < 1.0]
    return subject, 1.0 / min(left) if left else _MORE


def _links(case: Case, part: str) -> list[str]:
    return [link for link in case.checked_links if case.links[link].part == part]


def _outside(case: Case, link: str) -> bool:
    return bool(uncalibrated(case.body(link), case.material_of(link).poissons_ratio))


def _within(size: float, of: float, calibration: Calibration, proportion: str, wider: float = 0.0) -> str:
    """Return the size nearest to one whose proportion lies in its range; "" where it does already.

    It is that of what fits in it, where that leaves a clearance.
    """
    low, high = (end * of for end in calibration.ranges[proportion])
    if low * (1.0 - _INWARDS) <= size <= high * (1.0 + _INWARDS):
        return ""
    return _text((low if size < low else high) - wider, up=size < low)


def _brought(case: Case, part: str) -> Sizes:
    """Return the sizes that follow the section of a part, each brought into its range."""
    kind, links, found = case.parts[part], _links(case, part), Sizes()
    assert isinstance(kind, Tube | Bar)
    calibration = calibration_of(kind)
    for entry, proportion in _TO_WIDTH.items():
        if proportion in calibration.ranges and entry in kind.model_fields_set:
            size = _within(getattr(kind, entry), kind.section.width, calibration, proportion)
            found |= {f"parts.{part}.{entry}": size} if size else {}
    changed = case.with_values(found)
    for link in links:
        body = changed.body(link)
        pins = {pin.name: pin for pin in body.pins}
        for joint in case.linkage.joints_of(link):
            if (pin := pins.get(case.linkage.point_of(joint, link))) is not None:
                eye, wider = body.ring(pin).diameter, pin.clearance
                size = _within(pin.diameter, eye, calibration, "largest pin over eye", wider)
                found |= {f"joints.{joint}.pin_diameter": size} if size else {}
        for end in body.ends:
            size = _within(end.patch, body.part.section.width, calibration, "patch over width")
            found |= {f"links.{link}.end_patch": size} if size else {}
    return found


def _text(size: float, *, up: bool | None = None, digits: int = 3) -> str:
    value = float(f"{size:.{digits}g}") if up is None else rounded(size, up=up, digits=2)
    return f"{value:.6g} mm"
