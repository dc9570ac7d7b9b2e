"""Meshes made finer until a link's numbers are good enough for the decision or the stated accuracy.

A link whose stress is far from every limit, with its estimated error taken fourfold and a factor of two
on top, needs one coarse mesh. Any other gets at least three, refined where the peaks are and where the
estimate asks (``alula.fea.refine.target_sizes``), until every limit lies outside the band or the band is as narrow as
asked for; or until a limit of time, unknowns or number of meshes stops it, which the link's numbers then say.
"""

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace

import numpy as np

from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason
from alula.fea.common.threads import bounded
from alula.fea.refine.beyond_meshes import OpenRanges, none_decides
from alula.fea.refine.convergence import ALONE, SERIES, SEVERAL, GridConvergence
from alula.fea.refine.level import Level, level_of
from alula.fea.refine.link_buckling import SolidBuckling, link_buckling
from alula.fea.refine.link_series import (
    CasePrecision,
    Eye,
    Measure,
    PeakQuantity,
    energy_errors,
    goals,
    precision,
)
from alula.fea.refine.link_task import ElasticLink, LinkTask
from alula.fea.refine.singular import NEARLY, element_exponents, loaded_edge
from alula.fea.refine.target_sizes import SERIES_RATIO, element_sizes, next_sizes, reduction, series_ratio
from alula.fea.solid.solution import SolidSolution, solve_solid
from alula.geometry.base import child
from alula.geometry.base.errors import AlulaError, CannotRunError, CaseError
from alula.geometry.keeping.kept import kept
from alula.geometry.meshing.mesh import MeshSettings, ReentrantEdge, mesh_body, reentrant_edges
from alula.geometry.meshing.tagged_mesh import TaggedMesh

FAR = 2.0
"""Factor that a link with one mesh keeps from every limit, beyond its band."""
ROUGH = 0.25
"""Estimate over peak above which one mesh decides nothing."""
START = MeshSettings(size=0.6, bore_elements=10, hole_elements=6, turn_elements=6, fillet_size=1.2, growth=1.0)
"""The first mesh: coarse, since the next ones become finer where it matters."""
Progress = Callable[[str], None]
Watch = Callable[[str, "RefinedSolid | None"], None]
Told = Callable[[str, "RefinedSolid"], Mapping[str, OpenRanges]]
NONE_DECIDES = reason("no_finer_mesh_decides")
"""Why refinement of a link ends whose checks are open for other causes."""


@dataclass(frozen=True, kw_only=True)
class Effort:
    """What accuracy is asked for and what it may cost.

    Attributes
    ----------
    accuracy : float
        Largest distance of the discretisation band from the number, relative to it.
    stated : bool
        True where it was asked for: then every link is refined to it, even if its verdict is clear.
    max_unknowns : int
        Largest system that is solved for accuracy's sake.
    time_limit : float
        Seconds after which no further mesh is begun.
    max_meshes : int
        Per link.
    """

    accuracy: float = 0.05
    stated: bool = False
    max_unknowns: int = 600_000
    time_limit: float = 600.0
    max_meshes: int = 10

    def __post_init__(self) -> None:
        """Refuse an accuracy that no series of meshes reaches."""
        if not 0.001 <= self.accuracy <= 1.0:
            raise CaseError(f"accuracy: {100.0 * self.accuracy:g} % is outside 0.1 % to 100 %; choose one between")
        if self.max_meshes < 1 or self.max_unknowns < 1 or self.time_limit < 0.0:
            raise CaseError("the limits of unknowns, meshes and time must be above zero; raise them")


@dataclass(frozen=True, kw_only=True)
class MeshRecord:
    """Size of one mesh, its error and its time.

    Attributes
    ----------
    elements : int
        Their number.
    unknowns : int
        Their number.
    error : float
        Of the worst case, in the energy norm, relative (``energy_errors``).
    seconds : float
        That the mesh took to solve.
    """

    elements: int
    unknowns: int
    error: float
    seconds: float


