"""alula from Python: read a case, check it, move it, look at the result.

The functions do what the commands of the same names do. What they return shows itself in a notebook, and hands its
numbers to a script; units are mm, N, N·mm and MPa unless a name says otherwise. ``python -m alula`` is the command.

Examples
--------
>>> import alula
>>> case = alula.read_case("four-bar")
>>> for thickness in ("6 mm", "8 mm"):
...     report = alula.check(case.with_values({"parts.bar.thickness": thickness}), fidelity="beam")
...     print(thickness, report.verdict, f"{report.safety_factors['rocker'].value:.1f}")
6 mm undecided 17.4
8 mm undecided 23.2
"""

import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any


class _Beside:
    """Finds the four packages of a checkout, where they stand beside this folder instead of in it.

    It comes before the finder of an editable install, which may be that of another checkout.
    """

    folder = Path(__file__).parents[1]

    @classmethod
    def find_spec(cls, name: str, path: object = None, target: object = None) -> "ModuleSpec | None":
        above, _, package = name.rpartition(".")
        if above != "alula" or package not in ("geometry", "loads", "fea", "reports"):
            return None
        from importlib.util import spec_from_file_location

        return spec_from_file_location(name, cls.folder / package / "__init__.py")


if not Path(__file__).with_name("geometry").exists() and (_Beside.folder / "geometry" / "__init__.py").exists():
    sys.meta_path.insert(0, _Beside)

from alula.geometry.base.version import alula_version  # noqa: E402 - it has to be found first

if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec

    from alula.loads.case.case import Case as Record
    from alula.loads.compose.stated_case import StatedCase as Case
    from alula.reports.notebook.check_report import CheckReport
    from alula.reports.notebook.claims_report import ClaimsReport
    from alula.reports.notebook.envelope_report import EnvelopeReport
    from alula.reports.notebook.frequency_report import FrequencyReport
    from alula.reports.notebook.level_report import LevelReport
    from alula.reports.notebook.motion_report import MotionReport
    from alula.reports.notebook.part_report import PartReport
    from alula.reports.notebook.size_report import SizeReport
    from alula.reports.notebook.study_report import StudyReport
    from alula.reports.notebook.synthesis_report import SynthesisReport
    from alula.reports.notebook.told_report import ToldReport
    from alula.reports.notebook.tolerance_report import ToleranceReport

__all__ = [
    "Case", "cases", "check", "claims", "envelope", "frequencies", "inspect", "materials", "motion", "read_case",
    "size", "statics", "study", "synthesise", "tolerance",
]  # fmt: skip
__version__ = alula_version()


def __getattr__(name: str) -> Any:
    """Return ``Case``, which is imported where it is needed: all that reads cases takes longer than the rest."""
    if name != "Case":
        raise AttributeError(f"module 'alula' has no attribute '{name}'", name=name)
    from alula.loads.compose.stated_case import StatedCase

    return StatedCase


def cases() -> tuple[str, ...]:
    """Return the names of the built-in cases.

    Examples
    --------
    >>> "owl-wing-static" in cases()
    True
    """
    from alula.loads.case.case_file import built_in_cases

    return built_in_cases()


def read_case(name_or_path: "str | PathLike[str]", values: Mapping[str, object] | None = None) -> "Case":
    """Read and validate a case.

    Parameters
    ----------
    name_or_path : str or path
        Name of a built-in case, or path of a case file.
    values : mapping of str to object, optional
        Other values for some entries, as for ``Case.with_values``.

    Returns
    -------
    Case
        With its links, joints, parts, load cases and checks; ``case.with_values(...)`` changes entries.

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong.

    Examples
    --------
    >>> case = read_case("owl-wing-static")
    >>> case.title
    'Owl-wing prosthesis, static: 0.25 N at the wing tip'
    >>> case.parts["tube"].outer_diameter  # mm
    5.0
    """
    from alula.loads.compose.stated_case import StatedCase

    case = StatedCase.read(name_or_path)
    return case if values is None else case.with_values(values)


