"""Verdicts: pass, fail, or undecided where the error band straddles the limit."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import Enum, StrEnum
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.decided import decided_by
from alula.fea.common.reason import Reason, reason, together


class Verdict(StrEnum):
    """The answer of a check."""

    PASS = "pass"
    FAIL = "fail"
    UNDECIDED = "undecided"

    @property
    def exit_status(self) -> int:
        """Status of the command that ends with this verdict."""
        return {"pass": 0, "fail": 1, "undecided": 3}[self.value]


Ends = float | NDArray[np.float64]
Origin = Literal["loads", "motor", "shape", "vibration"]
"""Where a number comes from; what comes from the shape is the same under every load case, and stands with the first."""
Sided = bool | NDArray[np.bool_] | np.bool_
_DECISIVE = (Verdict.FAIL, Verdict.UNDECIDED, Verdict.PASS)
"""Of several checks, the first of these that any of them has is the verdict of all."""


class Sense(Enum):
    """On which side of its limit a quantity must be; the value is the sign that people read."""

    AT_LEAST = "≥"
    AT_MOST = "≤"

    def verdict(self, value: Band, limit: float) -> Verdict:
        """Decide on the whole band whether a number is on the safe side of its limit.

        Parameters
        ----------
        value : Band
            The number; where it is not known, the verdict is undecided.
        limit : float
            In the unit of the number.

        Returns
        -------
        Verdict
        """
        kept, missed = self.sides(value.low, value.high, limit)
        return Verdict.PASS if kept else Verdict.FAIL if missed else Verdict.UNDECIDED

    def sides(self, low: Ends, high: Ends, limit: float) -> tuple[Sided, Sided]:
        """Tell whether a band keeps its limit as a whole, and whether it misses it as a whole.

        Parameters
        ----------
        low, high : float or ndarray
            Ends of a band, or of those of several poses or samples; NaN where they are not known.
        limit : float
            In the unit of the number.

        Returns
        -------
        tuple of 2 bool or ndarray of bool
            Both False where it is open.
        """
        if self is Sense.AT_LEAST:
            return low >= limit, high < limit
        return high <= limit, low > limit

    def worst(self, bands: Sequence[Band]) -> Band:
        """Return the band of the worst of several numbers, such as those of the poses of a motion.

        Parameters
        ----------
        bands : sequence of Band
            At least one.

        Returns
        -------
        Band
            Not known where one of them is not.
        """
        return (Band.least if self is Sense.AT_LEAST else Band.largest)(bands)


class Tier(StrEnum):
    """What a check asks of strength: that nothing yields, that nothing breaks or gives way, or neither."""

    ELASTIC = "stays elastic"
    BREAK = "does not break"
    NEITHER = "neither"
    """Stiffness, shape, vibration, motor."""


class Quantity(StrEnum):
    """What is set against a limit: its name, as text, with its unit ("" for a pure number), its sense and origin.

    Last come the types of checks that it stands for, as a case states them.
    """

    unit: str
    sense: Sense
    origin: Origin
    checks: tuple[str, ...]

    def __new__(cls, name: str, unit: str, sense: Sense, origin: Origin = "loads", *checks: str) -> "Quantity":
        """Return a member that is its name."""
        found = str.__new__(cls, name)
        found._value_, found.unit, found.sense, found.origin, found.checks = name, unit, sense, origin, checks
        return found

    @classmethod
    def of_check(cls, kind: str) -> "Quantity":
        """Return the quantity that stands for a type of checks.

        Parameters
        ----------
        kind : str
            As a case states it.

        Returns
        -------
        Quantity
        """
        return next(one for one in cls if kind in one.checks)

    SAFETY_FACTOR = "safety factor", "", Sense.AT_LEAST, "loads", "safety-factor", "pins", "bearing"
    LAYERS = "safety factor of the layers", "", Sense.AT_LEAST
    """Of a printed part: against tension normal to its layers and shear along them."""
    EYES = "safety factor of the eyes", "", Sense.AT_LEAST, "loads", "eye"
    """Of a link: what the weakest mode of its weakest eye bears over the force of the pin."""
    WALLS = "buckling factor of thin walls", "", Sense.AT_LEAST, "loads", "wall"
    """Of a link: by what its loads may grow until its wall buckles, it flattens, or it turns aside as a deep strip."""
    LINE_CONTACT = "safety factor of line contact", "", Sense.AT_LEAST, "loads", "line-contact"
    """Of a pin on the flank of its slot: against yield below the line, or on its largest pressure."""
    CONNECTION = "safety factor of the connection", "", Sense.AT_LEAST, "loads", "connection"
    """Of what fixes a link at a joint: what its weakest mode bears over what goes through it."""
    SUSTAINED_STRESS = "sustained stress", "MPa", Sense.AT_MOST, "loads", "sustained"
    DEFLECTION = "deflection from its pins", "mm", Sense.AT_MOST
    """Of a link by itself: displacement from the line through its own pins, as if these stayed."""
    DISPLACEMENT = "displacement", "mm", Sense.AT_MOST
    """Of a point, with the whole linkage."""
    BUCKLING_FACTOR = "buckling factor", "", Sense.AT_LEAST
    LOAD_SHARE = "share of the load that is held", "", Sense.AT_LEAST
    LIMIT_LOAD = "limit-load factor", "", Sense.AT_LEAST, "loads", "limit-load"
    """By what all loads may grow until the linkage gives way."""
    PLASTIC_COLLAPSE = "plastic-collapse factor", "", Sense.AT_LEAST, "loads", "plastic-collapse"
    """By what all loads on a link may grow until it flows without end, or to its material's largest strain."""
    PERMANENT_SET = "permanent set", "mm", Sense.AT_MOST, "loads", "permanent-set"
    """Of the linkage: how far the point of entry of its load stays displaced along it, once it is gone."""
    NOTCHES = "safety factor of the notches", "", Sense.AT_LEAST, "loads", "notch"
    """Of a brittle link: by what its loads may grow until it breaks at a notch, by critical distance and by volume."""
    FATIGUE_STRESS = "fatigue, stress", "", Sense.AT_LEAST, "loads", "fatigue"
    """Fatigue strength over stress."""
    FATIGUE_LIFE = "fatigue, life", "", Sense.AT_LEAST
    """Life over the repetitions that are wanted."""
    CLEARANCE = "clearance", "mm", Sense.AT_LEAST, "shape", "clearance"
    """Least gap between outlines that lie at one height; negative where they lie in each other."""
    LAYER_GAP = "gap between layers", "mm", Sense.AT_LEAST
    """Least gap along the pins that deflection and tilting pins leave between links that pass over each other."""
    FREQUENCY_RATIO = "natural over driving frequency", "", Sense.AT_LEAST, "vibration", "frequency"
    """The lowest natural frequency over the motion, over that of the drive."""
    DRIVE_POWER = "drive power", "W", Sense.AT_MOST, "motor"
    DRIVE_SPEED = "drive speed", "rpm", Sense.AT_MOST, "motor"
    DRIVE_TORQUE = "drive torque over time", "N·mm", Sense.AT_MOST, "motor"
    TORQUE_SHARE = "share of the motor's torque at its speed", "", Sense.AT_MOST, "motor"
    MASS = "total mass", "g", Sense.AT_MOST, "shape", "mass"
    SIZE_X = "size along x", "mm", Sense.AT_MOST, "shape"
    """Of the box about the linkage over all poses."""
    SIZE_Y = "size along y", "mm", Sense.AT_MOST, "shape"
    SIZE_Z = "size along z", "mm", Sense.AT_MOST, "shape"

    @property
    def unloaded(self) -> bool:
        """True where it does not come from loads; they change frequencies alone, as far as they tighten links."""
        return self.origin in ("shape", "vibration")

    @property
    def tier(self) -> Tier:
        """What it asks of strength; a safety factor against ultimate strength is of breaking (``asked.tiers``).

        Line contact is judged by first yield below the line.

        What loads make of a link breaks it or lets it give way, but for lengths, which are of stiffness.
        """
        if self in (Quantity.SAFETY_FACTOR, Quantity.LINE_CONTACT):
            return Tier.ELASTIC
        return Tier.BREAK if self.origin == "loads" and self.unit != "mm" else Tier.NEITHER

    def margins(self, value: float, low: float, high: float, limit: float) -> tuple[float, float, float]:
        """Return by what factor a banded number keeps its limit: 1 at the limit, less where it misses it.

        It is the number over the limit where it must be at least that, and the limit over the number where it must be
        at most that. A share of the load that is held in full says no more, so that its margin is infinite.

        Parameters
        ----------
        value, low, high : float
            The number and the ends of its band.
        limit : float
            In the unit of the number.

        Returns
        -------
        tuple of float
            Of the value, of the unfavourable and of the favourable end; from 0 to infinity where the band is not known,
            with NaN where the value is not.
        """
        if math.isnan(value) or math.isnan(limit):
            return math.nan, 0.0, math.inf
        if math.isnan(low) or math.isnan(high):
            return self.margins(value, value, value, limit)[0], 0.0, math.inf
        if self.sense is Sense.AT_MOST:
            value, high, low = (limit / end if end > 0.0 else math.inf for end in (value, low, high))
            return value, low, high
        whole = limit if self is Quantity.LOAD_SHARE else math.inf
        value, low, high = (_share(end, limit) if end < whole else math.inf for end in (value, low, high))
        return value, low, high


