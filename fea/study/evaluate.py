"""One variant of a case from tables to numbers: what a worker does, in this process or on another machine."""

import atexit
import hashlib
import json
import shutil
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal

from alula.fea.study.numbers import VariantResult, Weighs
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.base.tidying import owed
from alula.geometry.base.version import alula_version

Analysis = Literal["check", "motion", "envelope"]


@dataclass(frozen=True, kw_only=True)
class Task:
    """What a worker needs to compute a variant, besides the files of its parts.

    Attributes
    ----------
    tables : dict
        The case, with every part's file named by the SHA-256 of its content.
    analysis : {"check", "motion", "envelope"}
    fidelity : str
        Of a check.
    accuracy : str or None
        As ``--accuracy``.
    weighs : bool or "rough"
        Whether the links are weighed; "rough" by length and section.
    """

    tables: Mapping[str, Any]
    analysis: Analysis = "check"
    fidelity: str = "auto"
    accuracy: str | None = None
    weighs: Weighs = False

    def key(self) -> str:
        """Return what tells equal variants: the digest of all that the answer depends on.

        Returns
        -------
        str
            SHA-256 of the case's tables, what is done with them, and the versions of alula and of the mesher.
        """
        stated = [self.tables, self.analysis, self.fidelity, self.accuracy, self.weighs, *versions()]
        return hashlib.sha256(json.dumps(stated, sort_keys=True, default=str).encode()).hexdigest()


@cache
def versions() -> tuple[str, str]:
    """Return the versions of alula and of gmsh.

    Returns
    -------
    tuple of str
    """
    from importlib.metadata import version

    return alula_version(), version("gmsh")


def evaluate(task: Task, contents: Mapping[str, bytes]) -> VariantResult:
    """Compute a variant.

    Parameters
    ----------
    task : Task
    contents : mapping of str to bytes
        The files of the case's parts, by the names that its tables have for them.

    Returns
    -------
    VariantResult
        Done, refused with the case's own sentence, or crashed where a stage fails, such as the mesher.
    """
    wall, processor = time.perf_counter(), time.process_time()
    try:
        verdict, numbers = _numbers(task, contents)
    except CaseError as error:
        answer = VariantResult(state="refused", sentence=str(error))
    except (CannotRunError, MemoryError) as error:
        answer = VariantResult(state="crashed", sentence=str(error) or "the worker's memory does not suffice")
    else:
        answer = VariantResult(state="done", verdict=verdict, numbers=numbers)
    times = {"seconds": time.perf_counter() - wall, "processor": time.process_time() - processor}
    return VariantResult(**(answer.__dict__ | times))


def _numbers(task: Task, contents: Mapping[str, bytes]) -> Any:
    from alula.fea.common.threads import bounded
    from alula.fea.study import numbers
    from alula.loads.case.case_file import validate

    case = validate(dict(task.tables), _folder(tuple(contents.items())))
    if task.analysis == "motion":
        from alula.fea.whole.rubbed_motion import rubbed_motion

        with bounded(1):
            return numbers.of_motion(rubbed_motion(case), weighs=task.weighs)
    from alula.fea.check.run import check_case, effort_of

    effort = effort_of(case, task.accuracy)
    if task.analysis == "envelope":
        from alula.fea.motion.envelope import envelope_case

        return numbers.of_envelope(envelope_case(case, threads=1, effort=effort), weighs=task.weighs)
    result = check_case(case, fidelity=task.fidelity, threads=1, effort=effort)
    return numbers.of_check(result, weighs=task.weighs)


@cache
def _folder(contents: tuple[tuple[str, bytes], ...]) -> str:
    """Return a folder of this process that holds the files; "" where there are none."""
    if not contents:
        return ""
    folder = Path(tempfile.mkdtemp(prefix="alula-parts-"))
    atexit.register(owed(lambda: shutil.rmtree(folder, ignore_errors=True)))
    for name, content in contents:
        if hashlib.sha256(content).hexdigest() != name.partition(".")[0] or Path(name).name != name:
            raise CannotRunError("the content of a part's file changed on its way; start the study anew")
        (folder / name).write_bytes(content)
    return str(folder)
