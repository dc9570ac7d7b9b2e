"""How a number depends on each entry that varies, by linear regression on all of them at once."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.reports.figures.study.points import Parameter, Real, Response


@dataclass(frozen=True, kw_only=True, eq=False)
class Regression:
    """Standardised coefficients of a linear model.

    Attributes
    ----------
    names : tuple of str
        Of the entries.
    coefficients : ndarray, shape (n,)
        By how many standard deviations the number moves where an entry moves by one; for words the standard deviation
        of their effects.
    unsigned : tuple of bool
        True for words, whose effect has no direction.
    r_squared : float
        Share of the number's variance that the model holds.
    points : int
        That it was fitted to.
    logarithm : bool
        Whether the model is of the number's logarithm.
    """

    names: tuple[str, ...]
    coefficients: Real
    unsigned: tuple[bool, ...]
    r_squared: float
    points: int
    logarithm: bool


def regression(parameters: Sequence[Parameter], response: Response) -> Regression | str:
    """Fit a linear model to the points that have the number.

    Of positive numbers the logarithm is fitted, since margins are factors. Words take one column each but the first.

    Parameters
    ----------
    parameters : sequence of Parameter
    response : Response

    Returns
    -------
    Regression or str
        A sentence where the points do not suffice.

    References
    ----------
    Saltelli et al., Global Sensitivity Analysis: The Primer (2008), section 1.2.5: standardised regression coefficients
    and R².
    """
    known = np.isfinite(response.value)
    value = response.value[known]
    logarithm = bool(value.size) and bool(value.min() > 0.0)
    value = np.log(value) if logarithm else value
    columns = [_columns(parameter, known) for parameter in parameters]
    matrix = np.column_stack(columns) if columns else np.zeros((len(value), 0))
    count = matrix.shape[1]
    if len(value) < count + 3 or not np.ptp(value) > 0.0:
        return f"There are too few points with a known value for sensitivities: {len(value)} for {count} coefficients."
    matrix, value = matrix - matrix.mean(axis=0), value - value.mean()
    size = np.sqrt((matrix**2).mean(axis=0))
    if np.any(size == 0.0) or np.linalg.matrix_rank(matrix / size, tol=1e-8 * np.sqrt(len(value))) < count:
        return "Sensitivities are not to be told: entries vary together in the points with a known value."
    found = np.linalg.lstsq(matrix / size, value, rcond=None)[0] / size
    coefficients, at, spread = [], 0, float(value.std())
    for parameter, own in zip(parameters, columns, strict=True):
        part = found[at : at + own.shape[1]]
        effect = matrix[:, at : at + own.shape[1]] @ part
        sign = 1.0 if parameter.words else float(np.sign(part[0]))
        coefficients.append(sign * float(effect.std()) / spread)
        at += own.shape[1]
    left = value - matrix @ found
    return Regression(
        names=tuple(parameter.path for parameter in parameters),
        coefficients=np.array(coefficients),
        unsigned=tuple(bool(parameter.words) for parameter in parameters),
        r_squared=1.0 - float(left @ left) / float(value @ value),
        points=len(value),
        logarithm=logarithm,
    )


def _columns(parameter: Parameter, known: NDArray[np.bool_]) -> Real:
    values = parameter.values[known]
    if not parameter.words:
        return values[:, None]
    used = np.unique(values)
    return np.column_stack([(values == word).astype(float) for word in used[1:]]) if len(used) > 1 else values[:, None]