def _share(value: float, limit: float) -> float:
    """Return by what factor a value keeps a least one; 0 where it is negative, infinite where any is enough."""
    if value < 0.0:
        return 0.0
    return value / limit if limit > 0.0 else math.inf


FATIGUE_QUANTITIES = (Quantity.FATIGUE_STRESS, Quantity.FATIGUE_LIFE)
SIZES = (Quantity.SIZE_X, Quantity.SIZE_Y, Quantity.SIZE_Z)
UNLOADED_QUANTITIES = tuple(quantity for quantity in Quantity if quantity.unloaded)
"""What does not come from loads."""
MOTOR_QUANTITIES = tuple(quantity for quantity in Quantity if quantity.origin == "motor")
"""What is asked of a motor over the motion of a rigid linkage."""

_FACTORS = (Quantity.SAFETY_FACTOR, Quantity.LAYERS, Quantity.EYES)
"""Strength over stress, whose bands are products of what each source makes of them."""
_OF_LOADED_LINKAGE = (Quantity.LIMIT_LOAD, Quantity.PERMANENT_SET)
"""Of the linkage as a whole, which may miss their limits while it holds its load."""


@dataclass(frozen=True)
class Subject:
    """What a check is about; its text is what files and tables show.

    Attributes
    ----------
    kind : {"link", "pin", "joint", "point", "the linkage"}
    name : str
        Of the link; of the joint, also for its pin; ``"H of CH"`` for a point; none for the linkage.
    """

    kind: Literal["link", "pin", "joint", "point", "the linkage"]
    name: str = ""

    @classmethod
    def link(cls, name: str) -> "Subject":
        """Return the link of that name.

        Parameters
        ----------
        name : str

        Returns
        -------
        Subject
        """
        return cls("link", name)

    @classmethod
    def pin(cls, joint: str) -> "Subject":
        """Return the pin of a joint.

        Parameters
        ----------
        joint : str

        Returns
        -------
        Subject
        """
        return cls("pin", joint)

    @classmethod
    def joint(cls, joint: str) -> "Subject":
        """Return a joint, for what fixes its links to each other.

        Parameters
        ----------
        joint : str

        Returns
        -------
        Subject
        """
        return cls("joint", joint)

    @classmethod
    def point(cls, name: str, link: str) -> "Subject":
        """Return a point of a link.

        Parameters
        ----------
        name, link : str

        Returns
        -------
        Subject
        """
        return cls("point", f"{name} of {link}")

    def __str__(self) -> str:
        """Return the bare name of a link, ``pin A``, ``point H of CH`` or ``the linkage``."""
        return self.name if self.kind == "link" else self.long

    @property
    def long(self) -> str:
        """The text in a sentence: ``link CH`` for a link, too."""
        return f"{self.kind} {self.name}".rstrip()


