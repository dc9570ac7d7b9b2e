"""How a pin sits in the holes of its two links: what a joint states of it by ``clearance``, ``fit``, ``tight_in``."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from alula.geometry.base.errors import CaseError
from alula.geometry.joints.fits import LARGEST, RUNNING, fit
from alula.geometry.joints.joint import Joint
from alula.geometry.joints.pin_entries import PRESS, RUNS, Range, ends_of


class Known(StrEnum):
    """What tells how a pin sits in a hole."""

    PRESSED = "pressed"
    CLEARANCE = "clearance"
    FIT = "fit"
    RUNNING = "running"
    SLOT = "slot"
    NO_PIN = "no pin"
    NOTHING = "nothing"


@dataclass(frozen=True, kw_only=True)
class HolePlay:
    """How much wider than its pin a hole is.

    Attributes
    ----------
    link : str
        Whose hole it is.
    low, high : float
        Least and largest diametral clearance [mm]; of a fit with the rounding of its tables. ``high`` is ∞ where
        nothing is stated and no fit is known at the pin's diameter.
    nominal : float
        The value that counts without a band [mm]: the middle of what is stated or, where nothing is, of a running fit;
        0 where ``high`` is ∞. Of a shared clearance, half of it.
    known : Known
        What tells it.
    """

    link: str
    low: float
    high: float
    nominal: float
    known: Known

    @property
    def stated(self) -> bool:
        """Whether the case states it; a fit that it calls running is assumed to be H8/f7."""
        return self.known is not Known.NOTHING


@dataclass(frozen=True, kw_only=True)
class PinHoles:
    """The two holes in which the pin of a joint sits.

    Attributes
    ----------
    holes : tuple of 2 HolePlay
        In the order of the joint's links.
    shared : tuple of 2 float or None
        Least and largest sum of both clearances [mm], where the case states only that: either hole may have all of it,
        and anything between. None where each hole stands by itself.
    """

    holes: tuple[HolePlay, HolePlay]
    shared: Range | None = None

    def __getitem__(self, link: str) -> HolePlay:
        """Return the hole in one of the links; raises ``KeyError`` for any other."""
        return {hole.link: hole for hole in self.holes}[link]

    @property
    def play(self) -> float:
        """Largest play that the case states of the joint [mm], that of both holes together; 0 where it states none.

        It is the play in the plane, whose bands hold all that is smaller.
        """
        if self.shared is not None:
            return self.shared[1]
        return math.fsum(hole.high for hole in self.holes if hole.stated)


def pin_holes(joint: Joint, slot: float | None = 0.0) -> PinHoles:
    """Return what a joint states of the holes of its pin.

    A plain clearance or fit is that of the hole in which the pin is not tight. A hole of which nothing is stated may be
    anything from pressed to running.

    Parameters
    ----------
    joint : Joint
    slot : float or None, optional
        Clearance across the slot in the first link, of a pin in a slot [mm]; None where nothing is stated.

    Returns
    -------
    PinHoles
        Of a bonded joint and of a slider, which has no pin, without play.
    """
    if joint.fixed or not joint.kind.has_pin:
        known = Known.PRESSED if joint.fixed and not joint.clamped else Known.NO_PIN
        first, second = (_hole(link, known, (0.0, 0.0)) for link in joint.links)
        return PinHoles(holes=(first, second))
    loose, own, plain = loose_links(joint), by_link(joint), _plain(joint)
    if joint.slotted is not None and slot is not None:
        own = {joint.links[0]: (Known.SLOT, (slot, slot))}
    if plain is not None and len(loose) == 2:
        half = 0.5 * _middle(plain)
        first, second = (
            HolePlay(link=link, low=0.0, high=plain[1][1], nominal=half, known=plain[0]) for link in joint.links
        )
        return PinHoles(holes=(first, second), shared=plain[1])
    pressed = {link: (Known.PRESSED, (0.0, 0.0)) for link in joint.bored if link not in loose}
    told = pressed | own | ({} if plain is None else dict.fromkeys(loose, plain))
    first, second = (
        _hole(link, *told[link]) if link in told else _unknown(link, joint.pin_diameter) for link in joint.links
    )
    return PinHoles(holes=(first, second))


def loose_links(joint: Joint) -> list[str]:
    """Return the links whose holes a plain clearance or fit may be about.

    Parameters
    ----------
    joint : Joint

    Returns
    -------
    list of str
        Those in which the pin is not tight; of a pin in a slot, the slot's link is none of them.
    """
    return [link for link in joint.bored if not joint.is_tight_in(link)]


def _hole(link: str, known: Known, ends: Range) -> HolePlay:
    return HolePlay(link=link, low=ends[0], high=ends[1], nominal=_middle((known, ends)), known=known)


def _middle(told: tuple[Known, Range]) -> float:
    return 0.5 * sum(told[1])


def _unknown(link: str, diameter: float | None) -> HolePlay:
    """Return a hole of which nothing is stated: pressed, running, or between."""
    if diameter is None or diameter > LARGEST:
        return HolePlay(link=link, low=0.0, high=math.inf, nominal=0.0, known=Known.NOTHING)
    low, high = fit(RUNNING, diameter).bounds
    return HolePlay(link=link, low=0.0, high=high, nominal=0.5 * (low + high), known=Known.NOTHING)


def largest_clearance(joint: Joint) -> float:
    """Return the largest clearance that a joint states of one hole [mm]; 0 where it states none.

    Parameters
    ----------
    joint : Joint

    Returns
    -------
    float
    """
    plain = _plain(joint)
    return max((ends[1] for _, ends in [*by_link(joint).values(), *([plain] if plain else [])]), default=0.0)


def by_link(joint: Joint) -> dict[str, tuple[Known, Range]]:
    """Return what a joint states of single holes.

    Parameters
    ----------
    joint : Joint

    Returns
    -------
    dict of str to tuple of (Known, tuple of 2 float)
        Link -> what tells it, and its least and largest clearance [mm]; of other links than the joint's as well, where
        it names some.
    """
    clearances = joint.clearance if isinstance(joint.clearance, Mapping) else {}
    fits = joint.fit if isinstance(joint.fit, Mapping) else {}
    return {link: (Known.CLEARANCE, ends_of(stated)) for link, stated in clearances.items()} | {
        link: _of_fit(code, joint) for link, code in fits.items()
    }


def _plain(joint: Joint) -> tuple[Known, Range] | None:
    """Return what a joint states of the one hole in which its pin is not tight."""
    if isinstance(joint.fit, str):
        return _of_fit(joint.fit, joint)
    if joint.clearance is None or isinstance(joint.clearance, Mapping):
        return None
    return Known.CLEARANCE, ends_of(joint.clearance)


def _of_fit(code: str, joint: Joint) -> tuple[Known, Range]:
    if code == PRESS:
        return Known.PRESSED, (0.0, 0.0)
    if joint.pin_diameter is None:
        raise CaseError(f'a fit such as "{RUNNING}" needs the diameter of the pin; add pin_diameter')
    known = Known.RUNNING if code == RUNS else Known.FIT
    return known, fit(RUNNING if code == RUNS else code, joint.pin_diameter).bounds
