"""Causes that leave open which loads act on links in a pose: a new one is a file, and a line in ``CAUSES``.

A cause is measured by hand and on solids alike: by the loads that its answers put on a link, and by its rule
(``docs/theory/bands.md``). Air and friction, which change what acts on the linkage as a whole, are solved as other
cases first (``alula.fea.doubts.other_case.Doubt``), and are causes here as well.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Protocol

from alula.fea.doubts.force_doubt import sharing_answers, sharing_doubt, stiffness_answers, stiffness_doubt
from alula.fea.doubts.load_growth import Growths
from alula.fea.doubts.play_doubt import play_answers, play_doubt
from alula.fea.standing.joint_forces import JointForces
from alula.fea.superposition.link_answers import LinkAnswers
from alula.loads.case.case import Case
from alula.loads.records.applied import Load

COUPLES = "couples"
"""The one cause whose part of a band is told apart: a fit that a case states may take it away."""


class Cause(Protocol):
    """What may act on links in place of what is stated."""

    @property
    def name(self) -> str:
        """By which it is told apart from others."""
        ...

    @property
    def growths(self) -> Growths:
        """What it makes of links and joints by hand."""
        ...

    @property
    def of_columns(self) -> bool:
        """True where that tells of buckling of links too; else it follows from the forces of their joints."""
        ...

    def answers(self, link: str) -> LinkAnswers:
        """Return what acts on a link as stated, and in the other answers.

        Parameters
        ----------
        link : str

        Returns
        -------
        LinkAnswers
        """
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Stated:
    """A load case as it stands, of which causes are looked for.

    Attributes
    ----------
    case : Case
    load_case : str
        Its name.
    forces : JointForces
    shared : JointForces
        Those of the numbers that the ways of sharing couples change: on the deformed shape of tight pins.
    loads : sequence of Load
        That act on the links.
    grown : bool
        As of ``sharing_answers``.
    links : sequence of str or None
        Whose play and couples are told by hand; None for all.
    """

    case: Case
    load_case: str
    forces: JointForces
    shared: JointForces
    loads: Sequence[Load]
    grown: bool
    links: Sequence[str] | None


@dataclass(frozen=True, kw_only=True, eq=False)
class OnLinks:
    """A cause that puts other loads on links, as ``Cause`` has it.

    Attributes
    ----------
    name, growths, of_columns
        As of ``Cause``.
    on_link : callable
        Of a link, to the answers, which every mesh of it asks for again.
    """

    name: str
    growths: Growths
    on_link: Callable[[str], LinkAnswers]
    of_columns: bool = False

    def answers(self, link: str) -> LinkAnswers:
        """Return what acts on a link as stated, and in the other answers.

        Parameters
        ----------
        link : str

        Returns
        -------
        LinkAnswers
        """
        return self.on_link(link)


def _couples(stated: Stated) -> OnLinks | None:
    """How pins share couples between layers."""
    if not stated.shared.sharings:
        return None
    own = replace(stated, forces=stated.shared)
    growths = sharing_doubt(own.case, own.load_case, own.forces, own.loads, grown=own.grown, links=own.links)
    return OnLinks(name=COUPLES, growths=growths, on_link=cache(partial(_on, sharing_answers, own, grown=own.grown)))


def _stiffness(stated: Stated) -> OnLinks | None:
    """How soft links are, where joint forces depend on it."""
    if not stated.forces.open_by:
        return None
    growths = stiffness_doubt(stated.case, stated.load_case, stated.forces, stated.loads)
    return OnLinks(name="stiffness", growths=growths, on_link=cache(partial(_on, stiffness_answers, stated)))


def _play(stated: Stated) -> OnLinks | None:
    """Where pins stand in their holes in the plane."""
    if stated.forces.play is None:
        return None
    growths = play_doubt(stated.case, stated.load_case, stated.forces, stated.loads, stated.links)
    return OnLinks(name="play", growths=growths, on_link=cache(partial(_on, play_answers, stated)), of_columns=True)


def _on(answers: Callable[..., LinkAnswers], stated: Stated, link: str, **options: bool) -> LinkAnswers:
    return answers(stated.case, stated.load_case, link, stated.forces, stated.loads, **options)


CAUSES: tuple[Callable[[Stated], Cause | None], ...] = (_couples, _stiffness, _play)


def causes_of(stated: Stated) -> tuple[Cause, ...]:
    """Return what leaves the loads on links of a load case open.

    Parameters
    ----------
    stated : Stated

    Returns
    -------
    tuple of Cause
    """
    return tuple(found for cause in CAUSES if (found := cause(stated)) is not None)