LINKAGE = Subject("the linkage")
"""All links together."""


@dataclass(frozen=True, kw_only=True)
class CheckOutcome:
    """One check of one subject under one load case; ``CheckOutcome.of`` decides it.

    Attributes
    ----------
    name : str
        Of the check, as the case names it.
    subject : Subject
        What it is about.
    load_case : str
    quantity : Quantity
        What was set against the limit, with its unit and sense.
    value : Band
    limit : float
        In the unit of the quantity, as the value.
    verdict : Verdict
    reason : Reason or str
        Says why the verdict is what it is.
    applies : bool
        False where there is nothing to judge, such as a stress where the linkage gives way; undecided then.
    """

    name: str
    subject: Subject
    load_case: str
    quantity: Quantity
    value: Band
    limit: float
    verdict: Verdict
    reason: Reason | str
    applies: bool = True

    @classmethod
    def of(
        cls,
        name: str,
        subject: Subject,
        load_case: str,
        quantity: Quantity,
        value: Band,
        limit: float,
        reason: Reason | str = "",
    ) -> "CheckOutcome":
        """Decide a check on its whole band.

        Parameters
        ----------
        name, subject, load_case, quantity, value, limit
            As the attributes.
        reason : Reason or str, optional
            By default where the band lies beside the limit.

        Returns
        -------
        CheckOutcome
        """
        verdict = quantity.sense.verdict(value, limit)
        return cls(
            name=name,
            subject=subject,
            load_case=load_case,
            quantity=quantity,
            value=value,
            limit=limit,
            verdict=verdict,
            reason=reason or reason_for(value, limit, quantity),
        )

    def because(self, reason: Reason | str) -> "CheckOutcome":
        """Return the outcome with another reason.

        Parameters
        ----------
        reason : Reason or str

        Returns
        -------
        CheckOutcome
        """
        return replace(self, reason=reason)

    def left_open(self, reason: Reason | str) -> "CheckOutcome":
        """Return the outcome undecided whatever its band says.

        Parameters
        ----------
        reason : Reason or str

        Returns
        -------
        CheckOutcome
        """
        return replace(self, verdict=Verdict.UNDECIDED, reason=reason, applies=True)

    def not_applicable(self, reason: Reason | str) -> "CheckOutcome":
        """Return the outcome undecided, since there is nothing to judge.

        Parameters
        ----------
        reason : Reason or str

        Returns
        -------
        CheckOutcome
        """
        return replace(self, verdict=Verdict.UNDECIDED, reason=reason, applies=False)

    @property
    def link(self) -> str:
        """The subject as text: a link's own name, ``pin A``, ``point H of CH`` or ``the linkage``."""
        return str(self.subject)

    @property
    def answer(self) -> str:
        """What people read: the verdict, or ``not applicable``."""
        return self.verdict.value if self.applies else "not applicable"

    @property
    def margin(self) -> float:
        """By what factor the unfavourable end of its band keeps the limit: 1 at the limit, 0 where it is not known."""
        return self.quantity.margins(self.value.value, self.value.low, self.value.high, self.limit)[1]

    @property
    def gives_way(self) -> bool:
        """True where it says that the linkage as a whole does not hold the load."""
        quantity = self.quantity
        asked = self.subject == LINKAGE and quantity not in _OF_LOADED_LINKAGE and not quantity.unloaded
        return asked and self.verdict is Verdict.FAIL

    @property
    def shared(self) -> bool:
        """True where it is the same under every load case, and stands with the first one for all of them."""
        return self.quantity.origin == "shape"

    @property
    def unit(self) -> str:
        """Unit of value and limit; "" for a pure number."""
        return self.quantity.unit

    @property
    def at_least(self) -> bool:
        """True where the quantity must be at least its limit, False where it must be at most that."""
        return self.quantity.sense is Sense.AT_LEAST


