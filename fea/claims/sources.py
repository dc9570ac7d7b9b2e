"""Re-derives all claims of a case or of a source document, tables of designs included."""

import csv
import io
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from alula.fea.claims.audit import ClaimResult, Finding, Names, check_claim
from alula.fea.claims.data import Tree, case_tree, flapping_tree, system_tree
from alula.fea.common.reason import reason
from alula.fea.outcomes.result import CheckResult
from alula.geometry.base.errors import CaseError
from alula.geometry.mechanisms.flapping import FlappingWing
from alula.loads.case.case_file import built_in_cases, read_case, read_companion
from alula.loads.sources.claim import Claim, PublishedSource, System, TableSystem, read_source, sources
from alula.loads.text.explain import printable

_CELLS = {
    "ground_d_mm": ("ground", "", "mm"),
    "grashof_satisfied": ("grashof", "", ""),
    "phase_lag_deg": ("published.phase_lag", "metrics.phase_lag", "deg"),
    "oscillation_deg": ("published.oscillation", "metrics.oscillation", "deg"),
    "asymmetry_deg": ("published.asymmetry", "metrics.asymmetry", "deg"),
}
"""Columns of a table of designs: our quantity, what the name says, unit."""
FIDELITIES = ("solid", "beam")


def check_claims(
    name: str,
    *,
    overrides: Iterable[str] = (),
    fidelity: str = "solid",
    threads: int = 2,
    known: CheckResult | None = None,
) -> tuple[ClaimResult, ...]:
    """Re-derive the claims of a case or of a source document.

    Parameters
    ----------
    name : str
        A source (``owl-wing``: all its claims), a built-in case (the claims of any source that belong to it, and its
        own), or the path of a case file (its own ``[[claims]]``).
    overrides : iterable of str, optional
        Entries of the case to set anew, as ``path=value``.
    fidelity : str, optional
        "beam" leaves out the claims that need a solid model: they cannot be re-derived then.
    threads : int, optional
        Upper bound on the threads of a solver.
    known : CheckResult, optional
        A check whose frames are not solved again where it is of the very case that a claim is about.

    Returns
    -------
    tuple of ClaimResult
        One result per claim, in the order of the source.

    Raises
    ------
    CaseError
        For a name that is neither, and for a claim that cannot be read.
    """
    if fidelity not in FIDELITIES:
        raise CaseError(f"fidelity: '{printable(fidelity)}' is unknown; choose one of {', '.join(FIDELITIES)}")
    overrides = tuple(overrides)
    if overrides and name in sources() and name not in built_in_cases():
        raise CaseError(f"--set: '{name}' is a source document, not a case; name a case to set its entries anew")
    solve = partial(_tree_of, threads=threads, fidelity=fidelity, known=known)
    found: list[ClaimResult] = []
    for source in sources():
        record = read_source(source)
        if source == name:
            found += _check_source(record, None, solve)
        elif any(claim.case == name for claim in record.claims):
            found += _check_source(record, name, partial(solve, overrides={name: overrides}))
    if name in built_in_cases() or not found:
        case = read_case(name, overrides)
        tree = case_tree(case, name, fidelity=fidelity, threads=threads, known=known)
        found += [check_claim(claim, Names(tree, {}, claim.not_stated)) for claim in case.claims]
    return tuple(found)


def claims_of(result: CheckResult) -> tuple[ClaimResult, ...]:
    """Return the findings on the published figures of a case that was checked.

    Those that need a solid model of the source's own parts are not judged.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    tuple of ClaimResult
        Empty where none were published.
    """
    if not result.case.claims and result.name not in built_in_cases():
        return ()
    return check_claims(result.name, fidelity="beam", known=result)


def check_all(*, fidelity: str = "solid", threads: int = 2) -> dict[str, tuple[ClaimResult, ...]]:
    """Re-derive the claims of every source document, by its name.

    Parameters
    ----------
    fidelity : str, optional
        "beam" leaves out the claims that need a solid model.
    threads : int, optional
        Upper bound on the threads of a solver.

    Returns
    -------
    dict of str to tuple of ClaimResult
        Source and the results of its claims.
    """
    return {name: check_claims(name, fidelity=fidelity, threads=threads) for name in sources()}


