"""A load case once more under another condition that may be: in other air, with other friction; and what it changes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

from alula.fea.buckling.buckling import least_factor
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import reason, together
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source
from alula.fea.common.verdict import CheckOutcome, Quantity
from alula.fea.doubts.load_growth import Growths, telling
from alula.fea.links.fidelity import hand_bands
from alula.fea.links.link_by_hand import LinkByHand, every_plate_by_hand
from alula.fea.links.solid_result import link_task
from alula.fea.nonlinear.large_displacement import LEAST_FACTOR, LargeDisplacement, examine
from alula.fea.standing.case_statics import CaseStatics
from alula.fea.superposition.link_answers import LinkAnswers
from alula.loads.case.case import Case
from alula.loads.statics.statics import Reactions

FAR = 2.0 * LEAST_FACTOR
"""Factor to buckling from which it is taken to fall as the largest joint force grows, and not computed again."""

Plates = Sequence[tuple[LinkLoads, LinkByHand]]


@dataclass(frozen=True, kw_only=True, eq=False)
class OtherCase:
    """A load case under one of several conditions that may be, with its hand calculation.

    Attributes
    ----------
    case : Case
    moved : LargeDisplacement
    reactions : Reactions
        In the undeformed pose.
    plates : mapping of str to sequence of tuple of (LinkLoads, LinkByHand)
        Link -> its hand calculation; of a pair that of either plate.
    """

    case: Case
    moved: LargeDisplacement
    reactions: Reactions
    plates: Mapping[str, Plates]

    @classmethod
    def of(cls, statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> "OtherCase":
        """Return a load case with what is calculated of it by hand.

        Parameters
        ----------
        statics : CaseStatics
        load_case : str
            Its name.
        moved : LargeDisplacement
            What became of it.

        Returns
        -------
        OtherCase
        """
        case, loads = statics.standing[load_case].case, statics.loads[load_case]
        reactions = statics.reactions[load_case]
        return cls(
            case=case,
            moved=moved,
            reactions=moved.reactions or reactions,
            plates=every_plate_by_hand(case, load_case, moved, reactions, loads),
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


def shape_of(statics: CaseStatics, other: CaseStatics, load_case: str, moved: LargeDisplacement) -> LargeDisplacement:
    """Return what becomes of a load case under another condition.

    Parameters
    ----------
    statics : CaseStatics
        As stated.
    other : CaseStatics
        Under that condition.
    load_case : str
        Its name.
    moved : LargeDisplacement
        What became of it as stated. Far from buckling its factor is taken to fall as the largest joint force grows.

    Returns
    -------
    LargeDisplacement
    """
    case, forces, loads = other.standing[load_case].case, other.forces[load_case], other.loads[load_case]
    plain, changed = (one.reactions[load_case].joints for one in (statics, other))
    most = max(joint.magnitude for joint in plain.values())
    grown = max(joint.magnitude for joint in changed.values()) / most if most > 0.0 else float("inf")
    far = moved.buckling is not None and moved.buckling / grown >= FAR
    return examine(case, load_case, forces, loads, moved.buckling / grown if moved.buckling and far else None)


def widened(outcome: CheckOutcome, spread: Scatter) -> CheckOutcome:
    """Return the outcome of a buckling factor with what a doubt makes of the compression in its band.

    Parameters
    ----------
    outcome : CheckOutcome
    spread : Scatter
        Of the inverse of the factor.

    Returns
    -------
    CheckOutcome
    """
    if not spread.sources:
        return outcome
    band, why = spread.inverse.on(outcome.value), outcome.reason
    found = CheckOutcome.of(
        outcome.name, outcome.subject, outcome.load_case, outcome.quantity, band, outcome.limit, why
    )
    by = reason("may_change_this", sources=tuple(dict.fromkeys(source.kind for source in spread.sources)))
    return found if found.verdict is outcome.verdict else found.because(together(why, by))


@dataclass(frozen=True, kw_only=True, eq=False)
class Doubt:
    """A load case as stated, and under other conditions that a cause may put in its place.

    Attributes
    ----------
    stated : OtherCase
    cause : Alternatives of OtherCase
    """

    stated: OtherCase
    cause: Alternatives[OtherCase]

    @classmethod
    def over(
        cls,
        statics: CaseStatics,
        load_case: str,
        moved: LargeDisplacement,
        source: Source,
        others: Sequence[CaseStatics],
        *,
        coefficients: tuple[float, ...] = (),
        endless: bool = False,
    ) -> Self:
        """Calculate a load case by hand as stated and under other conditions.

        Parameters
        ----------
        statics : CaseStatics
            As stated.
        load_case : str
            Its name.
        moved : LargeDisplacement
            What became of it as stated.
        source, coefficients, endless
            As of ``Alternatives``.
        others : sequence of CaseStatics
            Under the other conditions.

        Returns
        -------
        Doubt
        """
        found = tuple(OtherCase.of(one, load_case, shape_of(statics, one, load_case, moved)) for one in others)
        cause = Alternatives(source=source, others=found, coefficients=coefficients, endless=endless)
        return cls(stated=OtherCase.of(statics, load_case, moved), cause=cause)

    @property
    def name(self) -> str:
        """The kind of its source."""
        return str(self.cause.source.kind)

    @property
    def of_columns(self) -> bool:
        """True: buckling is that of the other conditions (``on_buckling``)."""
        return True

    @property
    def growths(self) -> Growths:
        """By how much stress, displacement of links and joint forces may differ."""

        def of_link(link: str, i: int) -> Scatter:
            return self.cause.scatter(self.stated, lambda one: one.numbers[link][i])

        def of_joint(name: str) -> Scatter:
            if not self.stated.reactions.joints[name].magnitude > 0.0:
                return Scatter()  # what others have there may be rounding
            return self.cause.scatter(self.stated, lambda one: one.reactions.joints[name].magnitude)

        stress, displacement = ({link: of_link(link, i) for link in self.stated.plates} for i in (0, 1))
        joints = {name: of_joint(name) for name in self.stated.reactions.joints}
        return Growths(stress=telling(stress), displacement=telling(displacement), joints=telling(joints))

    def answers(self, link: str) -> LinkAnswers:
        """Return what acts on a link as stated and in the other answers.

        Parameters
        ----------
        link : str

        Returns
        -------
        LinkAnswers
        """
        stated, *others = (tuple(loads for loads, _ in one.plates[link]) for one in (self.stated, *self.cause.others))
        rule = self.cause.of
        return LinkAnswers(stated=stated, others=tuple(others), stress=rule, displacement=rule)

    def slenderest(self, case: Case, link: str, plates: Plates) -> Plates:
        """Return the plates of a link of which the slenderest is judged as a column: others where none buckles.

        Parameters
        ----------
        case : Case
        link : str
        plates : sequence of tuple of (LinkLoads, LinkByHand)
            As stated.

        Returns
        -------
        sequence of tuple of (LinkLoads, LinkByHand)
        """
        buckles = any(least_factor(case, link, hand.check) < float("inf") for _, hand in plates)
        return plates if buckles else (*plates, *(plate for one in self.cause.others for plate in one.plates[link]))

    def on_buckling(self, outcome: CheckOutcome) -> CheckOutcome:
        """Return an outcome with the doubt in its band, where it is a buckling factor of a link or the linkage.

        Parameters
        ----------
        outcome : CheckOutcome

        Returns
        -------
        CheckOutcome
        """
        if outcome.quantity is not Quantity.BUCKLING_FACTOR or outcome.value.unknowable:
            return outcome
        link = outcome.subject.name if outcome.subject.kind == "link" else ""

        def inverse(one: OtherCase) -> float:
            return one.numbers[link][2] if link else 1.0 / (one.moved.factor or float("inf"))

        spread = self.cause.scatter(self.stated, inverse)
        if spread.high == float("inf") and not inverse(self.stated) > 0.0 and not self.cause.endless:
            # no compression as stated: the outcome is that of the worst other
            spread = Scatter(low=0.0, sources=spread.sources)
        return widened(outcome, spread)


def on_shape(moved: LargeDisplacement, doubt: Doubt) -> LargeDisplacement:
    """Return what became of a load case with what becomes of it under the other conditions of a doubt.

    Parameters
    ----------
    moved : LargeDisplacement
    doubt : Doubt

    Returns
    -------
    LargeDisplacement
    """
    return replace(moved, causes=(*moved.causes, doubt.cause.told_by(lambda one: one.moved)))