def by_nearness(checks: Iterable[CheckOutcome]) -> list[CheckOutcome]:
    """Return checks in the order of their verdicts, fail, undecided, pass; of each the nearest to its limit first.

    Numbers of which only is known that they are at least so large come behind those alike: how near they are nobody
    knows. Those that are not applicable come last.

    Parameters
    ----------
    checks : iterable of CheckOutcome

    Returns
    -------
    list of CheckOutcome
    """

    def order(check: CheckOutcome) -> tuple[bool, int, bool, float]:
        return not check.applies, _DECISIVE.index(check.verdict), check.value.least_alone, check.margin

    return sorted(checks, key=order)


def deciding(checks: Iterable[CheckOutcome]) -> list[CheckOutcome]:
    """Return the checks that have the verdict of all, that first which the headline names.

    Parameters
    ----------
    checks : iterable of CheckOutcome

    Returns
    -------
    list of CheckOutcome
        Of what fails a linkage that gives way first, at the least share of its load; else by nearness to the limit.
    """
    checks = list(checks)
    verdict = overall(check.verdict for check in checks)
    alike = [check for check in checks if check.verdict is verdict]
    found = [check for check in alike if check.applies] or alike
    lost = [check for check in found if check.quantity is Quantity.LOAD_SHARE and verdict is Verdict.FAIL]
    lost.sort(key=lambda check: check.value.value)
    return lost + by_nearness(check for check in found if check not in lost)


