"""Arithmetic with units, as text: what a source shows of its calculation, evaluated safely.

    expression = term {("+" | "-") term}
    term       = factor {("*" | "/") factor}
    factor     = ("+" | "-") factor | atom ["**" factor]
    atom       = number [unit] | path | function "(" expression {"," expression} ")" | "(" expression ")"
    path       = name {"." (name | number | quoted text)}

A unit stands behind its number and holds no spaces (``2 kg/m^3``), so that ``4 N / 2 N`` is a quotient of two
quantities; a name before a dot or a bracket is never a unit. ``^`` is read as ``**``; ``below(a, b)`` is the word
"yes" or "no". Nothing is ever handed to Python to evaluate; length, depth, powers and size of the numbers are
bounded. Angles are a dimension of their own: the functions of an angle ask for one.
"""

import math
import operator
import re
from collections.abc import Callable
from fractions import Fraction
from typing import NoReturn

from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import TYPOGRAPHY
from alula.loads.sources.quantity import ANGLE, UNIT, Dimensions, Value, describe, unit_of
from alula.loads.text.explain import printable

LONGEST = 500
DEEPEST = 60
"""Levels of brackets and signs, two per bracket."""
LARGEST_EXPONENT = 16
Path = tuple[str, ...]

_NUMBER = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_PATH = re.compile(r"[^\W\d]\w*(?:\.(?:\w+|\"[^\"\n]*\"))*")
_SEGMENT = re.compile(r"\"([^\"\n]*)\"|(\w+)")
_SPACE = re.compile(r"\s*")


Names = Callable[[Path], Value | str]
"""Finds what a path stands for; raises ``CaseError`` where it stands for nothing."""


def evaluate(text: str, names: Names | None = None) -> Value | str:
    """Evaluate an expression.

    Parameters
    ----------
    text : str
        The expression.
    names : callable, optional
        Finds what a path stands for; without it paths are refused.

    Returns
    -------
    Value or str
        Its value; text where it is nothing but a path to text.

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong.
    """
    if len(text) > LONGEST:
        raise CaseError(
            f"expression '{printable(text)}': it has {len(text)} characters, at most {LONGEST} are read; split it up"
        )
    return _Parser(text.translate(TYPOGRAPHY), names).run()


def evaluate_number(text: str, names: Names | None = None) -> Value:
    """Evaluate an expression that must be a number.

    Parameters
    ----------
    text : str
        The expression.
    names : callable, optional
        Finds what a path stands for; without it paths are refused.

    Returns
    -------
    Value
        Its value.

    Raises
    ------
    CaseError
        With one sentence for whatever is wrong, also where it is text.
    """
    value = evaluate(text, names)
    if isinstance(value, str):
        raise CaseError(f"expression '{printable(text)}': it is the text '{printable(value)}', not a number")
    return value


