"""What makes a number uncertain: the sources of error that a band covers."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

from alula.fea.common.reason import Reason, reason
from alula.loads.records.bearing import CONTACT_SHORTFALL


class SourceKind(StrEnum):
    """Kind of a source of error; its value says for people what it is."""

    DISCRETISATION = "discretisation"
    PIN_PRESSURE = "pin pressure"
    CONTACT = "contact of pin and eye"
    TORQUE_TRANSFER = "transfer of the drive torque"
    CALIBRATION = "calibration of the hand calculation"
    LOAD = "scatter of the load"
    STRENGTH = "scatter of the strength"
    MODULUS = "scatter of the modulus"
    GROWTH = "nonlinear growth with the load"
    IMPERFECTION = "geometric imperfection"
    PATH = "path to the limit load"
    RESTRAINT = "restraint by the neighbouring links"
    SNAP_THROUGH = "snap-through of a shallow toggle"
    EYES = "flexibility of eyes, bores and holes"
    MASS = "place of the mass of fillets"
    EYE_SHARING = "load sharing between the two eyes of a pin"
    COUPLES = "sharing of the couples between layers"
    FLYWHEEL = "energy that a flywheel stores"
    POSES = "what lies between the poses that were looked at"
    CHORDS = "chords in place of arcs"
    PLAY = "play of pins"
    AIR = "air on wings that flap"
    FRICTION = "friction of joints"
    BUILD = "direction of building"
    CLAMP = "edge of a clamp"
    DIRECTION = "direction of the force"
    EYE_FORMULAS = "limit analysis of eyes over the formulas"
    NOTCH_METHOD = "point or line method"
    NOTCH = "notch sensitivity"
    GRIP = "pressure and friction of a press"


UNKNOWN = (math.nan, math.nan)
"""Ends of a source that is no factor, or whose factors nobody knows."""


@dataclass(frozen=True, kw_only=True)
class Source:
    """A source of error.

    Attributes
    ----------
    kind : SourceKind
        What it is.
    detail : Reason or str
        Particulars such as the range that was stated; "" where there are none.
    width : float
        Ratio of the ends of the interval that it gives by itself; NaN where that is not known. It does not make two
        sources differ.
    ends : tuple of float
        Least and largest factor that it puts on the number by itself, where the band is a product of such; else NaN.
        They do not make two sources differ.
    """

    kind: SourceKind
    detail: Reason | str = ""
    width: float = field(default=math.nan, compare=False)
    ends: tuple[float, float] = field(default=UNKNOWN, compare=False)

    @property
    def inverse(self) -> "Source":
        """The same of one over the number."""
        low, high = self.ends
        return replace(self, ends=(_inverse(high), _inverse(low)))

    @property
    def text(self) -> Reason | str:
        """Kind and particulars, for people and files."""
        return reason("source_of_error", kind=self.kind, detail=self.detail) if self.detail else str(self.kind)


PIN_PRESSURE = Source(kind=SourceKind.PIN_PRESSURE, detail=reason("over_half_and_quarter"))
CONTACT = Source(
    kind=SourceKind.CONTACT,
    detail=reason("more_than_pin_pressure", shortfall=CONTACT_SHORTFALL),
    width=1.0 / (1.0 - CONTACT_SHORTFALL),
    ends=(1.0, 1.0 / (1.0 - CONTACT_SHORTFALL)),
)
TORQUE_TRANSFER = Source(kind=SourceKind.TORQUE_TRANSFER, detail=reason("by_faces_and_bore"))

COUPLES = (Source(kind=SourceKind.COUPLES, detail=reason("tight_or_tilting_pins")),)


def air_source(least: float, largest: float) -> Source:
    """Return the range of the normal coefficient of wings as a source of error.

    Parameters
    ----------
    least, largest : float
        C_N.

    Returns
    -------
    Source
    """
    return Source(kind=SourceKind.AIR, detail=reason("normal_coefficients", least=least, largest=largest))


def widest(sources: tuple[Source, ...], width: float) -> tuple[Source, ...]:
    """Return the sources that the largest part of a band comes from.

    Parts are factors, which multiply to the ratio of the band's ends. Sources of unknown width have together what the
    others leave.

    Parameters
    ----------
    sources : tuple of Source
        Of the band.
    width : float
        Ratio of its ends, at least 1.

    Returns
    -------
    tuple of Source
        One, or several whose widths are not known one by one; none where the band has no width.
    """
    known = [source for source in sources if not math.isnan(source.width)]
    others = tuple(source for source in sources if math.isnan(source.width))
    if not sources or width <= 1.0:
        return ()
    most = max(known, key=lambda source: source.width, default=None)
    if most is None:
        return others
    left = width / math.prod(source.width for source in known)
    return others if others and left > most.width else (most,)


def pin_sources(*, driven: bool) -> tuple[Source, ...]:
    """Return what a solid model does not know of the stress beside a link's pins.

    Parameters
    ----------
    driven : bool
        True where a drive torque acts on the link.

    Returns
    -------
    tuple of Source
    """
    return (PIN_PRESSURE, CONTACT, *((TORQUE_TRANSFER,) if driven else ()))


def play_source(clearances: Mapping[str, float]) -> Source:
    """Return the play of joints as a source of error.

    Parameters
    ----------
    clearances : mapping of str to float
        Joint -> its play [mm].

    Returns
    -------
    Source
    """
    ends = min(clearances.values()), max(clearances.values())
    return Source(kind=SourceKind.PLAY, detail=reason("play_at_joints", ends=ends, joints=tuple(clearances)))


def friction_source(ranges: Mapping[str, tuple[float, float]]) -> Source:
    """Return the friction of joints as a source of error.

    Parameters
    ----------
    ranges : mapping of str to tuple of float
        Joint -> its least and largest coefficient.

    Returns
    -------
    Source
    """
    alike: dict[tuple[float, float], list[str]] = {}
    for name, ends in ranges.items():
        alike.setdefault(ends, []).append(name)
    said = [reason("friction_range", low=low, high=high, joints=joints) for (low, high), joints in alike.items()]
    return Source(kind=SourceKind.FRICTION, detail=reason("friction_at_joints", ranges=said))


def distinct(*groups: tuple[Source, ...]) -> tuple[Source, ...]:
    """Join sources, each once, with its largest width and its nearest ends, in the order in which they first stand.

    Nearest ends take no more from a band than each of its parts holds.

    Parameters
    ----------
    groups : tuple of Source
        The sources of several bands.

    Returns
    -------
    tuple of Source
    """
    found: dict[Source, Source] = {}
    for source in (source for group in groups for source in group):
        known = found.get(source)
        if known is None:
            found[source] = source
            continue
        widest = source if source.width > known.width or math.isnan(known.width) else known
        (low, high), (least, most) = known.ends, source.ends
        open_ends = any(map(math.isnan, (*known.ends, *source.ends)))
        found[source] = replace(widest, ends=UNKNOWN if open_ends else (max(low, least), min(high, most)))
    return tuple(found.values())


def _inverse(end: float) -> float:
    return 1.0 / end if end != 0.0 else math.inf
