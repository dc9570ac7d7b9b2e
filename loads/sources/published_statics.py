"""Audit of a published system of equilibrium equations against the linkage's own.

A published row is an equilibrium equation of its link if it is a combination of that link's three
(sum of F_x, sum of F_y, moment about some point), each joint force counted as acting on the link
with one sign throughout. What of a row lies outside that space is its defect.

Sources write one unknown per joint for both of its links. That is consistent if the links can be
given signs such that the two links of every joint differ (the force then acts on one and is the
reaction on the other); the sign of a link tells how its published forces are to be read.
"""

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name, Text
from alula.geometry.linkage.pose import Pose
from alula.loads.records.applied import Load
from alula.loads.text.explain import printable

Real = NDArray[np.float64]
_MM = 1000.0
"""Published moments are in N m, lengths in m."""


class PublishedStatics(CaseModel):
    """A published system of equilibrium equations, to be solved and audited."""

    source: Text
    """Where the equations are published."""
    exact: str
    """CSV file beside the case file: the coefficients as the source's formulas give them (N, m)."""
    printed: str
    """CSV file beside the case file: the coefficients as printed."""
    links: tuple[Name, ...]
    """The link of each group of three rows."""
    rhs: dict[str, float]
    """Right-hand side by the number of the equation (from 1); zero where left out [N, N m]."""
    reactions: tuple[float, ...]
    """The published solution, in the order of the columns [N, N m]."""
    digits: Annotated[int, Field(ge=0, le=12)] = 4
    """Printed decimals of the solution."""
    tolerance: Annotated[float, Field(gt=0, lt=1)] = 0.01
    """Largest share of a row that may lie outside the linkage's equilibrium equations, since the
    source's angles differ from the assembled pose's."""


@dataclass(frozen=True, kw_only=True)
class RowFinding:
    """How much of one published equation is no equilibrium.

    Attributes
    ----------
    number : int
        Of the equation, from 1.
    link : str
        Its link.
    defect : float
        Share of the row (0 to 1) outside the link's equilibrium equations.
    valid : bool
        True where the defect is within the stated tolerance.
    """

    number: int
    link: str
    defect: float
    valid: bool


@dataclass(frozen=True, kw_only=True)
class Imbalance:
    """What the published reactions leave unbalanced on a link.

    Attributes
    ----------
    link : str
        Name of the link.
    force : array (2,)
        Force [N].
    moment : float
        Moment about the origin of the link's frame [N mm].
    """

    link: str
    force: Real
    moment: float


@dataclass(frozen=True, kw_only=True)
class StaticsAudit:
    """The published matrix solved by alula, and what is wrong with it.

    Attributes
    ----------
    source : str
        Where it is published.
    columns : tuple of str
        Names of the unknowns.
    published, exact, printed : array (n,)
        The published solution, and those of the two coefficient sets [N, N m].
    reproduced : bool
        True where ``exact`` gives every printed digit of the published solution.
    printed_error : float
        Largest difference of ``printed`` from the published solution [N, N m].
    rounding_bound : float
        What rounding the coefficients to their printed decimals allows for it.
    rows : tuple of RowFinding
        One for each equation.
    imbalances : tuple of Imbalance
        One for each link.
    """

    source: str
    columns: tuple[str, ...]
    published: Real
    exact: Real
    printed: Real
    reproduced: bool
    printed_error: float
    rounding_bound: float
    rows: tuple[RowFinding, ...]
    imbalances: tuple[Imbalance, ...]