def worst_of_each(checks: Iterable[CheckOutcome]) -> list[CheckOutcome]:
    """Return the checks that can be judged, each under its worst load case alone; those that decide come first.

    Parameters
    ----------
    checks : iterable of CheckOutcome

    Returns
    -------
    list of CheckOutcome
        In the order of ``deciding``, then of ``by_nearness``.
    """
    checks = list(checks)
    first = deciding(checks)
    chosen = {id(check) for check in first}
    found: dict[tuple[str, Subject, Quantity], CheckOutcome] = {}
    for check in (*first, *by_nearness(check for check in checks if id(check) not in chosen)):
        if check.applies:
            key = check.name, check.subject, check.quantity
            worst = found.setdefault(key, check)
            if check.value.least_alone and check.verdict is worst.verdict and check.margin < worst.margin:
                found[key] = check  # no more is known of it
    return list(found.values())


def reason_for(value: Band, limit: float, quantity: Quantity) -> Reason | str:
    """Return why a band gives its verdict, and where it is open what would decide it.

    Parameters
    ----------
    value : Band
    limit : float
        In the unit of the value.
    quantity : Quantity

    Returns
    -------
    Reason or str
    """
    verdict = quantity.sense.verdict(value, limit)
    if value.unknowable or math.isnan(value.low):
        return value.without or reason("not_known")
    kind = {Verdict.UNDECIDED: "band_holds_limit", Verdict.PASS: "band_keeps_limit", Verdict.FAIL: "band_misses_limit"}
    return together(
        reason(kind[verdict], low=value.low, high=value.high, limit=limit), what_decides(value, limit, quantity)
    )


def what_decides(value: Band, limit: float, quantity: Quantity) -> Reason | str:
    """Return which single thing would decide a check that is open.

    Parameters
    ----------
    value, limit, quantity
        As of ``reason_for``.

    Returns
    -------
    Reason or str
        "" where its band does not hold the limit.
    """
    if value.unknowable or quantity.sense.verdict(value, limit) is not Verdict.UNDECIDED:
        return ""
    return decided_by(value, limit, factors=quantity in _FACTORS)


def overall(verdicts: Iterable[Verdict]) -> Verdict:
    """Return fail where any check fails, else undecided where any is; nothing checked is undecided.

    Parameters
    ----------
    verdicts : iterable of Verdict
        Of all checks.

    Returns
    -------
    Verdict
    """
    found = set(verdicts)
    for verdict in _DECISIVE:
        if verdict in found:
            return verdict
    return Verdict.UNDECIDED