@dataclass(frozen=True, kw_only=True, eq=False)
class RefinedSolid:
    """A link's finest solution and how precise it is.

    Attributes
    ----------
    solution : SolidSolution
        On the finest mesh.
    precision : tuple of CasePrecision
        Of every case, in the order of ``solution.cases``.
    meshes : tuple of MeshRecord
        Coarse to fine.
    stopped : Reason or None
        Why refinement ended before its aim was reached; "" where it was reached.
    far : bool
        True where one mesh sufficed since every limit is far away.
    accuracy : float
        That was aimed at, relative.
    sharp_edges : int
        Number of re-entrant edges of the link; 0 where its shape left none to look for.
    levels : tuple of Level
        What is kept of every mesh, from which refinement goes on.
    settings : MeshSettings
        Of the finest mesh.
    buckling : mapping of str to SolidBuckling
        Load case -> factors on the first mesh that tells them; empty where beams stand for the link.
    beyond : frozenset of int
        Numbers of the cases whose checks no finer mesh decides, for which none was made.
    kept : bool
        True where no mesh was solved for it now: all solutions were kept from earlier checks.
    """

    solution: SolidSolution
    precision: tuple[CasePrecision, ...]
    meshes: tuple[MeshRecord, ...]
    stopped: Reason | None
    far: bool
    accuracy: float
    sharp_edges: int
    levels: tuple[Level, ...] = ()
    settings: MeshSettings = START
    buckling: Mapping[str, SolidBuckling] = field(default_factory=dict)
    beyond: frozenset[int] = frozenset()
    kept: bool = False

    @property
    def may_go_on(self) -> bool:
        """True where finer meshes may be made: no limit of the effort ended their series."""
        return self.stopped is None or self.stopped == NONE_DECIDES


