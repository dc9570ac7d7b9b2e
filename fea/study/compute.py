"""A plan computed into a folder: what the command and Python both call."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

from alula.fea.study.engine import Engine, local_engine, usable_cores
from alula.fea.study.store import Store
from alula.fea.study.study import Progress, Study
from alula.loads.plans.variants import Variants


def compute_study(
    variants: Variants,
    output: Path,
    *,
    workers: int | None = None,
    scheduler: str = "",
    retry: bool = False,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> tuple[Progress, dict[str, int]]:
    """Compute the variants that are missing in a folder.

    Parameters
    ----------
    variants : Variants
    output : Path
        Folder of ``study.sqlite``; it is created where it is not there.
    workers : int, optional
        Processes; one a core unless given.
    scheduler : str, optional
        Address of a Dask scheduler whose workers compute instead.
    retry : bool
        Whether variants that crashed as often as they may are tried again.
    tell : callable
        Called with the progress after each point.

    Returns
    -------
    Progress
    dict of str to int
        Points by verdict, or by state where there is none.

    Raises
    ------
    CaseError
        For a folder of another study, or one that another study is writing, and an address that is none.
    CannotRunError
        Where the disk refuses or the workers are gone; what was finished stands.
    """
    if scheduler:
        from alula.fea.study.cluster import require_address

        require_address(scheduler)
    with Store.writing(output) as store:
        study = Study(variants=variants, store=store, retry=retry, tell=tell)
        return study.run(lambda: engine_for(variants, output, workers=workers, scheduler=scheduler)), store.counts()


def engine_for(
    variants: Variants, output: Path, *, workers: int | None = None, scheduler: str = ""
) -> AbstractContextManager[Engine]:
    """Return the context of the engine that computes variants.

    Parameters
    ----------
    variants : Variants
    output : Path
        Folder of the study, which takes what local workers write meanwhile.
    workers : int, optional
        Processes; one a core unless given.
    scheduler : str, optional
        Address of a Dask scheduler.

    Returns
    -------
    context manager
    """
    contents = {name: path.read_bytes() for name, path in variants.files.items()}
    if scheduler:
        from alula.fea.study.cluster import cluster_engine

        return cluster_engine(scheduler, contents)
    return local_engine(workers or usable_cores(), contents, folder=output)
