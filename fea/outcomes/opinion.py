"""What a second program says of a link: its numbers beside ours, and whether both agree."""

from dataclasses import dataclass

from alula.fea.common.reason import Reason, reason

DISPLACEMENT_AGREEMENT = 1e-3
STRESS_AGREEMENT = 1e-2
"""Largest differences of displacements and von Mises stresses, each over its largest value, that count as agreement of
two codes that share mesh, element and integration points, but not the rule of a curved element's stiffness."""


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What CalculiX found [MPa, mm], and how far its fields lie from ours.

    Attributes
    ----------
    von_mises : float
        Largest at the integration points.
    von_mises_nodal : float
        Largest at the nodes, carried there by CalculiX.
    displacement : float
        Largest of a node, once a rigid motion is fitted to ours.
    stress_gap : float
        Largest difference of von Mises stress at an integration point over our largest.
    displacement_gap : float
        Largest difference at a node over our largest.
    seconds : float
        That CalculiX took.
    """

    von_mises: float
    von_mises_nodal: float
    displacement: float
    stress_gap: float
    displacement_gap: float
    seconds: float

    @property
    def agrees(self) -> bool:
        """True where both fields agree everywhere."""
        return self.displacement_gap <= DISPLACEMENT_AGREEMENT and self.stress_gap <= STRESS_AGREEMENT


@dataclass(frozen=True, kw_only=True)
class SecondOpinion:
    """CalculiX beside our solution of one link under the load case that stresses it most.

    Attributes
    ----------
    link, load_case : str
    variant : str
        Of pin pressure and torque transfer.
    deck : str
        Name of the deck's file.
    von_mises, von_mises_nodal : float
        Our largest at the integration points and at the nodes [MPa].
    displacement : float
        Our largest [mm].
    known : bool
        False where the peak of our mesh is no result: what two programs share then is its mesh alone.
    answer : Answer or None
        None where CalculiX did not answer.
    reason : Reason or str
        Why it did not; "" where it did.
    """

    link: str
    load_case: str
    variant: str
    deck: str
    von_mises: float
    von_mises_nodal: float
    displacement: float
    known: bool
    answer: Answer | None
    reason: Reason | str = ""

    @property
    def warning(self) -> Reason | None:
        """What the reader must know; None where both agree."""
        if self.answer is None:
            return reason("no_second_opinion", link=self.link, why=self.reason, deck=self.deck)
        if self.answer.agrees:
            return None
        return reason(
            "second_opinion_differs",
            link=self.link,
            displacement=self.answer.displacement_gap,
            stress=self.answer.stress_gap,
            displacement_expected=DISPLACEMENT_AGREEMENT,
            stress_expected=STRESS_AGREEMENT,
        )
