"""Which model decides each link: by hand, or by its solid, refined for points where a check asks for them."""

import math
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

from alula.fea.asked.asked import asked, asked_of, asks
from alula.fea.beam.theory import BeamCheck
from alula.fea.check.load_case import LoadCaseByHand, SolvedAnswers
from alula.fea.check.point_solids import decide_point
from alula.fea.common.verdict import Quantity
from alula.fea.judging.loading import Collapse
from alula.fea.judging.plastic_collapse import find_collapses, needs_path
from alula.fea.links.fidelity import DecidedLink, by_hand, decide
from alula.fea.links.solid_result import link_task
from alula.fea.outcomes.point_displacement import meshes_to_refine
from alula.fea.outcomes.result import LinkResult
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.link_task import LinkTask
from alula.fea.refine.refinement import Effort, RefinedSolid, Watch
from alula.fea.solid.solution import SolidSolution, require_compressible
from alula.fea.whole.permanent_set import adds_to_set, ends_of_load
from alula.geometry.meshing.mesh import MeshSettings
from alula.geometry.meshing.tagged_mesh import TaggedMesh
from alula.loads.case.case import Case
from alula.loads.records.check_spec import DisplacementCheck, PermanentSetCheck, PlasticCollapseCheck

Progress = Callable[[str], None]
BY_HAND = ("beam", "frame")
POINT_ROUNDS = 4
"""At most, in which links are solved or refined for the displacement of a point."""


@dataclass(frozen=True, kw_only=True)
class Deciding:
    """The load cases of a case by hand, and what it may cost to decide their links.

    Attributes
    ----------
    case : Case
    load_cases : sequence of LoadCaseByHand
    fidelity : str
        As of ``check_case``.
    effort : Effort
    start : MeshSettings
        Of the first mesh of a link.
    first : mapping of str to TaggedMesh
        Such meshes that are there already.
    only : collection of str or None
        Links that the model is wanted for; None for all.
    threads : int
    progress : callable
        Called with a sentence before every stage that may take long.
    watch : callable
        As of ``refine_links``.
    begun : float
        When it was [s].
    """

    case: Case
    load_cases: Sequence[LoadCaseByHand]
    fidelity: str
    effort: Effort
    start: MeshSettings
    first: Mapping[str, TaggedMesh]
    only: Collection[str] | None
    threads: int
    progress: Progress
    watch: Watch = lambda link, found: None
    begun: float = field(default_factory=time.perf_counter)
    _answers: dict[tuple[str, str], tuple[SolidSolution, SolvedAnswers | None]] = field(default_factory=dict)

    def decided(self) -> dict[str, DecidedLink]:
        """Return every link on which something acts, decided by the model that was asked for."""
        links = [link for link in self.case.checked_links if self.only is None or link in self.only]
        if self.fidelity in BY_HAND:
            return decided_by_hand(self.case, self.load_cases, links)
        tasks, beams = _tasks(self.case, self.load_cases, links)
        if self.fidelity == "solid":
            for task in tasks.values():
                require_compressible(task.nu)  # before the first mesh
        alone = self.fidelity == "auto" and not self.effort.stated
        given_up = [one for one in self.load_cases if alone and one.lost]
        held = [one for one in self.load_cases if one not in given_up]
        lost = {cut.name for one in given_up for found in one.plates.values() for cut, _ in found}
        doubted = held if alone else []
        firm = [one for one in doubted if not one.solids_may_hold_it]

        def ranges(link: str, solid: RefinedSolid | None = None) -> dict[str, OpenRanges]:
            solved = [None if solid is None else self._answers_of(one, link, solid) for one in firm]
            each = [one.open_ranges(link, known, of_solid=True) for one, known in zip(firm, solved, strict=True)]
            return {name: found for every in each for name, found in every.items()}

        tasks = {link: replace(task, open_ranges=ranges(link)) for link, task in tasks.items()}
        decided = decide(
            tasks,
            beams,
            self.start,
            self.effort,
            fidelity=self.fidelity,
            first=self.first,
            lost=lost,
            doubted={
                link: {name: found for one in doubted for name, found in one.open_ranges(link).items()}
                for link in tasks
            },
            threads=self.threads,
            told=ranges,
            watch=self.watch,
            progress=self.progress,
        )
        tasks = {link: task.without(lost) for link, task in tasks.items()}
        for _ in range(POINT_ROUNDS if self.only is None else 0):
            wanted, spent = _wanted(held, decided), replace(self.effort, time_limit=self._left)
            closer = decide_point(
                decided,
                tasks,
                wanted,
                self.start,
                spent,
                threads=self.threads,
                watch=self.watch,
                progress=self.progress,
            )
            if not closer:
                break
            decided |= closer
        return decided

    def solved(self, decided: Mapping[str, DecidedLink]) -> dict[str, dict[str, SolvedAnswers]]:
        """Return what causes make of links on their solids: load case -> link -> answers.

        Parameters
        ----------
        decided : mapping of str to DecidedLink

        Returns
        -------
        dict of str to dict of str to SolvedAnswers
            Without links on whose solid nothing is in doubt.
        """
        return {
            one.load_case: {
                link: answers
                for link, what in decided.items()
                if what.solid is not None
                and (answers := self._answers_of(one, link, what.solid, self.threads)) is not None
            }
            for one in self.load_cases
        }

    def collapses(
        self, results: Mapping[str, Mapping[str, LinkResult]], solved: Mapping[str, Mapping[str, SolvedAnswers]]
    ) -> dict[str, dict[str, Collapse]]:
        """Return the plastic collapse of links whose path a check wants, since their first yield does not tell.

        Parameters
        ----------
        results : mapping of str to mapping of str to LinkResult
            Load case -> link -> its result.
        solved : mapping of str to mapping of str to SolvedAnswers
            As of ``solved``.

        Returns
        -------
        dict of str to dict of str to Collapse
            Load case -> link -> what was found.
        """
        if self.fidelity in BY_HAND or not asks(self.case, PlasticCollapseCheck, PermanentSetCheck):
            return {}
        always = asked_of(self.case, PlasticCollapseCheck) if self.fidelity == "solid" else ()
        factors = self._set_factors(results, solved)
        acting = {
            one.load_case: {
                link: [cut for cut, _ in plates]
                for link, plates in one.plates.items()
                if one.acts_on(link)
                and (self.only is None or link in self.only)
                and (
                    link in always
                    or (one.load_case, link) in factors
                    or needs_path(self.case, one.load_case, link, results[one.load_case][link])
                )
            }
            for one in self.load_cases
        }
        return find_collapses(
            self.case,
            acting,
            self.start,
            self.first,
            factors,
            time_limit=self._left,
            threads=self.threads,
            progress=self.progress,
        )

    def _set_factors(
        self, results: Mapping[str, Mapping[str, LinkResult]], solved: Mapping[str, Mapping[str, SolvedAnswers]]
    ) -> dict[tuple[str, str], tuple[float, float]]:
        """Return within what factors on the load permanent set is read, of the links that add to one: (case, link)."""
        found = {}
        for one in self.load_cases if asks(self.case, PermanentSetCheck) else ():
            for link, result in results[one.load_case].items():
                if adds_to_set(one.case, one.load_case, link, result):
                    doubts = one.doubts_on(link, solved[one.load_case].get(link))
                    ends = ends_of_load(one.case, link, one.load_case, result, *doubts)
                    found[one.load_case, link] = min(ends.low, 1.0), max(ends.high, 1.0)
        return found

    @property
    def _left(self) -> float:
        """Time that is left [s]."""
        return max(self.effort.time_limit - (time.perf_counter() - self.begun), 0.0)

    def _answers_of(
        self, one: LoadCaseByHand, link: str, solid: RefinedSolid, threads: int | None = None
    ) -> SolvedAnswers | None:
        """Return what causes make of a link on its solid, once for its finest mesh; None where nothing is in doubt."""
        key = one.load_case, link
        if key not in self._answers or self._answers[key][0] is not solid.solution:
            self._answers[key] = solid.solution, one.solid_answers(link, solid, threads)
        return self._answers[key][1]