def check(
    case: "Case | str | PathLike[str]",
    *,
    fidelity: str = "auto",
    accuracy: str | None = None,
    threads: int = 2,
    progress: Callable[[str], None] | None = None,
) -> "CheckReport | LevelReport":
    """Check a case: pose, statics, stress in every link, verdict; of a case with a level all its tests.

    Parameters
    ----------
    case : Case, str or path
        A case, the name of a built-in one, or the path of a case file.
    fidelity : {"auto", "beam", "solid"}
        The model that decides: hand calculation where it can, else a solid; or one of them for all links.
    accuracy : str, optional
        Error of the meshes to reach in every link, such as ``"5 %"``; without it: a clear verdict or 5 %.
    threads : int
        Threads that each library may use, and child processes that may run at once.
    progress : callable, optional
        Called with a sentence before every stage that may take long, such as ``print``.

    Returns
    -------
    CheckReport or LevelReport
        Verdict, numbers, tables and pictures; of a case with a level ``tests`` has them for each test by its name.

    Raises
    ------
    CaseError
        For a wrong case or option.
    CannotRunError
        Where a stage fails.

    Examples
    --------
    >>> report = check("four-bar", fidelity="beam")
    >>> print(report.verdict)
    undecided
    >>> [row["link"] for row in report.table("links")]
    ['crank', 'coupler', 'rocker']
    >>> round(report.drive_torques["lift"], 1)  # N·mm
    92.6
    """
    from alula.fea.check.run import check_case, effort_of
    from alula.fea.level.check_level import check_level, has_tests
    from alula.reports.notebook.check_report import CheckReport
    from alula.reports.notebook.level_report import LevelReport

    found = _case(case)
    options: dict[str, Any] = {"name": found.origin, "fidelity": fidelity, "threads": threads}
    options |= {"effort": effort_of(found, accuracy), "progress": progress or _silent}
    if has_tests(found):
        return LevelReport(check_level(found, **options))
    return CheckReport(check_case(found, **options))


def statics(case: "Case | str | PathLike[str]", *, matrix: bool = False) -> "ToldReport":
    """Solve pose and joint forces of every load case, and nothing more.

    Parameters
    ----------
    case : Case, str or path
        A case, the name of a built-in one, or the path of a case file.
    matrix : bool
        True for the equations [A][R] = [b] as well.

    Returns
    -------
    ToldReport
        Printed it is what ``alula statics`` tells.

    Raises
    ------
    CaseError
        For a wrong case.

    Examples
    --------
    >>> [row["joint"] for row in statics("four-bar").table()]
    ['O2', 'A', 'B', 'O4']
    """
    from alula.fea.standing.case_statics import solve_case_statics
    from alula.reports.commands.statics import statics_sections
    from alula.reports.notebook.told_report import ToldReport

    found = _case(case)
    sections = statics_sections(solve_case_statics(found, found.origin), matrix=matrix)
    return ToldReport(f"statics of {found.title!r}", sections, first="joints")


def materials(name: str | None = None) -> "ToldReport":
    """Look into the library of materials: values, sources, what is assumed and what is missing.

    Parameters
    ----------
    name : str, optional
        A card to show whole; all of them in one table when left out.

    Returns
    -------
    ToldReport
        Printed it is what ``alula materials`` tells.

    Raises
    ------
    CaseError
        For a name that is not in the library.

    Examples
    --------
    >>> len(materials().table()) > 10
    True
    """
    from alula.reports.commands.materials import told_materials
    from alula.reports.notebook.told_report import ToldReport

    return ToldReport("materials" if name is None else f"material {name!r}", [told_materials(name)])


def motion(case: "Case | str | PathLike[str]", *, threads: int = 2) -> "MotionReport":
    """Move a linkage: directions, paths, joint forces and drive torque over its range.

    Parameters
    ----------
    case : Case, str or path
        A case with a table ``[motion]``, the name of a built-in one, or the path of a case file.
    threads : int
        Threads that each library may use.

    Returns
    -------
    MotionReport
        Curves, table and pictures.

    Raises
    ------
    CaseError
        For a case without motion or drive, and where the motion meets a dead point.
    """
    from alula.fea.common.threads import bounded
    from alula.fea.whole.rubbed_motion import rubbed_motion
    from alula.reports.notebook.motion_report import MotionReport

    with bounded(threads):
        return MotionReport(rubbed_motion(_case(case)))


