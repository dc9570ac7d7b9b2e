"""Forks and pairs of side plates: which joints have one, and whether the other link's eye fits in between."""

from alula.geometry.base.errors import CaseError
from alula.geometry.bodies.eyes import ROUNDING
from alula.geometry.bodies.features import Ring
from alula.geometry.parts.part import FilePart
from alula.loads.case.core import CoreCase
from alula.loads.case.eyes import joint_of_fork, other_link
from alula.loads.case.heights import plates_apart, thickness


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


def apart(case: CoreCase, link: str) -> float | None:
    """Return the distance of the mid-planes of a pair's plates.

    Parameters
    ----------
    case : CoreCase
    link : str

    Returns
    -------
    float or None
        [mm]; None for a link that is no pair.

    Raises
    ------
    CaseError
        For a pair whose distance does not follow.
    """
    record = case.links[link]
    distance = plates_apart(record, case.layer_spacing)
    if distance is None and record.count > 1:
        raise CaseError(
            f"links.{link}.apart: it is missing, while count = 2 makes the link a pair of plates; state the distance "
            'of their mid-planes, such as apart = "14 mm"'
        )
    return distance


def levels(case: CoreCase, link: str) -> tuple[float, ...]:
    """Return the heights of the mid-planes of a link's material.

    Parameters
    ----------
    case : CoreCase
    link : str

    Returns
    -------
    tuple of float
        z of the link [mm]; of both plates of a pair, the lower first.
    """
    level, distance = case.heights[link], apart(case, link)
    return (level,) if distance is None else (level - distance / 2.0, level + distance / 2.0)


def of_pair(case: CoreCase, link: str) -> tuple[str, ...]:
    """Say what the numbers of a pair of plates are of; nothing of another link.

    Parameters
    ----------
    case : CoreCase
    link : str

    Returns
    -------
    tuple of str
        One sentence, for people, or none.
    """
    distance = apart(case, link)
    if distance is None:
        return ()
    return (
        f"the numbers are of one of two equal plates, {distance:.4g} mm apart, of the one that is worse off: each "
        "bears half of what acts on the link, and couples of its pins as opposite forces on both plates",
    )


def eye_of(case: CoreCase, joint: str, link: str) -> Ring:
    """Return a joint's hole in one of its links.

    Parameters
    ----------
    case : CoreCase
    joint, link : str
        The link has a part.

    Returns
    -------
    Ring
        With its rims and walls; of a pair, those of both plates.
    """
    body, distance = case.body(link), apart(case, link)
    ring = body.ring(body.pin(case.linkage.point_of(joint, link)))
    return ring if distance is None else ring.doubled(distance)


def eyes(case: CoreCase, joint: str) -> tuple[Ring, Ring]:
    """Return a joint's holes in its two links.

    That of a link without part is as long as the thickness that it states, else like that of the other link's plate.

    Parameters
    ----------
    case : CoreCase
    joint : str

    Returns
    -------
    tuple of (Ring, Ring)
        With their rims and walls.

    Raises
    ------
    CaseError
        Where neither link has a part.
    """
    links = case.joints[joint].links
    found = {link: eye_of(case, joint, link) for link in links if case.links[link].part is not None}
    if not found:
        raise CaseError(f"joints.{joint}: neither link has a part, so the pin's length is unknown; give one a part")
    if len(found) == 1:
        [link] = found
        body, other = case.body(link), other_link(case.linkage, joint, link)
        ring, height = body.ring(body.pin(case.linkage.point_of(joint, link))), case.links[other].thickness
        found[other] = ring if height is None else Ring(diameter=ring.diameter, low=-height / 2.0, high=height / 2.0)
    return found[links[0]], found[links[1]]


def outer_link(case: CoreCase, joint: str) -> str | None:
    """Return the link in which the other link of a joint lies: a fork, or a pair of plates.

    Parameters
    ----------
    case : CoreCase
    joint : str

    Returns
    -------
    str or None
        None where they lie side by side; of two pairs, the wider.
    """
    fork = forked_link(case, joint)
    if fork is not None or case.linkage.rise(joint) != 0.0:
        return fork
    widths = {link: width for link in case.joints[joint].links if (width := apart(case, link)) is not None}
    return max(widths, key=lambda link: widths[link]) if widths else None


def in_holes(case: CoreCase, joint: str) -> bool:
    """Return whether how a joint's pin stands in its holes counts.

    Parameters
    ----------
    case : CoreCase
    joint : str

    Returns
    -------
    bool
        Of every pin between layers. Of links in one layer, of a pin through a fork or a pair of plates, and of one
        whose clearance is stated unless a layer_spacing of 0 takes all links into one plane. Others are drawn as if
        both links had one place, and are tight.
    """
    record = case.linkage.joints[joint]
    if case.linkage.rise(joint) != 0.0:
        return record.kind.has_pin
    if not record.pivots:
        return False
    if outer_link(case, joint) is not None:
        return True
    holes = case.linkage.pin_holes(joint).holes if case.layer_spacing != 0.0 else ()
    return any(hole.stated and hole.high > 0.0 for hole in holes)


