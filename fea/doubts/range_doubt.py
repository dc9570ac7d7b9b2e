"""What the range of C_N of wings that flap, and friction, make of the numbers of a check, by hand calculation.

Statics, frame and the hand calculation of every link are done again at the ends of what may be. Over the number as
stated, these are shares by which bands of all models are widened.

Forces without friction are affine in C_N. Hence stress, displacement and the inverse of a buckling factor are convex in
it: their largest is at an end, and for the least the ends and the stated C_N give a bound
(``alula.fea.common.convex``).

Two degrees before a linkage locks itself joint forces double where a coefficient grows by a quarter: no
slope tells. The ends are the least friction that may be, and the largest (``alula.fea.frame.rubbing``); the
coefficients of all joints are at the same end together. Where the linkage locks itself, no band of joint forces has an
end.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from alula.fea.common.convex import least_of_convex
from alula.fea.common.reason import Reason, reason, under_load_cases
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import air_source, friction_source
from alula.fea.doubts.other_case import Doubt, OtherCase, shape_of
from alula.fea.frame.case_statics import CaseStatics, alone, at_friction_ends, solve_case_statics
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.loads.case.joint_rules import friction_ranges
from alula.loads.states.flapping import in_air


@dataclass(frozen=True, kw_only=True, eq=False)
class AirDoubt(Doubt):
    """A load case at the stated C_N and at others of its range; at none where C_N has no range.

    Attributes
    ----------
    ends : tuple of float
        Least and largest C_N.
    coefficients : tuple of float
        The stated C_N, and those of the others, both ends among them.
    """

    ends: tuple[float, float] = (0.0, 0.0)
    coefficients: tuple[float, ...] = ()

    @classmethod
    def of(cls, statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> "AirDoubt":
        """Calculate a load case over the range of its C_N.

        Parameters
        ----------
        statics : CaseStatics
        load_case : str
            Its name.
        moved : LargeDisplacement
            What became of it at the stated C_N.

        Returns
        -------
        AirDoubt
        """
        air = statics.case.load_cases[load_case].flapping
        if air is None or air.ends[0] == air.ends[1]:
            return cls()
        shares = (0.0, 1.0) if air.normal_coefficient not in air.ends else (0.0, 0.5, 1.0)
        others = [solve_case_statics(in_air(alone(statics.case, load_case), share)) for share in shares]
        stated = [other.case.load_cases[load_case].flapping for other in others]
        return cls(
            ends=air.ends,
            coefficients=(air.normal_coefficient, *(one.normal_coefficient for one in stated if one is not None)),
            stated=OtherCase.of(statics, load_case, moved),
            others=tuple(OtherCase.of(one, load_case, shape_of(statics, one, load_case, moved)) for one in others),
        )

    def scatter(self, number: Callable[[OtherCase], float]) -> Scatter:
        """Return what the range makes of a number that is convex in C_N.

        Parameters
        ----------
        number : callable
            Returns it of a load case.

        Returns
        -------
        Scatter
        """
        assert self.stated is not None
        first, *others = zip(self.coefficients, map(number, (self.stated, *self.others)), strict=True)
        return air_scatter(first, dict(others), self.ends)

    def on_shape(self, moved: LargeDisplacement) -> LargeDisplacement:
        """Return what became of a load case with what becomes of it at other C_N.

        Parameters
        ----------
        moved : LargeDisplacement

        Returns
        -------
        LargeDisplacement
        """
        if self.stated is None:
            return moved
        shapes = (one.moved for one in (self.stated, *self.others))
        return replace(moved, air=air_source(*self.ends), airs=tuple(zip(self.coefficients, shapes, strict=True)))


def air_scatter(stated: tuple[float, float], others: Mapping[float, float], ends: tuple[float, float]) -> Scatter:
    """Return what the range of C_N makes of a number that is convex in it and not negative.

    Parameters
    ----------
    stated : tuple of (float, float)
        The stated C_N, and the number there.
    others : mapping of float to float
        Other C_N, both ends of the range among them -> the number there.
    ends : tuple of float
        Of the range.

    Returns
    -------
    Scatter
        On the number at the stated C_N; without upper end where that is zero, and others are not.
    """
    found, value = {**others, stated[0]: stated[1]}, stated[1]
    most, least = max(found.values()), max(least_of_convex(found.items()), 0.0)
    if most <= 0.0:
        return Scatter()
    low, high = (least / value, most / value) if value > 0.0 else (1.0, float("inf"))
    return Scatter(low=min(low, 1.0), high=max(high, 1.0), sources=(air_source(*ends),))


def air_warnings(moved: Mapping[str, LargeDisplacement]) -> list[Reason]:
    """Return what the reader must know about the range of C_N.

    Parameters
    ----------
    moved : mapping of str to LargeDisplacement
        Load case -> from ``AirDoubt.on_shape``.

    Returns
    -------
    list of Reason
    """
    return [
        under_load_cases([load_case], reason("with_normal_coefficient", coefficient=coefficient, why=other.reason))
        for load_case, one in moved.items()
        for coefficient, other in one.airs[1:]
        if other.gives_way and not one.gives_way
    ]


@dataclass(frozen=True, kw_only=True, eq=False)
class FrictionDoubt(Doubt):
    """A load case with the stated friction, and with the least and the largest that may be.

    Attributes
    ----------
    ranges : mapping of str to tuple of float
        Joint that rubs -> its least and largest coefficient.
    locks : bool
        True where the linkage locks itself with some of the friction that may be.
    """

    ranges: Mapping[str, tuple[float, float]]
    locks: bool = False

    @classmethod
    def of(cls, statics: CaseStatics, load_case: str, moved: LargeDisplacement) -> "FrictionDoubt":
        """Calculate a load case at both ends of what friction may be.

        Parameters
        ----------
        statics : CaseStatics
        load_case : str
            Its name.
        moved : LargeDisplacement
            What became of it with the stated friction.

        Returns
        -------
        FrictionDoubt
        """
        ranges, others = friction_ranges(statics.case), at_friction_ends(statics, load_case)
        if not others:
            return cls(ranges=ranges)
        solved = [one for one in others if one is not None]
        return cls(
            ranges=ranges,
            locks=len(solved) < len(others),
            stated=OtherCase.of(statics, load_case, moved),
            others=tuple(OtherCase.of(one, load_case, shape_of(statics, one, load_case, moved)) for one in solved),
        )

    def scatter(self, number: Callable[[OtherCase], float]) -> Scatter:
        """Return what the friction that may be makes of a number.

        Parameters
        ----------
        number : callable
            Returns it of a load case.

        Returns
        -------
        Scatter
            Without upper end where the linkage may lock itself.
        """
        assert self.stated is not None
        return friction_scatter(number(self.stated), [number(one) for one in self.others], self.ranges, self.locks)

    def on_shape(self, moved: LargeDisplacement) -> LargeDisplacement:
        """Return what became of a load case with what becomes of it at both ends.

        Parameters
        ----------
        moved : LargeDisplacement

        Returns
        -------
        LargeDisplacement
        """
        if self.stated is None:
            return moved
        rubbed = tuple(one.moved for one in self.others)
        return replace(moved, friction=friction_source(self.ranges), rubbed=rubbed, locks=self.locks)


def friction_scatter(
    value: float, others: list[float], ranges: Mapping[str, tuple[float, float]], locks: bool
) -> Scatter:
    """Return what the friction that may be makes of a number that is not negative.

    Parameters
    ----------
    value : float
        With the stated friction.
    others : list of float
        With other friction.
    ranges : mapping of str to tuple of float
        Joint that rubs -> its least and largest coefficient.
    locks : bool
        True where the linkage locks itself with some of the friction.

    Returns
    -------
    Scatter
    """
    most, least = max([value, *others]), min([value, *others])
    if not most > 0.0:
        return Scatter()
    low, high = (least / value, most / value) if value > 0.0 else (1.0, math.inf)
    return Scatter(low=low, high=math.inf if locks else high, sources=(friction_source(ranges),))


def friction_warnings(moved: Mapping[str, LargeDisplacement]) -> list[Reason]:
    """Return what the reader must know about the doubt in friction.

    Parameters
    ----------
    moved : mapping of str to LargeDisplacement
        Load case -> from ``FrictionDoubt.on_shape``.

    Returns
    -------
    list of Reason
    """
    return [
        under_load_cases([load_case], reason("locks_with_most_friction", friction=one.friction.detail))
        for load_case, one in moved.items()
        if one.locks and one.friction is not None
    ]