def decided_by_hand(case: Case, load_cases: Sequence[LoadCaseByHand], links: Sequence[str]) -> dict[str, DecidedLink]:
    """Return links decided by hand alone.

    Parameters
    ----------
    case : Case
    load_cases : sequence of LoadCaseByHand
    links : sequence of str
        Their names.

    Returns
    -------
    dict of str to DecidedLink
        Without those on which nothing acts.
    """
    tasks, beams = _tasks(case, load_cases, links)
    return {link: by_hand(task, beams[link]) for link, task in tasks.items()}


def _tasks(
    case: Case, load_cases: Sequence[LoadCaseByHand], links: Sequence[str]
) -> tuple[dict[str, LinkTask], dict[str, dict[str, BeamCheck]]]:
    """Return what is to be decided of every link on which something acts, and its hand calculations by their loads."""
    loaded = {link: [cut for one in load_cases if one.acts_on(link) for cut, _ in one.plates[link]] for link in links}
    tasks = {link: link_task(case, link, loads) for link, loads in loaded.items() if loads}
    beams = {link: {cut.name: hand.check for one in load_cases for cut, hand in one.plates[link]} for link in tasks}
    return tasks, beams


def _wanted(load_cases: Sequence[LoadCaseByHand], decided: Mapping[str, DecidedLink]) -> dict[str, float]:
    """Return the error of displacements that links must keep to for the checks of points, the least of all."""
    found: dict[str, float] = {}
    for one in load_cases:
        if any(asked(one.case, DisplacementCheck, quantity=Quantity.DISPLACEMENT)):
            wanted = meshes_to_refine(one.case, one.load_case, one.moved, one.links(decided), one.free, one.forces)
            found |= {link: min(error, found.get(link, math.inf)) for link, error in wanted.items()}
    return found