class _Parser:
    """Recursive descent over the text; evaluates on the way."""

    def __init__(self, text: str, names: Names | None) -> None:
        self.text, self.names = text, names
        self.at, self.depth = 0, 0

    def run(self) -> Value | str:
        value = self._sum()
        if self._peek():
            self._refuse(f"'{printable(self.text[self.at :])}' is not understood here", "check operators and brackets")
        return value

    def _refuse(self, what: str, remedy: str) -> NoReturn:
        raise CaseError(f"expression '{printable(self.text)}': {what}; {remedy}") from None

    def _peek(self) -> str:
        match = _SPACE.match(self.text, self.at)
        assert match is not None
        self.at = match.end()
        return self.text[self.at : self.at + 1]

    def _take(self, *signs: str) -> str:
        self._peek()
        for sign in signs:
            if self.text.startswith(sign, self.at):
                self.at += len(sign)
                return sign
        return ""

    def _number(self, value: Value | str) -> Value:
        if isinstance(value, str):
            self._refuse(f"the text '{printable(value)}' cannot be calculated with", "name a number")
        return value

    def _checked(self, magnitude: float, dimensions: Dimensions) -> Value:
        if not math.isfinite(magnitude):
            self._refuse("a result is no finite number", "make the numbers smaller")
        if any(abs(e) > LARGEST_EXPONENT for _, e in dimensions):
            self._refuse("a unit gets too high a power", "check the powers")
        return Value(magnitude=magnitude, dimensions=dimensions)

    def _sum(self) -> Value | str:
        self.depth += 1
        if self.depth > DEEPEST:
            self._refuse("it is nested too deeply", "use fewer brackets")
        value = self._product()
        while sign := self._take("+", "-"):
            left, right = self._number(value), self._number(self._product())
            if left.dimensions != right.dimensions:
                self._refuse(
                    f"it adds {describe(left.dimensions)} and {describe(right.dimensions)}",
                    "bring both to one dimension",
                )
            change = right.magnitude if sign == "+" else -right.magnitude
            value = self._checked(left.magnitude + change, left.dimensions)
        self.depth -= 1
        return value

    def _product(self) -> Value | str:
        value = self._factor()
        while self._peek() in ("*", "/") and (sign := self._take("*", "/")):
            left, right = self._number(value), self._number(self._factor())
            if sign == "/" and right.magnitude == 0.0:
                self._refuse("it divides by zero", "check the divisor")
            quotient = left.magnitude / right.magnitude if sign == "/" else left.magnitude * right.magnitude
            value = self._checked(quotient, _combine(left.dimensions, right.dimensions, -1 if sign == "/" else 1))
        return value

    def _factor(self) -> Value | str:
        self.depth += 1
        if self.depth > DEEPEST:
            self._refuse("it is nested too deeply", "use fewer brackets and signs")
        if sign := self._take("+", "-"):
            signed = self._number(self._factor())
            value: Value | str = (
                signed if sign == "+" else Value(magnitude=-signed.magnitude, dimensions=signed.dimensions)
            )
        else:
            value = self._atom()
            if self._take("**", "^"):
                value = self._power(self._number(value), self._number(self._factor()))
        self.depth -= 1
        return value

    def _power(self, base: Value, exponent: Value) -> Value:
        power = exponent.magnitude
        if exponent.dimensions or abs(power) > LARGEST_EXPONENT:
            self._refuse(
                f"a power must be a pure number of at most {LARGEST_EXPONENT}, not {exponent.magnitude:g}", "correct it"
            )
        exact = Fraction(power).limit_denominator(12)
        if base.dimensions and abs(float(exact) - power) > 1e-12:
            self._refuse(f"a quantity with unit cannot be raised to the power {power:g}", "use a simple fraction")
        try:
            magnitude = base.magnitude**power
        except (OverflowError, ZeroDivisionError):
            self._refuse("a power is no finite number", "correct base or power")
        if isinstance(magnitude, complex):
            self._refuse("a root of a negative number is no real number", "correct base or power")
        return self._checked(magnitude, tuple((n, e * exact) for n, e in base.dimensions if exact))

    def _atom(self) -> Value | str:
        here = self._peek()
        if here == "(":
            self.at += 1
            value = self._sum()
            self._close()
            return value
        if number := _NUMBER.match(self.text, self.at):
            self.at = number.end()
            self._peek()
            unit = UNIT.match(self.text, self.at)
            if unit:
                self.at = unit.end()
            factor, dimensions = self._unit(unit[0] if unit else "")
            return self._checked(float(number[0]) * factor, dimensions)
        path = _PATH.match(self.text, self.at)
        if path is None:
            what = f"a number is missing before '{printable(here)}'" if here else "it ends too early"
            self._refuse(what, "complete it")
        self.at = path.end()
        return self._call(path[0]) if self._peek() == "(" else self._named(path[0])

    def _unit(self, text: str) -> tuple[float, Dimensions]:
        try:
            return unit_of(text)
        except CaseError as error:
            raise CaseError(f"expression '{printable(self.text)}': {error}") from None

    def _close(self) -> None:
        if not self._take(")"):
            self._refuse("a bracket is not closed", "close it")

    def _named(self, text: str) -> Value | str:
        path = tuple(match[1] if match[1] is not None else match[2] for match in _SEGMENT.finditer(text))
        if path == ("pi",):
            return Value(magnitude=math.pi)
        if self.names is None:
            self._refuse(f"'{printable(text)}' is a name, but only numbers may stand here", "write its value")
        return self.names(path)

    def _call(self, name: str) -> Value | str:
        if name not in _FUNCTIONS:
            self._refuse(f"'{printable(name)}' is no function", f"choose one of {', '.join(sorted(_FUNCTIONS))}")
        least, most, function = _FUNCTIONS[name]
        self.at += 1
        arguments = [self._number(self._sum())]
        while self._take(","):
            arguments.append(self._number(self._sum()))
        self._close()
        if not least <= len(arguments) <= most:
            self._refuse(f"{name} does not take {len(arguments)} argument(s)", "correct their number")
        try:
            result = function(arguments)
        except (ValueError, OverflowError, ZeroDivisionError):
            self._refuse(f"{name} has no value there", "correct its arguments")
        except _WrongDimensionError as wrong:
            self._refuse(f"{name} needs {wrong}", "correct the units")
        return result if isinstance(result, str) else self._checked(result.magnitude, result.dimensions)