def _tree_of(
    system: System | str,
    *,
    fidelity: str,
    threads: int,
    known: CheckResult | None,
    overrides: Mapping[str, tuple[str, ...]] | None = None,
) -> Mapping[str, Any]:
    """Return the quantities of a system, or of a built-in case by its name."""
    if isinstance(system, str):
        case = read_case(system, (overrides or {}).get(system, ()))
        return case_tree(case, system, fidelity=fidelity, threads=threads, known=known)
    return system_tree(system, fidelity=fidelity, threads=threads)


def _check_source(
    source: PublishedSource, case: str | None, solve: Callable[..., Mapping[str, Any]]
) -> list[ClaimResult]:
    """Re-derive the claims of a source: all, or those of one case."""
    systems = {
        key: partial(solve, system) for key, system in source.systems.items() if not isinstance(system, TableSystem)
    }
    cases = Tree(**{name: partial(solve, name) for name in built_in_cases()})
    found = []
    for claim in source.claims:
        if case is not None and claim.case != case:
            continue
        branches: dict[str, Callable[[], Any]] = dict(systems)
        if claim.case is not None and claim.case in cases:
            tree = cases[claim.case]
            branches |= {key: partial(tree.__getitem__, key) for key in tree}
        found.append(check_claim(claim, Names(Tree(**branches), source.given, source.not_stated | claim.not_stated)))
    for key, system in source.systems.items():
        if case is None and isinstance(system, TableSystem):
            found += check_table(key, system)
    return found


def check_table(name: str, table: TableSystem) -> list[ClaimResult]:
    """Re-derive every published cell of a table of flapping-wing designs; claims are named ``table.model.column``.

    A cell that does not hold, but stands in another row of the column where it does hold, is told as such: figures
    slip into the wrong row when tables are copied.

    Parameters
    ----------
    name : str
        Of the table in its source, with which the claims' names begin.
    table : TableSystem
        The table's file and where it stands in the source.

    Returns
    -------
    list of ClaimResult
        One result per cell.
    """
    text = read_companion(built_in_cases()[0], table.file)
    found: list[ClaimResult] = []
    for row in csv.DictReader(io.StringIO("".join(x for x in text.splitlines(True) if not x.startswith("#")))):
        lengths = ("crank_a_mm", "coupler_b_mm", "rocker_c_mm", "width_x_mm", "height_y_mm")
        crank, coupler, rocker, width, height = (float(row[column]) for column in lengths)
        tree = flapping_tree(FlappingWing(crank=crank, coupler=coupler, rocker=rocker, width=width, height=height))
        where = f"{row['table']}.{row['model']}"
        names = Names({name: {row["table"]: {row["model"]: tree}}}, {}, {})
        for column, (quantity, means, unit) in _CELLS.items():
            if not row[column]:
                continue
            prefix = f"{name}.{where}."
            claim = Claim(
                name=f"{where}.{column}",
                quantity=prefix + quantity,
                means=prefix + means if means else "",
                published=f"{row[column]} {unit}".strip(),
                source=f"{table.source}, table {row['table']}, row {row['model']}",
            )
            found.append(check_claim(claim, names))
    return [_with_twin(result, found) for result in found]


def _with_twin(result: ClaimResult, all_cells: list[ClaimResult]) -> ClaimResult:
    if not result.finding.refutes:
        return result
    table, _, column = result.claim.name.split(".")
    twins = [
        other.claim.name
        for other in all_cells
        if other.finding is Finding.HOLDS
        and other.claim.name.split(".")[2] == column
        and other.claim.published == result.claim.published
    ]
    if not twins:
        return result
    near = min(twins, key=lambda twin: twin.split(".")[0] != table)
    return replace(result, notes=(*result.notes, reason("holds_in_row", row=near.rpartition(".")[0])))
