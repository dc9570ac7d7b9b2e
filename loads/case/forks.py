"""Forks: which joints have one, and whether the other link's eye fits into its gap."""

from geometry.base.errors import CaseError
from geometry.bodies.eyes import ROUNDING
from geometry.parts.part import FilePart
from loads.case.core import CoreCase
from loads.case.eyes import joint_of_fork, other_link


def forked_link(case: CoreCase, joint: str) -> str | None:
    """Return the link whose fork holds a joint's pin.

    Parameters
    ----------
    case : CoreCase
    joint : str

    Returns
    -------
    str or None
        None where neither link says that it has one; where one fork lies in another, the outer.
    """
    gaps = {}
    for link in case.joints[joint].links:
        eye = case.links[link].eyes.get(case.linkage.point_of(joint, link))
        if eye is not None and eye.fork is not None:
            gaps[link] = eye.fork
    return max(gaps, key=lambda link: gaps[link]) if gaps else None


def check_fork(case: CoreCase, joint: str) -> None:
    """Check that the other link's eye fits into the gap of a joint's fork.

    Parameters
    ----------
    case : CoreCase
    joint : str

    Raises
    ------
    CaseError
        Where it does not, or the gap is not that of an imported part.
    """
    link = forked_link(case, joint)
    if link is None:
        return
    point, gap = case.linkage.point_of(joint, link), case.joints[joint].pin_gap
    entry, part = f"links.{link}.eyes.{point}.fork", case.parts[case.links[link].part or ""]
    joint_of_fork(case.linkage, link, point)
    fork = case.links[link].eyes[point].fork
    assert fork is not None
    body = case.body(link)
    ring = body.ring(body.pin(point))
    if isinstance(part, FilePart):
        found = [high - low for low, high in ring.gaps]
        if len(found) != 1 or abs(found[0] - fork) > part.place_tolerance:
            has = f"gaps of {', '.join(f'{one:.4g} mm' for one in found)}" if found else "no gap"
            raise CaseError(f"{entry}: it is {fork:.4g} mm, but the bore of the file has {has} there; correct it")
    mate = other_link(case.linkage, joint, link)
    if case.links[mate].part is None:
        if not 2.0 * gap < fork:
            raise CaseError(
                f"joints.{joint}.pin_gap: {gap:.4g} mm on either side leave nothing of the fork's gap of {fork:.4g} mm "
                f"for link '{mate}'; reduce it"
            )
        return
    other = case.body(mate)
    height = other.ring(other.pin(case.linkage.point_of(joint, mate))).height
    if height > (1.0 + ROUNDING) * fork:
        raise CaseError(
            f"{entry}: its gap of {fork:.4g} mm is less than the {height:.4g} mm of the eye of link '{mate}' that lies "
            "in it; widen the gap, or make that eye thinner"
        )
    free = (fork - height) / 2.0
    if "pin_gap" in case.joints[joint].model_fields_set and abs(gap - free) > ROUNDING * fork:
        raise CaseError(
            f"joints.{joint}.pin_gap: it is {gap:.4g} mm, but fork and eye leave {free:.4g} mm on either side; "
            "leave it out"
        )
    if case.linkage.rise(joint) != 0.0:
        raise CaseError(
            f"{entry}: link '{mate}' lies in the fork's gap, so both lie in one layer; give them the same layer or z"
        )