class _WrongDimensionError(Exception):
    pass


def _combine(left: Dimensions, right: Dimensions, sign: int) -> Dimensions:
    powers = dict(left)
    for name, exponent in right:
        powers[name] = powers.get(name, Fraction(0)) + sign * exponent
    return tuple(sorted((name, e) for name, e in powers.items() if e))


def _alike(values: list[Value]) -> Dimensions:
    if any(v.dimensions != values[0].dimensions for v in values):
        raise _WrongDimensionError("arguments of one dimension")
    return values[0].dimensions


def _of_angle(function: Callable[[float], float]) -> Callable[[list[Value]], Value]:
    def apply(values: list[Value]) -> Value:
        if values[0].dimensions != ANGLE:
            raise _WrongDimensionError("an angle with its unit, such as 30 deg")
        return Value(magnitude=function(values[0].magnitude))

    return apply


def _to_angle(function: Callable[[float], float]) -> Callable[[list[Value]], Value]:
    def apply(values: list[Value]) -> Value:
        if values[0].dimensions:
            raise _WrongDimensionError("a pure number")
        return Value(magnitude=function(values[0].magnitude), dimensions=ANGLE)

    return apply


def _atan2(values: list[Value]) -> Value:
    _alike(values)
    return Value(magnitude=math.atan2(values[0].magnitude, values[1].magnitude), dimensions=ANGLE)


def _same(function: Callable[..., float]) -> Callable[[list[Value]], Value]:
    def apply(values: list[Value]) -> Value:
        return Value(magnitude=function(*(v.magnitude for v in values)), dimensions=_alike(values))

    return apply


def _sqrt(values: list[Value]) -> Value:
    [value] = values
    return Value(magnitude=math.sqrt(value.magnitude), dimensions=tuple((n, e / 2) for n, e in value.dimensions))


def _below(values: list[Value]) -> str:
    _alike(values)
    return "yes" if values[0].magnitude < values[1].magnitude else "no"


_FUNCTIONS: dict[str, tuple[int, int, Callable[[list[Value]], Value | str]]] = {
    "sqrt": (1, 1, _sqrt),
    "abs": (1, 1, _same(abs)),
    "min": (1, 50, _same(lambda *values: min(values))),
    "max": (1, 50, _same(lambda *values: max(values))),
    "hypot": (1, 3, _same(math.hypot)),
    "mod": (2, 2, _same(operator.mod)),
    "below": (2, 2, _below),
    "sin": (1, 1, _of_angle(math.sin)),
    "cos": (1, 1, _of_angle(math.cos)),
    "tan": (1, 1, _of_angle(math.tan)),
    "asin": (1, 1, _to_angle(math.asin)),
    "acos": (1, 1, _to_angle(math.acos)),
    "atan": (1, 1, _to_angle(math.atan)),
    "atan2": (2, 2, _atan2),
}