def refine_links(
    tasks: Mapping[str, LinkTask],
    start: MeshSettings,
    effort: Effort,
    *,
    first: Mapping[str, TaggedMesh] | None = None,
    earlier: Mapping[str, RefinedSolid] | None = None,
    threads: int | None = None,
    told: Told | None = None,
    watch: Watch = lambda link, found: None,
    progress: Progress = lambda message: None,
) -> dict[str, RefinedSolid]:
    """Mesh and solve every link as often as its numbers need it, as many links side by side as there may be threads.

    Parameters
    ----------
    tasks : dict of str to LinkTask
        Links by name.
    start : MeshSettings
        Settings of the first mesh.
    effort : Effort
        What accuracy is asked for and what it may cost.
    first : dict of str to TaggedMesh, optional
        First meshes that are there already.
    earlier : dict of str to RefinedSolid, optional
        Meshes from which links go on, where their task asks for more than it did.
    threads : int or None, optional
        That work at once: links side by side, and libraries where there are fewer links. None leaves the libraries
        their own choice, and takes one link after another.
    told : callable, optional
        Returns the ``open_ranges`` of a link by what its first mesh tells, before a second one is made.
    watch : callable, optional
        Called with every link as it is begun, and with what was found as it ends.
    progress : Progress, optional
        Called with a sentence before each step.

    Returns
    -------
    dict of str to RefinedSolid
        Links by name.

    Raises
    ------
    AlulaError
        What ``mesh_body`` and ``solve_solid`` raise on a link's first mesh, with the link's name before it.
    """
    links = [_Link(name, task, start, effort, (earlier or {}).get(name), told) for name, task in tasks.items()]
    begun = time.perf_counter()
    beside = max(min(threads or 1, len(links)), 1)
    own = None if threads is None else max(threads // beside, 1)
    with bounded(own, children=threads), ThreadPoolExecutor(2) as meshers, ThreadPoolExecutor(beside) as solvers:
        try:
            for link in links:
                watch(link.name, None)
                if link.levels:
                    link.go_on(meshers, begun)
                    if link.done:
                        watch(link.name, link.result())
                else:
                    link.order_mesh(meshers, (first or {}).get(link.name))
            # Links take turns, mesh by mesh, so that a limit of time leaves each of them with about as many.
            turns = {solvers.submit(link.advance, meshers, begun, progress): link for link in links if not link.done}
            while turns:
                for turn in wait(turns, return_when=FIRST_COMPLETED).done:
                    link = turns.pop(turn)
                    turn.result()
                    if link.done:
                        watch(link.name, link.result())
                    else:
                        turns[solvers.submit(link.advance, meshers, begun, progress)] = link
        except BaseException:
            solvers.shutdown(wait=False, cancel_futures=True)
            meshers.shutdown(wait=False, cancel_futures=True)
            raise
    return {link.name: link.result() for link in links}


@kept(but=("begin",))
def _on_mesh(
    mesh: TaggedMesh, link: ElasticLink, loads: tuple[LinkLoads, ...], begin: Callable[[], None]
) -> tuple[SolidSolution, Level, float]:
    """Solve a link on a mesh, and condense what is kept of it, in so many seconds; limits and efforts do not enter."""
    begin()
    begun = time.perf_counter()
    solution = solve_solid(mesh, E=link.E, nu=link.nu, density=link.density, loads=loads, line=link.line)
    return solution, level_of(solution, mesh.volume, link.layers), time.perf_counter() - begun


class _Link:
    """One link on its way through the meshes."""

    def __init__(
        self,
        name: str,
        task: LinkTask,
        settings: MeshSettings,
        effort: Effort,
        earlier: RefinedSolid | None = None,
        told: Told | None = None,
    ) -> None:
        self.name, self.task, self.effort = name, task, effort
        self.told = told
        self.settings = settings if earlier is None else earlier.settings
        self.levels: list[Level] = [*(earlier.levels if earlier else ())]
        self.meshes: list[MeshRecord] = [*(earlier.meshes if earlier else ())]
        self.precision: tuple[CasePrecision, ...] = earlier.precision if earlier else ()
        self.solution: SolidSolution | None = earlier.solution if earlier else None
        self.stopped: Reason | None = None
        self.done = False
        self.kept = earlier is None or earlier.kept
        self.far = earlier is not None and earlier.far
        self.buckling = earlier.buckling if earlier else {}
        self._mesh: Callable[[], TaggedMesh] | None = None
        self._sharp: Future[list[ReentrantEdge]] | None = None

    def order_mesh(self, pool: ThreadPoolExecutor, mesh: TaggedMesh | None = None) -> None:
        """Have the next mesh made unless it is there, and the re-entrant edges found where they may matter."""
        self._mesh = (lambda: mesh) if mesh else pool.submit(mesh_body, self.task.body, self.settings).result
        self._look_for_edges(pool)

    def _look_for_edges(self, pool: ThreadPoolExecutor) -> None:
        if self._sharp is None and (self.task.may_be_sharp or self._growing):
            self._sharp = pool.submit(reentrant_edges, self.task.body)

    def advance(self, pool: ThreadPoolExecutor, start: float, progress: Progress) -> None:
        """Solve on the mesh that was ordered, judge the series and order the next one if need be."""
        assert self._mesh is not None
        try:
            mesh = self._mesh()
            if child.stopped():
                raise CannotRunError("interrupted")
            solved = self._solved(mesh, progress)
        except (AlulaError, MemoryError) as error:
            if not self.levels:
                raise type(error)(f"{self.name}: {error}") from None
            self._stop(reason("finer_mesh_unusable", why=str(error) or reason("memory_ran_out")))
            return
        if solved is None:
            return
        self.solution, level, taken = solved
        self.levels.append(level)
        if not self._told:
            self.buckling = link_buckling(self.solution, self.task, level.chord)
        self._judge()
        seconds = [*(mesh.seconds for mesh in self.meshes), taken]
        self.meshes = [
            MeshRecord(elements=len(level.cells), unknowns=3 * len(level.nodes), error=error, seconds=taken)
            for level, error, taken in zip(self.levels, energy_errors(self.levels), seconds, strict=True)
        ]
        self._next(pool, start)

    def go_on(self, pool: ThreadPoolExecutor, start: float) -> None:
        """Take up earlier meshes, and order the next one if need be."""
        self._look_for_edges(pool)
        self._next(pool, start)

    def _next(self, pool: ThreadPoolExecutor, start: float) -> None:
        if self._ends_open():
            self._stop(NONE_DECIDES)
        elif self._settled():
            self.done = True
        elif self.task.body.part.is_fixed:
            self._stop(reason("mesh_of_file"))
        elif len(self.levels) >= self.effort.max_meshes:
            self._stop(reason("most_meshes_reached", most=len(self.levels)))
        elif time.perf_counter() - start > self.effort.time_limit:
            self._stop(reason("time_limit_used_up", limit=self.effort.time_limit))
        elif self._tell() and self._ends_open():
            self._stop(NONE_DECIDES)
        else:
            self._refine(pool)

    def _ends_open(self) -> bool:
        """Whether its checks are open however fine the mesh, and displacements as exact as asked for."""
        return self._told and len(self._beyond) == len(self.precision) and self._moves_settled

    def _tell(self) -> bool:
        """Take what the first mesh tells of other causes, where it may matter; return whether it was taken."""
        ranges = self.task.open_ranges
        if self.told is None or len(self.levels) != 1 or not all(loads.name in ranges for loads in self.task.loads):
            return False
        self.task = replace(self.task, open_ranges=self.told(self.name, self.result()))
        return True

    def result(self) -> RefinedSolid:
        """Return what was found."""
        assert self.solution is not None
        return RefinedSolid(
            solution=self.solution,
            precision=self.precision,
            meshes=tuple(self.meshes),
            stopped=self.stopped,
            far=self.far and len(self.levels) == 1,
            accuracy=self.effort.accuracy,
            sharp_edges=len(self.edges),
            levels=tuple(self.levels),
            settings=self.settings,
            buckling=self.buckling,
            beyond=self._beyond,
            kept=self.kept,
        )

    def _solved(self, mesh: TaggedMesh, progress: Progress) -> tuple[SolidSolution, Level, float] | None:
        unknowns = 3 * len(mesh.points)
        if self.levels and unknowns > self.effort.max_unknowns:
            self._stop(reason("next_mesh_too_large", unknowns=unknowns, allowed=self.effort.max_unknowns))
            return None

        def begin() -> None:
            self.kept = False
            progress(f"Solving {self.name}, mesh {len(self.levels) + 1}: {len(mesh.cells)} elements ...")

        return _on_mesh(mesh, self.task.link, self.task.loads, begin)

    def _stop(self, why: Reason) -> None:
        self.stopped, self.done = why, True

    @property
    def _wanted(self) -> bool:
        """Whether the accuracy is wanted for itself, even where verdicts on peaks are clear."""
        return self.effort.stated or self.task.beyond_peak

    @property
    def edges(self) -> Sequence[ReentrantEdge]:
        """Re-entrant edges, as far as they were asked for."""
        return self._sharp.result() if self._sharp is not None else ()

    @property
    def _told(self) -> bool:
        """Whether the buckling factors of all load cases are known, where there are any."""
        return self.task.holding is None or (
            bool(self.buckling) and not any(found.without for found in self.buckling.values())
        )

    @property
    def _growing(self) -> bool:
        return any(s.kind == "growing" for p in self.precision for s in self._deciding(p))

    def _judge(self) -> None:
        body = self.task.body
        eyes = [Eye(x=pin.x, y=pin.y, radius=body.across(pin) / 2.0, slot=pin.slot) for pin in body.pins]
        self.precision = precision(self.levels, self.edges, section=self.task.section, eyes=eyes)

    @property
    def _beyond(self) -> frozenset[int]:
        """Numbers of the cases whose checks no finer mesh decides."""
        if self._wanted or self.solution is None:
            return frozenset()
        by_loads: dict[str, list[int]] = {}
        for number, solved in enumerate(self.solution.cases):
            by_loads.setdefault(solved.load, []).append(number)
        return frozenset(
            number
            for name, numbers in by_loads.items()
            if (ranges := self.task.open_ranges.get(name)) is not None
            and none_decides(
                [
                    ([(self.precision[i].low(quantity), self.precision[i].high(quantity)) for i in numbers], limit)
                    for quantity, limits in ranges.limits.items()
                    for limit in limits
                ]
            )
            for number in numbers
        )

    @property
    def _moves_settled(self) -> bool:
        """Whether displacements are as exact as a check of the linkage needs them."""
        return all(p.displacement.index <= self.task.displacement_error for p in self.precision)

    def _settled(self) -> bool:
        """Whether nothing finer is needed."""
        if any(p.unreliable == "coarse" for p in self.precision) or not self._told:
            return False
        if len(self.levels) == 1 or self.far:
            self.far = not self._wanted and self._far()
        if not self._moves_settled:
            return False
        if self.far or len(self.levels) == 1:
            return self.far
        if len(self.levels) <= SERIES and any(p.sharp and not p.sharp.resolved for p in self.precision):
            return False
        # Nothing finer makes a singular peak finite, or decides what other causes leave open.
        beyond = self._beyond
        real = [p for number, p in enumerate(self.precision) if p.sharp is None and number not in beyond]
        series = [s for p in real for s in (*self._deciding(p), p.edge) if s is not None]
        if any(s.kind == "growing" or s.suspect or len(s.values) < SERIES for s in series):
            return False
        return all(map(self._narrow, real)) or (not self._wanted and self._decided())

    def _narrow(self, case: CasePrecision) -> bool:
        """Whether bands are as narrow as asked for; that of layers may be wide where it is clear of its limit.

        Layers along a pull bear next to nothing, whose error no mesh makes small beside it.
        """
        return all(s.index <= self.effort.accuracy for s in (*self._deciding(case), case.displacement))

    def _layers_open(self, case: CasePrecision) -> bool:
        """Whether a limit lies in the band of the stress on layers, or near to one that may yet move."""
        if case.layers is None:
            return False
        low, high = case.low("layers"), case.high("layers")
        near = FAR if case.layers.suspect or case.layers.kind == "growing" else 1.0
        return any(low <= near * limit and limit <= near * high for ends in self.task.layer_limits for limit in ends)

    @property
    def _unsettled(self) -> Sequence[Measure]:
        """The stresses for which meshes are made finer: layers that are clear of their limit need none."""
        first, *layers = self.task.measures
        return (first, *(layers if any(map(self._layers_open, self.precision)) else ()))

    def _deciding(self, case: CasePrecision) -> list[GridConvergence]:
        """Series of the stresses that decide, without that of layers where it is clear of its limit."""
        first, *layers = self.task.measures
        return [case.series(measure) for measure in (first, *(layers if self._layers_open(case) else ()))]

    def _limits(self) -> Iterable[tuple[float, float, float]]:
        """Ends of every band, and a limit that it must clear."""
        stated: tuple[tuple[PeakQuantity, tuple[tuple[float, float], ...]], ...] = (
            (self.task.measures[0], self.task.stress_limits),
            ("layers", self.task.layer_limits),
            ("displacement", self.task.displacement_limits),
        )
        beyond = self._beyond
        for number, case in enumerate(self.precision):
            if case.sharp is None and number not in beyond:
                yield from (
                    (case.low(q), case.high(q), limit) for q, limits in stated for ends in limits for limit in ends
                )

    def _decided(self) -> bool:
        """Whether every limit lies outside every band."""
        return all(not low <= limit <= high for low, high, limit in self._limits())

    def _far(self) -> bool:
        """Whether one mesh decides: well resolved, away from sharp edges, every limit far outside the band."""
        if any(s.index > ALONE * ROUGH for p in self.precision for s in self._deciding(p)):
            return False
        if any(p.edge is not None for p in self.precision):
            return False
        level, section = self.levels[-1], self.task.section
        if any(loaded_edge(self.edges, level.nodes, f.von_mises, section, NEARLY) for f in level.figures):
            return False
        return all(high * FAR < limit or low > FAR * limit for low, high, limit in self._limits())

    def _refine(self, pool: ThreadPoolExecutor) -> None:
        """Order a mesh that is finer where the peaks are and where the energy of the error is."""
        assert self.solution is not None
        accuracy, level = self.effort.accuracy, self.levels[-1]
        allowed = float(np.sqrt(accuracy)) / 2.0  # of the energy norm: displacements miss its square
        closer = [self.task.displacement_error / max(p.displacement.index, 1e-300) for p in self.precision]
        exponent = element_exponents(self.edges, level.centres, element_sizes(self.solution.space))
        factors = [
            reduction(
                figures.estimate.energy,
                figures.estimate.energy_norm,
                allowed if share >= 1.0 else min(allowed, figures.estimate.relative * math.sqrt(share)),
                exponent,
            )
            for figures, share in zip(level.figures, closer, strict=True)
        ]
        wanted = [
            goal
            for measure in (() if self.far else self._unsettled)
            for goal in goals(
                self.levels,
                accuracy / SEVERAL,
                measure=measure,
                edges=self.edges,
                section=self.task.section,
                ratios=[series_ratio(case.series(measure), accuracy) for case in self.precision],
            )
        ]
        points, sizes = next_sizes(self.solution.space, factors, wanted)
        self.settings = replace(self.settings, size_points=points, size_values=sizes)
        if not self.settings.curved:  # straight sides miss the round of a surface, which sizes alone would leave
            turn = round(SERIES_RATIO * self.settings.turn_elements)
            self.settings = replace(self.settings, turn_elements=turn)
        self.order_mesh(pool)