def frequencies(
    case: "Case | str | PathLike[str]", *, poses: int = 25, count: int = 4, solid: bool = False, threads: int = 2
) -> "FrequencyReport":
    """Find the natural frequencies of a linkage over its motion, and of each link by itself.

    Parameters
    ----------
    case : Case, str or path
        A case, the name of a built-in one, or the path of a case file.
    poses : int
        Over the motion, ends included.
    count : int
        Natural frequencies of every pose and link.
    solid : bool
        True for links by themselves as solids in place of beams.
    threads : int
        Threads that each library may use.

    Returns
    -------
    FrequencyReport
        Bands, table and pictures.

    Raises
    ------
    CaseError
        For a case without a part, and where no card tells the stiffness of a link at the stated temperature.
    CannotRunError
        Where a stage fails.
    """
    from alula.fea.asked.at_temperature import require_stiffness
    from alula.fea.common.threads import bounded
    from alula.fea.vibration.over_motion import case_frequencies
    from alula.reports.notebook.frequency_report import FrequencyReport

    stated = _case(case)
    require_stiffness(stated)
    with bounded(threads):
        return FrequencyReport(case_frequencies(stated, poses=poses, count=count, solid=solid, threads=threads))


def envelope(
    case: "Case | str | PathLike[str]",
    *,
    repetitions: float | None = None,
    accuracy: str | None = None,
    threads: int = 2,
    progress: Callable[[str], None] | None = None,
) -> "EnvelopeReport":
    """Check every link over the whole motion: least safety factor, where and when, and fatigue.

    Parameters
    ----------
    case : Case, str or path
        A case with a table ``[motion]``, the name of a built-in one, or the path of a case file.
    repetitions : float, optional
        How often the motion is to be borne, for fatigue; the cycles of the material's card when left out.
    accuracy, threads, progress
        As for ``check``.

    Returns
    -------
    EnvelopeReport
        Verdict, curves, tables and pictures.

    Raises
    ------
    CaseError
        For a case without motion, drive or part, and for a wrong option.
    CannotRunError
        Where a stage fails.
    """
    from alula.fea.check.run import effort_of
    from alula.fea.motion.envelope import envelope_case
    from alula.reports.notebook.envelope_report import EnvelopeReport

    found = _case(case)
    return EnvelopeReport(
        envelope_case(
            found,
            name=found.origin,
            threads=threads,
            repetitions=repetitions,
            effort=effort_of(found, accuracy),
            progress=progress or _silent,
        )
    )


def claims(name_or_path: "str | PathLike[str]", *, fidelity: str = "solid", threads: int = 2) -> "ClaimsReport":
    """Re-derive the published figures of a source or case, and say which of them hold.

    Parameters
    ----------
    name_or_path : str or path
        Name of a source document, such as ``"owl-wing"``, or of a built-in case, or the path of a case file.
    fidelity : {"solid", "beam"}
        Model for figures on stress; with ``"beam"`` those that need a solid model cannot be re-derived.
    threads : int
        As for ``check``.

    Returns
    -------
    ClaimsReport
        Findings and their table.

    Raises
    ------
    CaseError
        For a name that is neither.
    """
    from alula.fea.claims.sources import check_claims
    from alula.fea.common.threads import bounded
    from alula.reports.notebook.claims_report import ClaimsReport

    with bounded(threads):
        return ClaimsReport(check_claims(fspath(name_or_path), fidelity=fidelity, threads=threads))


