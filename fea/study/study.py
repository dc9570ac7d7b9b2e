"""A study from its first point to its last: what stands is kept, what is missing is computed, side by side."""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from contextlib import AbstractContextManager
from dataclasses import dataclass, field

from alula.fea.study.engine import CrashError, Engine
from alula.fea.study.evaluate import Task, versions
from alula.fea.study.numbers import VariantResult
from alula.fea.study.store import ATTEMPTS, Store
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.plans.plan import StudyPlan
from alula.loads.plans.points import Point
from alula.loads.plans.variants import Variants

AT_ONCE = 500
"""Points that are assigned in one transaction where their results stand."""


@dataclass(kw_only=True)
class Progress:
    """How far a study is.

    Attributes
    ----------
    total : int
        Points.
    stood : int
        Whose results were there before.
    computed : int
        In this run.
    crashes : int
        Attempts of this run that got no answer.
    """

    total: int
    stood: int = 0
    computed: int = 0
    crashes: int = 0


@dataclass(kw_only=True)
class _Open:
    """A task that is handed out."""

    position: int
    point: Point
    key: str
    task: Task
    attempts: int


@dataclass(kw_only=True)
class Study:
    """Computes the variants of a plan into a store.

    Attributes
    ----------
    variants : Variants
    store : Store
        Open for writing.
    retry : bool
        Whether variants that crashed as often as they may are tried again.
    tell : callable
        Called with the progress after each point.
    """

    variants: Variants
    store: Store
    retry: bool = False
    tell: Callable[[Progress], None] = lambda progress: None
    _known: dict[str, tuple[str, int]] = field(default_factory=dict, init=False)
    _equal: list[tuple[int, str, Point]] = field(default_factory=list, init=False)
    """Points equal to one that is computed in this run."""

    def run(self, engine: Callable[[], AbstractContextManager[Engine]]) -> Progress:
        """Compute what is missing.

        Parameters
        ----------
        engine : callable
            Returns the context of the engine, which is entered once a point has to be computed.

        Returns
        -------
        Progress

        Raises
        ------
        CaseError
            For a store of another study.
        CannotRunError
            Where the engine is gone or the disk refuses; what was finished stands.
        """
        self._begin()
        progress = Progress(total=len(self.variants))
        missing = self._missing(progress)
        first = next(missing, None)
        if first is None:
            return progress
        with engine() as found:
            self._compute(found, _again(first, missing), progress)
        return progress

    def _begin(self) -> None:
        facts, plan = self.store.facts(), self.variants.plan
        if facts and (other := _differs(facts["plan"], plan)):
            raise CaseError(f"output: the folder holds another study ({other}); choose another folder")
        now = {"plan": plan.model_dump(mode="json"), "versions": versions(), "points": len(self.variants)}
        self.store.begin(now, (*self.variants.points.paths, *plan.link))
        self._known = dict(self.store.known())

    def _missing(self, progress: Progress) -> Iterator[_Open]:
        """Yield what has no result; points whose results stand are assigned on the way."""
        standing: list[tuple[int, str, Point]] = []
        asked: set[str] = set()
        for position, point in enumerate(self.variants.points):
            try:
                tables = self.variants.tables(point)
            except CaseError as error:
                self._refuse(position, point, str(error))
                progress.computed += 1
                continue
            task, point = task_of(self.variants.plan, tables), self._parameters(point, tables)
            key = task.key()
            state, attempts = self._known.get(key, ("", 0))
            if key in asked:
                self._equal.append((position, key, point))
            elif state in ("done", "refused") or (state == "crashed" and attempts >= ATTEMPTS and not self.retry):
                standing.append((position, key, point))
                progress.stood += 1
                if len(standing) == AT_ONCE:
                    self.store.place(standing)
                    standing.clear()
            else:
                asked.add(key)
                again = 0 if attempts >= ATTEMPTS else attempts
                yield _Open(position=position, point=point, key=key, task=task, attempts=again)
        self.store.place(standing)

    def _parameters(self, point: Point, tables: Mapping[str, object]) -> Point:
        from alula.loads.plans.derived import entry

        return point | {path: entry(tables, tuple(path.split("."))) for path in self.variants.plan.link}

    def _refuse(self, position: int, point: Point, sentence: str) -> None:
        """Keep a point whose tables cannot even be put together."""
        key = f"refused {sorted(point.items())} {sentence}"
        if key in self._known:
            self.store.place([(position, key, point)])
        else:
            self.store.add(position, key, point, VariantResult(state="refused", sentence=sentence))

    def _compute(self, engine: Engine, missing: Iterator[_Open], progress: Progress) -> None:
        handed: dict[Future[VariantResult], _Open] = {}
        while True:
            while len(handed) < engine.capacity() and (one := next(missing, None)) is not None:
                handed[engine.submit(one.task)] = one
            if not handed:
                break
            done = wait(handed, return_when=FIRST_COMPLETED).done
            for future in sorted(done, key=lambda future: handed[future].position):
                one = handed.pop(future)
                answer = _answer(future)
                self.store.add(one.position, one.key, one.point, answer)
                one.attempts += 1
                if answer.state == "crashed":
                    progress.crashes += 1
                    if one.attempts < ATTEMPTS:
                        handed[engine.submit(one.task)] = one
                        continue
                progress.computed += 1
                self.tell(progress)
        self.store.place(self._equal)
        progress.stood += len(self._equal)


def _again(first: _Open, rest: Iterator[_Open]) -> Iterator[_Open]:
    yield first
    yield from rest


def task_of(plan: StudyPlan, tables: Mapping[str, object]) -> Task:
    """Return what a worker computes for a variant.

    Parameters
    ----------
    plan : StudyPlan
    tables : mapping
        Of the variant's case.

    Returns
    -------
    Task
    """
    return Task(
        tables=tables, analysis=plan.analysis, fidelity=plan.fidelity, accuracy=plan.accuracy, weighs=plan.weighs
    )


def _answer(future: "Future[VariantResult]") -> VariantResult:
    try:
        return future.result()
    except CrashError as crash:
        return VariantResult(state="crashed", sentence=str(crash))
    except CancelledError:
        raise CannotRunError("the workers are gone; start the same command again to go on with the study") from None
    except CannotRunError:
        raise
    except Exception as error:  # of a worker on another machine, or of the library that reached for it
        return VariantResult(state="crashed", sentence=" ".join(f"{type(error).__name__}: {error}".split()))


def _differs(before: Mapping[str, object], plan: StudyPlan) -> str:
    """Say in what a plan is another study than the one before: case, analysis, or what varies; "" where in nothing."""
    now = plan.model_dump(mode="json")
    if before["case"] != now["case"]:
        return f"of the case '{before['case']}'"
    if before["analysis"] != now["analysis"]:
        return f"its analysis is '{before['analysis']}'"
    varied = [name for name in ("vary", "link") if set(before[name]) != set(now[name])]  # type: ignore[call-overload]
    if varied or before["points"] != now["points"]:
        return "other entries vary there"
    return ""
