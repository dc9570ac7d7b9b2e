"""What the range of C_N of wings that flap makes of the numbers of a check, by hand calculation.

Statics, frame and the hand calculation of every link are done again at the ends of the range. Forces without friction
are affine in C_N. Hence stress, displacement and the inverse of a buckling factor are convex in it: their largest is at
an end, and for the least the ends and the stated C_N give a bound (``fea.common.convex``). Over the number at the
stated C_N, these are shares by which bands of all models are widened.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from fea.buckling.buckling import least_factor
from fea.check.fidelity import hand_bands
from fea.check.link_by_hand import LinkByHand, cut_link, plates_by_hand
from fea.check.load_growth import LEAST, Growths
from fea.check.solid_result import link_task
from fea.common.convex import least_of_convex
from fea.common.link_loads import LinkLoads
from fea.common.scatter import Scatter
from fea.common.source import air_source
from fea.common.verdict import CheckOutcome, Quantity
from fea.frame.case_statics import CaseStatics, solve_case_statics
from fea.nonlinear.large_displacement import LEAST_FACTOR, LargeDisplacement, examine
from loads.case.case import Case
from loads.states.flapping import in_air
from loads.statics.statics import Reactions

FAR = 2.0 * LEAST_FACTOR
"""Factor to buckling from which it is taken to fall as the largest joint force grows, and not computed again."""

Plates = Sequence[tuple[LinkLoads, LinkByHand]]


@dataclass(frozen=True, kw_only=True, eq=False)
class OtherAir:
    """A load case at one C_N.

    Attributes
    ----------
    case : Case
    coefficient : float
        C_N.
    moved : LargeDisplacement
    reactions : Reactions
        In the undeformed pose.
    plates : mapping of str to sequence of tuple of (LinkLoads, LinkByHand)
        Link -> its hand calculation; of a pair that of either plate.
    """

    case: Case
    coefficient: float
    moved: LargeDisplacement
    reactions: Reactions
    plates: Mapping[str, Plates]

    @classmethod
    def of(cls, statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> "OtherAir":
        """Return a load case with what is calculated of it by hand.

        Parameters
        ----------
        statics : CaseStatics
        load_case : str
            Its name; it has air.
        moved : LargeDisplacement
            What became of it.

        Returns
        -------
        OtherAir
        """
        case, loads = statics.standing[load_case].case, statics.loads[load_case]
        reactions, air = statics.reactions[load_case], case.load_cases[load_case].flapping
        assert air is not None
        return cls(
            case=case,
            coefficient=air.normal_coefficient,
            moved=moved,
            reactions=moved.reactions or reactions,
            plates={
                link: plates_by_hand(case, link, cut_link(case, link, load_case, moved, reactions, loads))
                for link in case.checked_links
            },
        )

    @cached_property
    def numbers(self) -> dict[str, tuple[float, float, float]]:
        """Link -> stress [MPa], displacement [mm] and inverse of the buckling factor, each of its worse plate.

        Of a link without beam the largest pin force three times [N].
        """
        return {link: self._numbers(link) for link in self.plates}

    def _numbers(self, link: str) -> tuple[float, float, float]:
        plates = self.plates[link]
        if plates[0][1].check.without:
            force = max(float((pin.wrench[:3] ** 2).sum()) ** 0.5 for loads, _ in plates for pin in loads.pins)
            return force, force, force
        told = [
            (*self._strained(link, *plate), 1.0 / least_factor(self.case, link, plate[1].check)) for plate in plates
        ]
        stress, displacement, inverse = (max(column) for column in zip(*told, strict=True))
        return stress, displacement, inverse

    def _strained(self, link: str, loads: LinkLoads, hand: LinkByHand) -> tuple[float, float]:
        """Return stress and displacement of a plate: the upper ends of the calibrated bands, where there are some."""
        bands = hand_bands(link_task(self.case, link, [loads]), loads, hand.check)
        if bands.outside:
            return hand.worst[1].equivalent, hand.displacement
        brittle = self.case.material_of(link).brittle
        return (bands.principal if brittle else bands.von_mises).high, bands.displacement.high


@dataclass(frozen=True, kw_only=True, eq=False)
class AirDoubt:
    """A load case at the stated C_N and at others of its range; at none where C_N has no range.

    Attributes
    ----------
    ends : tuple of float
        Least and largest C_N.
    stated : OtherAir or None
        At the stated C_N.
    others : tuple of OtherAir
        At others, both ends among them.
    """

    ends: tuple[float, float] = (0.0, 0.0)
    stated: OtherAir | None = None
    others: tuple[OtherAir, ...] = ()

    @classmethod
    def of(cls, statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> "AirDoubt":
        """Calculate a load case over the range of its C_N.

        Parameters
        ----------
        statics : CaseStatics
        load_case : str
            Its name.
        moved : LargeDisplacement
            What became of it at the stated C_N.

        Returns
        -------
        AirDoubt
        """
        air = statics.case.load_cases[load_case].flapping
        if air is None or air.ends[0] == air.ends[1]:
            return cls()
        alone = statics.case.model_copy(
            update={"load_cases": {load_case: statics.case.load_cases[load_case]}, "published_statics": None}
        )
        shares = (0.0, 1.0) if air.normal_coefficient not in air.ends else (0.0, 0.5, 1.0)
        others = [solve_case_statics(in_air(alone, share)) for share in shares]
        return cls(
            ends=air.ends,
            stated=OtherAir.of(statics, load_case, moved),
            others=tuple(OtherAir.of(other, load_case, _shape(statics, other, load_case, moved)) for other in others),
        )

    def _scatter(self, number: Callable[[OtherAir], float]) -> Scatter:
        """Return what the range makes of a number that is convex in C_N."""
        assert self.stated is not None
        value = number(self.stated)
        others = {one.coefficient: number(one) for one in self.others}
        return air_scatter((self.stated.coefficient, value), others, self.ends)

    @property
    def growths(self) -> Growths:
        """By how much stress, displacement of links and joint forces may differ."""
        if self.stated is None:
            return Growths()

        def of_link(link: str, i: int) -> Scatter:
            return self._scatter(lambda air: air.numbers[link][i])

        def of_joint(name: str) -> Scatter:
            return self._scatter(lambda air: air.reactions.joints[name].magnitude)

        stress, displacement = ({link: of_link(link, i) for link in self.stated.plates} for i in (0, 1))
        joints = {name: of_joint(name) for name in self.stated.reactions.joints}
        return Growths(stress=_open(stress), displacement=_open(displacement), joints=_open(joints))

    def slenderest(self, case: Case, link: str, plates: Plates) -> Plates:
        """Return the plates of a link of which the slenderest is judged as a column: at another C_N where none buckles.

        Parameters
        ----------
        case : Case
        link : str
        plates : sequence of tuple of (LinkLoads, LinkByHand)
            At the stated C_N.

        Returns
        -------
        sequence of tuple of (LinkLoads, LinkByHand)
        """
        buckles = not self.others or any(least_factor(case, link, hand.check) < float("inf") for _, hand in plates)
        return plates if buckles else (*plates, *(plate for air in self.others for plate in air.plates[link]))

    def on_buckling(self, outcome: CheckOutcome) -> CheckOutcome:
        """Return an outcome with the range of C_N in its band, where it is a buckling factor of a link or the linkage.

        Parameters
        ----------
        outcome : CheckOutcome

        Returns
        -------
        CheckOutcome
        """
        if self.stated is None or outcome.quantity is not Quantity.BUCKLING_FACTOR or outcome.value.unknowable:
            return outcome
        link = outcome.subject.name if outcome.subject.kind == "link" else ""
        spread = self._scatter(lambda air: air.numbers[link][2] if link else 1.0 / (air.moved.factor or float("inf")))
        if spread.high == float("inf"):  # no compression at the stated C_N: the outcome is that of the worst other
            spread = Scatter(low=0.0, sources=spread.sources)
        return widened(outcome, spread)

    def on_shape(self, moved: LargeDisplacement) -> LargeDisplacement:
        """Return what became of a load case with what becomes of it at other C_N.

        Parameters
        ----------
        moved : LargeDisplacement

        Returns
        -------
        LargeDisplacement
        """
        if self.stated is None:
            return moved
        airs = tuple((air.coefficient, air.moved) for air in self.others)
        stated = (self.stated.coefficient, self.stated.moved)
        return replace(moved, air=air_source(*self.ends), airs=(stated, *airs))


def air_scatter(stated: tuple[float, float], others: Mapping[float, float], ends: tuple[float, float]) -> Scatter:
    """Return what the range of C_N makes of a number that is convex in it and not negative.

    Parameters
    ----------
    stated : tuple of (float, float)
        The stated C_N, and the number there.
    others : mapping of float to float
        Other C_N, both ends of the range among them -> the number there.
    ends : tuple of float
        Of the range.

    Returns
    -------
    Scatter
        On the number at the stated C_N; without upper end where that is zero, and others are not.
    """
    found, value = {**others, stated[0]: stated[1]}, stated[1]
    most, least = max(found.values()), max(least_of_convex(found.items()), 0.0)
    if most <= 0.0:
        return Scatter()
    low, high = (least / value, most / value) if value > 0.0 else (1.0, float("inf"))
    return Scatter(low=min(low, 1.0), high=max(high, 1.0), sources=(air_source(*ends),))


def widened(outcome: CheckOutcome, spread: Scatter, cause: str = "C_N") -> CheckOutcome:
    """Return the outcome of a buckling factor with what something makes of the compression in its band.

    Parameters
    ----------
    outcome : CheckOutcome
    spread : Scatter
        Of the inverse of the factor.
    cause : str, optional
        What that is, for people; the range of C_N unless given.

    Returns
    -------
    CheckOutcome
    """
    if not spread.sources:
        return outcome
    band, reason = spread.inverse.on(outcome.value), outcome.reason
    found = CheckOutcome.of(
        outcome.name, outcome.subject, outcome.load_case, outcome.quantity, band, outcome.limit, reason
    )
    return found if found.verdict is outcome.verdict else found.because(f"{reason}; {cause} may change this")


def _shape(statics: CaseStatics, other: CaseStatics, load_case: str, moved: LargeDisplacement) -> LargeDisplacement:
    """Return what becomes of a load case at another C_N."""
    case, forces, loads = other.standing[load_case].case, other.forces[load_case], other.loads[load_case]
    plain, changed = (one.reactions[load_case].joints for one in (statics, other))
    most = max(joint.magnitude for joint in plain.values())
    grown = max(joint.magnitude for joint in changed.values()) / most if most > 0.0 else float("inf")
    far = moved.buckling is not None and moved.buckling / grown >= FAR
    return examine(case, load_case, forces, loads, moved.buckling / grown if moved.buckling and far else None)


def _open(found: Mapping[str, Scatter]) -> dict[str, Scatter]:
    return {name: one for name, one in found.items() if one.high - one.low > LEAST}


def air_warnings(moved: Mapping[str, LargeDisplacement]) -> list[str]:
    """Return what the reader must know about the range of C_N, a sentence each.

    Parameters
    ----------
    moved : mapping of str to LargeDisplacement
        Load case -> from ``AirDoubt.on_shape``.

    Returns
    -------
    list of str
    """
    return [
        f"load case {load_case}: with C_N = {coefficient:g}, {other.sentence}"
        for load_case, one in moved.items()
        for coefficient, other in one.airs[1:]
        if other.gives_way and not one.gives_way
    ]