def check_pair(case: CoreCase, link: str) -> None:
    """Check that a link may be a pair of side plates, where it states that it is one.

    Parameters
    ----------
    case : CoreCase
    link : str

    Raises
    ------
    CaseError
        For the ground, a link without part, one with forks, and plates that lie in each other.
    """
    record, entry = case.links[link], f"links.{link}.count"
    if record.count == 1:
        if record.apart is not None:
            raise CaseError(f"links.{link}.apart: only a pair of plates has it; state count = 2, or leave it out")
        return
    if record.ground:
        raise CaseError(
            f"{entry}: the ground is no pair of plates; leave count out, or give the ground one thicker part"
        )
    if record.part is None:
        raise CaseError(f"{entry}: the plates of a pair are its part twice, but it has none; name one")
    if forked := [point for point, eye in record.eyes.items() if eye.fork is not None]:
        raise CaseError(
            f"links.{link}.eyes.{forked[0]}.fork: the plates of a pair have no forks; leave fork or count out"
        )
    distance, high = apart(case, link), thickness(record, case.parts)
    assert distance is not None
    body = case.body(link)
    high = max([high or 0.0, *(body.ring(pin).height for pin in body.pins)])
    if not distance > high:
        raise CaseError(
            f"links.{link}.apart: {distance:.4g} mm from mid-plane to mid-plane leave no room between two plates that "
            f"are {high:.4g} mm thick; make it larger"
        )


def _check_between(case: CoreCase, joint: str) -> None:
    """Check that the eyes of a joint with a pair of plates do not run into each other."""
    links = case.joints[joint].links
    pairs = [link for link in links if case.links[link].count == 2]
    if not pairs or not case.joints[joint].kind.has_pin or not all(case.links[link].part for link in links):
        return
    pair = outer_link(case, joint) or pairs[0]
    mate = other_link(case.linkage, joint, pair)
    own, other = eye_of(case, joint, pair), eye_of(case, joint, mate)
    up = case.heights[mate] - case.heights[pair]
    for low, high in own.walls:
        for start, end in other.walls:
            if min(high, up + end) - max(low, up + start) > ROUNDING * own.height:
                room = sum(b - a for a, b in own.gaps)
                lies = f", {up:.4g} mm off the pair's middle" if up else ""
                raise CaseError(
                    f"joints.{joint}: the plates of link '{pair}' leave {room:.4g} mm between them, but the eye of "
                    f"link '{mate}', {other.height:.4g} mm thick{lies}, runs into one; change links.{pair}.apart, or "
                    "the layer or thickness of that eye"
                )


def check_fork(case: CoreCase, joint: str) -> None:
    """Check that the other link's eye fits into the gap of a joint's fork, or between the plates of a pair.

    Parameters
    ----------
    case : CoreCase
    joint : str

    Raises
    ------
    CaseError
        Where it does not, or the gap is not that of an imported part.
    """
    _check_between(case, joint)
    link = outer_link(case, joint)
    if link is None:
        return
    if case.links[link].count == 2:
        if not case.joints[joint].clamped:
            _check_gap(case, joint, link)
        return
    point = case.linkage.point_of(joint, link)
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
    if case.links[mate].part is not None:
        height = eye_of(case, joint, mate).height
        if height > (1.0 + ROUNDING) * fork:
            raise CaseError(
                f"{entry}: its gap of {fork:.4g} mm is less than the {height:.4g} mm of the eye of link '{mate}' that "
                "lies in it; widen the gap, or make that eye thinner"
            )
    _check_gap(case, joint, link)
    if case.links[mate].part is not None and case.linkage.rise(joint) != 0.0:
        raise CaseError(
            f"{entry}: link '{mate}' lies in the fork's gap, so both lie in one layer; give them the same layer or z"
        )


def _check_gap(case: CoreCase, joint: str, link: str) -> None:
    """Check the free length of a pin on either side of what lies in a fork, or between the plates of a pair."""
    record, mate = case.joints[joint], other_link(case.linkage, joint, link)
    gap, (low, high) = record.pin_gap, eye_of(case, joint, link).gaps[0]
    room, is_fork = high - low, case.links[link].count == 1
    name, what = ("fork", "fork's gap") if is_fork else ("plates", "room between the plates")
    if case.links[mate].part is None:
        if not 2.0 * gap < room:
            raise CaseError(
                f"joints.{joint}.pin_gap: {gap:.4g} mm on either side leave nothing of the {what} of {room:.4g} mm "
                f"for link '{mate}'; reduce it"
            )
        return
    free = (room - eye_of(case, joint, mate).height) / 2.0
    if "pin_gap" in record.model_fields_set and abs(gap - free) > ROUNDING * room:
        raise CaseError(
            f"joints.{joint}.pin_gap: it is {gap:.4g} mm, but {name} and eye leave {free:.4g} mm on either "
            "side; leave it out"
        )
