"""What a linkage weighs: its parts, the pins between layers and what links carry, link by link."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.geometry.linkage.pose import Pose
from alula.loads.case.case import Case
from alula.loads.case.layers import pin_masses, pins
from alula.loads.records.check_spec import MassCheck
from alula.loads.states.actions import lasting
from alula.loads.states.masses import laden_masses, part_masses
from alula.loads.text.caveat import Caveat, Topic
from alula.loads.text.reason import Reason, reason

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class LinkWeighed:
    """What a link weighs.

    Attributes
    ----------
    part, pins, carried : float
        Its part, of a pair both plates; the pins that move with it; what it carries besides [tonne].
    """

    part: float = 0.0
    pins: float = 0.0
    carried: float = 0.0

    @property
    def total(self) -> float:
        """All of it [tonne]."""
        return self.part + self.pins + self.carried


@dataclass(frozen=True, kw_only=True)
class Weighed:
    """What a linkage weighs.

    Attributes
    ----------
    links : mapping of str to LinkWeighed
        By link, of those that weigh anything.
    centroid : array (2,)
        Of all of it, in the stated pose and global axes [mm]; NaN where nothing weighs anything.
    not_counted : tuple of Reason
        What else has a mass, in a few words each, with the reason.
    """

    links: Mapping[str, LinkWeighed]
    centroid: Real
    not_counted: tuple[Reason, ...]

    @property
    def total(self) -> LinkWeighed:
        """All links together."""
        kinds = ("part", "pins", "carried")
        return LinkWeighed(**{kind: sum(getattr(own, kind) for own in self.links.values()) for kind in kinds})


def weighed(case: Case, pose: Pose) -> Weighed:
    """Return what a linkage weighs; parts by the geometry kernel, each body once.

    Parameters
    ----------
    case : Case
    pose : Pose
        Of the centroid.

    Returns
    -------
    Weighed

    Raises
    ------
    CaseError
        For a body that cannot be built.
    CannotRunError
        Where the kernel fails.
    """
    parts, pins = part_masses(case), pin_masses(case).values()
    laden, links, moment = laden_masses(case, parts), {}, 0j
    for link, whole in laden.items():
        links[link] = LinkWeighed(
            part=parts[link].mass if link in parts else 0.0,
            pins=sum(pin.mass for pin in pins if pin.link == link),
            carried=sum(carried.mass for carried in case.carried if carried.link == link),
        )
        at = pose.placement.origin(link) + pose.placement.direction(link) * complex(*whole.centroid)
        moment += whole.mass * complex(at)
    total = sum(whole.mass for whole in laden.values())
    centre = moment / total if total > 0.0 else complex(np.nan, np.nan)
    return Weighed(links=links, centroid=np.array([centre.real, centre.imag]), not_counted=unweighed(case))


def unweighed(case: Case) -> tuple[Reason, ...]:
    """Return what has a mass that a case does not tell.

    Parameters
    ----------
    case : Case

    Returns
    -------
    tuple of Reason
        Links that state to be massless are not among it.
    """
    carrying = {carried.link for carried in case.carried}
    told = {*case.checked_links, *case.massless, *carrying}
    found = [reason("link_without_part", link=link) for link in case.links if link not in told]
    found += [reason("wing_without_mass", link=wing.link) for wing in case.wings if wing.link not in carrying]
    found += _pins_left(case) if case.layered else [reason("pins_without_lengths")]
    return (*found, *(reason("spring_or_tendon", kind=one.kind, name=one.name) for one in lasting(case)))


def _pins_left(case: Case) -> Iterator[Reason]:
    """Yield the pins of a layered case that ``pin_masses`` leaves out."""
    known, ground = pin_masses(case), case.linkage.ground
    left = [group for group in pins(case) if not set(group) & set(known)]
    reasons = {True: reason("no_diameter"), False: reason("in_ground_without_part", ground=ground)}
    for unknown, why in reasons.items():
        names = [name for group in left for name in group if (case.joints[name].pin_diameter is None) is unknown]
        if names:
            yield reason("pins_left_out", joints=names, why=why)


def mass_caveats(case: Case) -> Iterator[Caveat]:
    """Yield what a check of the mass leaves out.

    Parameters
    ----------
    case : Case

    Yields
    ------
    Caveat
    """
    if any(isinstance(check, MassCheck) and check.others is None for check in case.all_checks.values()):
        yield from (Caveat(topic=Topic.MASS, what=reason("mass_of", what=what)) for what in unweighed(case))