def read_matrix(text: str) -> tuple[tuple[str, ...], Real]:
    """Read a coefficient matrix.

    Parameters
    ----------
    text : str
        CSV whose first line names the columns.

    Returns
    -------
    columns : tuple of str
        Names of the unknowns.
    matrix : array (n, n)
        Coefficients, one row for each equation.

    Raises
    ------
    CaseError
        For what is no number, and for a matrix that is not square.
    """
    try:
        rows = list(csv.reader(io.StringIO(text)))
        columns = tuple(name.strip() for name in rows[0])
        matrix = np.array([[float(x) for x in row] for row in rows[1:] if row])
    except (IndexError, ValueError, csv.Error) as error:
        why = printable(str(error))
        raise CaseError(f"published_statics: the coefficient file cannot be read ({why}); write numbers") from None
    if matrix.shape != (len(columns), len(columns)):
        raise CaseError(
            f"published_statics: the coefficients have shape {matrix.shape} for {len(columns)} columns; "
            "give as many equations as unknowns"
        )
    if not np.all(np.isfinite(matrix)):
        raise CaseError("published_statics: a coefficient is not finite; write finite numbers")
    return columns, matrix


def audit(
    published: PublishedStatics, exact_text: str, printed_text: str, pose: Pose, loads: Sequence[Load]
) -> StaticsAudit:
    """Solve a published system and hold each of its rows and its solution against the linkage.

    Parameters
    ----------
    published : PublishedStatics
        The table of the case.
    exact_text, printed_text : str
        Text of the two coefficient files.
    pose : Pose
        The assembled pose.
    loads : sequence of Load
        All loads of the load case.

    Returns
    -------
    StaticsAudit
        The solutions and what is wrong.

    Raises
    ------
    CaseError
        If the files, names or counts do not fit together.
    """
    columns, exact = read_matrix(exact_text)
    same, printed = read_matrix(printed_text)
    stated = np.array(published.reactions)
    if same != columns or len(stated) != len(columns) or 3 * len(published.links) != len(columns):
        raise CaseError(
            "published_statics: exact, printed, reactions and links do not fit together; "
            "give the same columns in both files, one reaction per column and one link per three rows"
        )
    rhs = np.zeros(len(columns))
    for number, value in published.rhs.items():
        if not number.isascii() or not number.isdigit() or len(number) > 6 or not 1 <= int(number) <= len(columns):
            raise CaseError(
                f"published_statics.rhs: '{printable(number)}' is no equation; number them from 1 to {len(columns)}"
            )
        rhs[int(number) - 1] = value
    try:
        solutions = _solve(exact, rhs), _solve(printed, rhs)
    except np.linalg.LinAlgError:
        raise CaseError("published_statics: the coefficient matrix is singular; check its rows") from None
    half = 0.5 * 10.0**-published.digits
    signs = _signs(published.links, pose)
    return StaticsAudit(
        source=published.source,
        columns=columns,
        published=stated,
        exact=solutions[0],
        printed=solutions[1],
        reproduced=bool(np.all(np.abs(solutions[0] - stated) <= half * (1 + 1e-9))),
        printed_error=float(np.max(np.abs(solutions[1] - stated))),
        rounding_bound=_rounding_bound(printed, solutions[0], half) + half,
        rows=tuple(
            RowFinding(number=i + 1, link=link, defect=defect, valid=defect <= published.tolerance)
            for i, row in enumerate(exact)
            for link in [published.links[i // 3]]
            for _, defect in [_fit(row, columns, link, pose)]
        ),
        imbalances=tuple(
            _imbalance(link, columns, exact, stated, published.links, signs[link], pose, loads)
            for link in published.links
        ),
    )


def _solve(matrix: Real, rhs: Real) -> Real:
    return np.asarray(np.linalg.solve(matrix, rhs), dtype=np.float64)


def _rounding_bound(matrix: Real, solution: Real, half: float) -> float:
    """Bound |A^-1| |dA| |x| on the change that rounding makes (Higham, Accuracy and Stability, 2nd ed., section 7.2).

    With A the rounded matrix and x the solution of the unrounded one it is no approximation:
    (A - dA) x = b and A y = b give y - x = -A^-1 dA x. Only coefficients other than 0 and 1 were rounded.
    """
    rounded = np.where((matrix == 0.0) | (np.abs(matrix) == 1.0), 0.0, half)
    return float(np.max(np.abs(np.linalg.inv(matrix)) @ (rounded @ np.abs(solution))))


def _unknown(column: str) -> tuple[str, int] | None:
    """Joint and axis of an unknown such as ``RAx``; None for the torque."""
    if column == "T":
        return None
    if not (column.startswith("R") and column[-1:] in ("x", "y")):
        raise CaseError(
            f"published_statics: column '{printable(column)}' is not understood; name columns R<joint>x, R<joint>y, T"
        )
    return column[1:-1], "xy".index(column[-1])


def _equilibrium(link: str, columns: Sequence[str], pose: Pose) -> Real:
    """The link's three equilibrium equations over the published unknowns (3, columns), in m."""
    linkage = pose.linkage
    out = np.zeros((3, len(columns)))
    for k, column in enumerate(columns):
        unknown = _unknown(column)
        if unknown is None:
            continue
        joint, axis = unknown
        if joint not in linkage.joints:
            raise CaseError(
                f"published_statics: column '{printable(column)}' names a joint that does not exist; "
                f"the joints are {', '.join(linkage.joints)}"
            )
        if link not in linkage.joints[joint].links:
            continue
        arm = (pose.position(link, linkage.point_of(joint, link)) - pose.origins[link]) / _MM
        out[axis, k] = 1.0
        out[2, k] = arm[0] if axis == 1 else -arm[1]
    return out


def _fit(row: Real, columns: Sequence[str], link: str, pose: Pose) -> tuple[Real, float]:
    """Nearest combination (3,) of the link's equilibrium equations to a row, and the share left over.

    The drive torque may enter a moment equation of any link with any sign, so it takes no part.
    """
    forces = np.array([column != "T" for column in columns])
    space = _equilibrium(link, columns, pose)[:, forces]
    part = row[forces]
    if not np.any(part):
        return np.zeros(3), 1.0  # no force in it: it says nothing about the equilibrium of forces
    fit, *_ = np.linalg.lstsq(space.T, part, rcond=None)
    return np.asarray(fit), float(np.linalg.norm(part - fit @ space) / np.linalg.norm(part))


def _signs(links: Sequence[str], pose: Pose) -> Mapping[str, float]:
    """Sign of every link such that the two moving links of a joint differ; the last published link is +1."""
    linkage = pose.linkage
    inner = [(name, joint.links) for name, joint in linkage.joints.items() if linkage.ground not in joint.links]
    signs: dict[str, float] = {}
    for start in reversed(links):
        if start in signs:
            continue
        signs[start], waiting = 1.0, [start]
        while waiting:
            here = waiting.pop()
            for _, pair in inner:
                other = pair[0] if pair[1] == here else pair[1]
                if here in pair and other not in signs:
                    signs[other] = -signs[here]
                    waiting.append(other)
    for name, (first, second) in inner:
        if first in signs and signs[first] == signs[second]:
            raise CaseError(
                f"published_statics: no choice of signs makes the force at joint '{name}' an action on one link and "
                "the reaction on the other, so one unknown per joint does not do; remove published_statics"
            )
    return signs


def _imbalance(
    link: str,
    columns: Sequence[str],
    matrix: Real,
    solution: Real,
    links: Sequence[str],
    sign: float,
    pose: Pose,
    loads: Sequence[Load],
) -> Imbalance:
    """Sum the published forces on a link, its loads and the published torque at the assembled pose."""
    sums = sign * _equilibrium(link, columns, pose) @ solution
    force, moment = sums[:2], sums[2] * _MM
    if "T" in columns:
        torque = columns.index("T")
        for row in matrix[3 * links.index(link) : 3 * links.index(link) + 3]:
            # A moment equation may be written with either sign; its torque turns with it.
            turn = np.sign(_fit(row, columns, link, pose)[0][2])
            moment += sign * turn * row[torque] * solution[torque] * _MM
    for load in loads:
        if load.link == link:
            resultant = load.resultant(pose.placement)
            force, moment = force + resultant[:2], moment + resultant[5]
    return Imbalance(link=link, force=force, moment=float(moment))