def study(
    case: "Case | str | PathLike[str]",
    vary: Mapping[str, object],
    folder: "str | PathLike[str]",
    *,
    link: Mapping[str, str] | None = None,
    values: Mapping[str, object] | None = None,
    analysis: str = "check",
    fidelity: str = "auto",
    threads: int | None = None,
    workers: int | None = None,
) -> "StudyReport":
    """Compute many variants of a case side by side, and keep them in a folder; what stands there is not computed again.

    Parameters
    ----------
    case : Case, str or path
        A case, the name of a built-in one, or the path of a case file.
    vary : mapping of str to object
        Entry -> its values: a list, or a range such as ``"2 mm..8 mm/7"``. All combinations are computed.
    folder : str or path
        For ``study.sqlite``; on a local disk.
    link : mapping of str to str, optional
        Entry -> expression of others, such as ``"outer_diameter + 2*fillet_radius"``.
    values : mapping of str to object, optional
        Other values for some entries, the same in all variants.
    analysis : {"check", "motion", "envelope"}
        What is done with every variant.
    fidelity : {"auto", "beam", "solid"}
        Of a check.
    threads : int, optional
        Variants at a time, each computed by a process of one thread; one a core when left out.
    workers : int, optional
        What ``threads`` was called; it goes with the next version.

    Returns
    -------
    StudyReport
        Counts and table.

    Raises
    ------
    CaseError
        For a wrong case, entry or range, and for a folder of another study.
    CannotRunError
        Where the disk refuses; what was finished stands.
    """
    from alula.fea.study.compute import compute_study
    from alula.loads.compose.plain import plain
    from alula.loads.plans.plan import plan_of
    from alula.loads.plans.variants import Variants
    from alula.reports.notebook.study_report import StudyReport
    from alula.reports.page.output import folder_named

    place, threads = folder_named(folder), _at_a_time(threads, workers)
    plan = plan_of(
        _stated(case).of_study()
        | {
            "vary": plain(vary, "vary"),
            "link": plain({} if link is None else link, "link"),
            "set": plain({} if values is None else values, "values"),
            "analysis": analysis,
            "fidelity": fidelity,
        }
    )
    _, counts = compute_study(Variants(plan, Path()), place, workers=threads)
    return StudyReport(place, counts)


def size(
    case: "Case | str | PathLike[str]",
    vary: Mapping[str, str] | None = None,
    *,
    choose: Mapping[str, str] | None = None,
    step: str | None = None,
    minimise: str | None = None,
    maximise: str | None = None,
    link: Mapping[str, str] | None = None,
    values: Mapping[str, object] | None = None,
    analysis: str = "check",
    fidelity: str = "auto",
    accuracy: str | None = None,
    threads: int | None = None,
    workers: int | None = None,
    folder: "str | PathLike[str] | None" = None,
    progress: Callable[[str], None] | None = None,
) -> "SizeReport":
    """Find the least value of an entry that passes over its whole band; of several entries the least mass.

    Parameters
    ----------
    case : Case, str or path
        A case, the name of a built-in one, or the path of a case file.
    vary : mapping of str to str, optional
        Entry -> its range, such as ``"2 mm..8 mm"``.
    choose : mapping of str to str, optional
        Entry -> its values, or a part -> those of the case that may stand for it: ``"tube-4,tube-5"``.
    step : str, optional
        Distance of two values of a range; a hundredth of it when left out.
    minimise, maximise : str, optional
        What shall be least or greatest: mass, or a number such as ``"drive torque"``.
    link, values, analysis, fidelity, threads, workers
        As for ``study``; ``analysis`` is check or envelope.
    accuracy, progress
        As for ``check``.
    folder : str or path, optional
        That keeps what was computed, as of a study.

    Returns
    -------
    SizeReport
        What passes and what fails, with a table of what was solved.

    Raises
    ------
    CaseError
        For a wrong case, entry or range.
    CannotRunError
        Where the disk refuses.
    """
    from alula.loads.compose.plain import plain
    from alula.reports.commands.size import find_size
    from alula.reports.notebook.size_report import SizeReport
    from alula.reports.page.output import folder_named

    return SizeReport(
        find_size(
            _stated(case),
            _ranges(vary, "vary"),
            _ranges(choose, "choose"),
            step=step,
            minimise=minimise,
            maximise=maximise,
            link=_ranges(link, "link"),
            values=plain({} if values is None else values, "values"),
            analysis=analysis,
            fidelity=fidelity,
            accuracy=accuracy,
            workers=_at_a_time(threads, workers),
            folder=None if folder is None else folder_named(folder),
            tell=progress or _silent,
        )
    )


