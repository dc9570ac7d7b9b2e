"""Computes the variants that a search asks for, batch by batch, into the store of a study."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path

from alula.fea.study.engine import IN_FLIGHT, Engine
from alula.fea.study.numbers import VariantResult, Weighs
from alula.fea.study.store import Store
from alula.fea.study.study import Progress, Study
from alula.loads.plans.plan import StudyPlan
from alula.loads.plans.variants import Variants

Point = Mapping[str, object]
_Asked = tuple[str, Weighs, tuple[tuple[str, object], ...]]
"""Fidelity, whether the links are weighed, and the point."""


class Search:
    """Variants of a case, each computed once.

    Parameters
    ----------
    plan : StudyPlan
        Case, analysis, linked entries and what is set; its ``vary`` names the entries that the search chooses.
    folder : Path
        That the plan's names are relative to.
    store : Store
        Open for writing.
    engine : Engine
    tell : callable, optional
        Called with a sentence before each batch.
    """

    def __init__(
        self,
        plan: StudyPlan,
        folder: Path,
        store: Store,
        engine: Engine,
        tell: Callable[[str], None] = lambda sentence: None,
    ) -> None:
        self._plan, self._folder, self._store, self._engine, self._tell = plan, folder, store, engine, tell
        self._known: dict[_Asked, VariantResult] = {}

    @property
    def workers(self) -> int:
        """How many variants are computed at once."""
        return max(self._engine.capacity() // IN_FLIGHT, 1)

    @property
    def fidelity(self) -> str:
        """The model that decides."""
        return self._plan.fidelity

    def at(self, points: Sequence[Point], fidelity: str = "", *, roughly: bool = False) -> list[VariantResult]:
        """Return what becomes of some points.

        Parameters
        ----------
        points : sequence of mapping
            Entry -> value, for every entry that varies.
        fidelity : str, optional
            Of the check; the plan's unless given.
        roughly : bool
            Whether links that are weighed are weighed by length and section.

        Returns
        -------
        list of VariantResult
        """
        fidelity = fidelity or self._plan.fidelity
        mass = "rough" if roughly and self._plan.weighs else self._plan.weighs
        named: list[_Asked] = [(fidelity, mass, tuple(point.items())) for point in points]
        missing = list(dict.fromkeys(name for name in named if name not in self._known))
        if missing:
            model = "hand calculation" if fidelity in ("beam", "frame") else "the model that decides"
            self._tell(f"{len(missing)} of {len(named)} variants by {model} ...")
            self._compute(missing, fidelity, mass)
        return [self._known[name] for name in named]

    def _compute(self, missing: Sequence[_Asked], fidelity: str, mass: Weighs) -> None:
        plan = self._plan.model_copy(update={"fidelity": fidelity, "mass": mass})
        variants = Variants(plan, self._folder, points=[dict(point) for *_, point in missing])
        Study(variants=variants, store=self._store).run(lambda: nullcontext(self._engine))
        for position, _, result, _ in self._store.rows():
            self._known[missing[position]] = result

    def finish(self) -> Progress:
        """Assign all points by the model that decides to the study, so that ``alula study show`` shows them.

        Returns
        -------
        Progress
        """
        decides = (self._plan.fidelity, self._plan.weighs)
        points = [dict(point) for fidelity, mass, point in self._known if (fidelity, mass) == decides]
        variants = Variants(self._plan, self._folder, points=points)
        return Study(variants=variants, store=self._store).run(lambda: nullcontext(self._engine))