def tolerance(
    case: "Case | str | PathLike[str]",
    tolerances: Mapping[str, str] | None = None,
    *,
    samples: int = 100_000,
    seed: int = 0,
    accuracy: str | None = None,
    threads: int = 2,
) -> "ToleranceReport":
    """Sample the tolerances of a case: how likely every check passes. The nominal case is solved as solids.

    Parameters
    ----------
    case : Case, str or path
        A case, the name of a built-in one, or the path of a case file.
    tolerances : mapping of str to str, optional
        Besides those of the case: entry -> half the width, such as ``{"pins": "0.2 mm"}``.
    samples, seed : int
    accuracy, threads
        As for ``check``.

    Returns
    -------
    ToleranceReport
        Probabilities, table and pictures.

    Raises
    ------
    CaseError, CannotRunError
        As ``check``, and for a case without tolerances.
    """
    from alula.fea.check.run import effort_of
    from alula.fea.tolerance.analysis import tolerance_case
    from alula.loads.compose.plain import plain
    from alula.reports.commands.tolerance import with_tolerances
    from alula.reports.notebook.tolerance_report import ToleranceReport

    found = with_tolerances(_case(case), plain({} if tolerances is None else tolerances, "tolerances"))
    effort = effort_of(found, accuracy)
    done = tolerance_case(found, name=found.origin, samples=samples, seed=seed, threads=threads, effort=effort)
    return ToleranceReport(done)


def synthesise(points: Sequence[tuple[str, str]], ground: str) -> "SynthesisReport":
    """Find the four-bar whose coupler b and output link c stand at three pairs of directions, with its defects.

    Parameters
    ----------
    points : sequence of tuple of str
        Three pairs (theta of b, psi of c).
    ground : str
        Length of the ground link d.

    Returns
    -------
    SynthesisReport
        Lengths, findings, table and picture.

    Raises
    ------
    CaseError
        For wrong text, other than three points, and where no linkage follows from them.

    Examples
    --------
    >>> found = synthesise([("0 deg", "30 deg"), ("20 deg", "110 deg"), ("5 deg", "130 deg")], "10 m")
    >>> {name: round(length) for name, length in found.lengths.items()}  # mm
    {'a': 1709, 'b': 10344, 'c': 1998, 'd': 10000}
    """
    from alula.reports.commands.synthesis import read_synthesis
    from alula.reports.notebook.synthesis_report import SynthesisReport

    return SynthesisReport(read_synthesis([", ".join(pair) for pair in points], ground))


def inspect(path: "str | PathLike[str]", *, material: str | None = None, unit: str | None = None) -> "PartReport":
    """Look into a STEP file or a mesh: bores, volume, mass, and the entries of a case file for it.

    Parameters
    ----------
    path : str or path
    material : str, optional
        Name of a material of the library.
    unit : str, optional
        Unit of length of a mesh, which its file does not state.

    Returns
    -------
    PartReport
        Numbers, table and picture.

    Raises
    ------
    CaseError, CannotRunError
        For a file that holds no single solid, and where the geometry kernel fails.
    """
    from alula.reports.notebook.part_report import PartReport
    from alula.reports.tools.part import inspect_file

    return PartReport(inspect_file(Path(path), material, unit))


def _case(case: "Case | str | PathLike[str]") -> "Record":
    from alula.loads.case.case import Case as Record

    return case if isinstance(case, Record) else _stated(case).record


def _stated(case: "Case | str | PathLike[str]") -> "Case":
    from alula.geometry.base.errors import CaseError
    from alula.loads.compose.stated_case import StatedCase

    if isinstance(case, str | PathLike):
        return StatedCase.read(case)
    if not isinstance(case, StatedCase):
        raise CaseError(f"case: it is {type(case).__name__}; give a case, the name of a built-in one or a path")
    return case


def _ranges(values: Mapping[str, str] | None, entry: str) -> dict[str, str]:
    from alula.loads.compose.plain import below, mapping_of, text_of

    stated = mapping_of({} if values is None else values, entry, "entries and their values").items()
    return {text_of(path, entry, "path"): text_of(value, below(entry, path), "value") for path, value in stated}


def _at_a_time(threads: int | None, workers: int | None) -> int | None:
    if workers is None:
        return threads
    warnings.warn("workers is called threads now; the old name goes with the next version", FutureWarning, stacklevel=3)
    return workers


def _silent(message: str) -> None:
    """Say nothing of the progress."""
