"""The table ``[level]`` of a case file: tests of a standard's level, as whoever owns the standard types them once."""

from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from alula.geometry.base.model import CaseModel, Name, Text, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Force, Length, Time
from alula.loads.records.attachment import Attachment

Axis = Literal["+x", "-x", "+y", "-y", "+z", "-z"]
Stated = Annotated[Text, Field(min_length=1)]


class Offsets(CaseModel):
    """A point of a load line in the axes of the standard, from their origin."""

    forward: Length
    """How far forward it lies; negative behind."""
    outward: Length
    """How far outward, away from the other leg."""
    up: Length
    """How far up."""

    @property
    def vector(self) -> NDArray[np.float64]:
        """Forward, outward, up (3,) [mm]."""
        return np.array([self.forward, self.outward, self.up])


class LevelStep(CaseModel):
    """A step of a test: a force that settles or holds for a while, or that comes and goes."""

    force: Annotated[Force, POSITIVE]
    """The force along the load line, from top to bottom; where it comes and goes the largest one."""
    duration: Annotated[Time, POSITIVE] | None = None
    """How long it is held."""
    least: Annotated[Force, NOT_NEGATIVE] | None = None
    """The least force of each cycle; none at all where left out."""
    cycles: Annotated[float, Field(gt=0)] | None = None
    """How often it comes and goes."""

    @model_validator(mode="before")
    @classmethod
    def _no_profile(cls, stated: object) -> object:
        if isinstance(stated, dict) and "profile" in stated:
            raise refusal(
                "a profile of force and tilt over time is not judged; state its instants as tests of their own, each "
                "with top and bottom as tilted, and the largest force with its cycles"
            )
        return stated

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if self.cycles is not None and self.duration is not None:
            raise refusal("a step is held for a duration or has cycles; state one of the two, or make two steps")
        if self.least is not None and self.cycles is None:
            raise refusal("least is that of cycles, but none are stated; add cycles or leave least out")
        if self.least is not None and self.least >= self.force:
            raise refusal(f"least is {self.least:g} N, but must be below force, {self.force:g} N; swap or correct them")
        return self


class LevelTest(CaseModel):
    """One test of a level: its load line, its steps, and what is asked for."""

    title: Text = ""
    """What the test is, for the report."""
    source: Text = ""
    """Where its numbers come from; that of the level where left out."""
    top: Offsets
    """Where the load line begins, at its upper end."""
    bottom: Offsets
    """Where it ends, at its lower end."""
    steps: Annotated[tuple[LevelStep, ...], Field(min_length=1, max_length=100)]
    """What is done one after the other, such as settling and holding. The step with the largest force decides."""
    elastic: bool = False
    """True: nothing may yield."""
    permanent_set: Annotated[Length, POSITIVE] | None = None
    """How much the distance of the ends of the load line may be changed after the force is gone."""
    no_break: bool = False
    """True: nothing may break or give way."""
    lasts: bool = False
    """True: nothing may fail by fatigue before the end of the cycles."""

    @property
    def decisive(self) -> LevelStep:
        """The step with the largest force; of equal ones the last, of which those before are a part."""
        return max(reversed(self.steps), key=lambda step: step.force)

    @property
    def hold(self) -> float | None:
        """How long the decisive force is held [s]; None where no step says."""
        times = [one.duration for one in self.steps if one.force == self.decisive.force and one.duration is not None]
        return sum(times) if times else None

    @model_validator(mode="after")
    def _asks(self) -> Self:
        if np.allclose(self.top.vector, self.bottom.vector):
            raise refusal("top and bottom are one point, which is no line; correct one of them")
        if not (self.elastic or self.no_break or self.lasts or self.permanent_set is not None):
            raise refusal(
                'it asks for nothing; write elastic = true, permanent_set = "5 mm", no_break = true or lasts = true'
            )
        cyclic = [step for step in self.steps if step.cycles is not None]
        if bool(cyclic) != self.lasts:
            raise refusal(
                "lasts = true needs a step with cycles; add one, such as "
                '{ least = "50 N", force = "1000 N", cycles = 1e6 }'
                if self.lasts
                else "a step has cycles, but that they are borne is not asked; write lasts = true, or leave cycles out"
            )
        if len(cyclic) > 1:
            raise refusal(
                f"{len(cyclic)} steps have cycles, but one is judged; on the safe side state the least force, the "
                "largest force and all cycles in one step"
            )
        if cyclic and self.decisive is not cyclic[0]:
            raise refusal(
                f"a step of {self.decisive.force:g} N is held besides cycles up to {cyclic[0].force:g} N; state it in "
                "a test of its own with the same top and bottom"
            )
        return self


class LevelSpec(CaseModel):
    """Tests of a level of a standard: what is done to the case one after the other, and what it must bear.

    The entries from ``standard`` to ``tests`` may stand in a file beside the case instead, which ``file`` names.
    """

    file: Text | None = None
    """Name of the TOML file beside the case that holds standard, name, condition, source and tests."""
    read_from: Text = ""
    """The level file that these entries were read from, with the digest of its content; alula writes it."""
    standard: Stated
    """Name of the standard, or in whose manner the tests are."""
    name: Stated
    """Name of the level in it."""
    condition: Text = ""
    """The condition of loading in it."""
    source: Text = ""
    """Where the numbers come from; needed here or in each test."""
    tests: Annotated[dict[Name, LevelTest], Field(min_length=1, max_length=100)]
    """The tests by name, each with a load line of its own."""
    test: Name | None = None
    """The one test that the case is then: its load case and checks stand in place of those of the case. ``alula check``
    goes over all where it is left out."""
    enters: Attachment
    """Where the upper end of every load line enters."""
    leaves: Attachment | None = None
    """Where the lower end leaves; where left out, the ground holds against it."""
    origin: tuple[Length, Length, Length] | None = None
    """Where the origin of the standard's axes lies: x, y, z; that of the case where left out."""
    forward: Axis
    """The global axis along which the standard's forward lies, such as "+x"."""
    up: Axis
    """That of its up."""
    outward: Axis | None = None
    """That of its outward. Left out, it is up times forward by the right hand, as of a left leg; a right leg states the
    opposite one."""

    @property
    def axes(self) -> NDArray[np.float64]:
        """Rows forward, outward, up (3, 3) in global axes."""
        forward, up = _unit(self.forward), _unit(self.up)
        outward = np.cross(up, forward) if self.outward is None else _unit(self.outward)
        return np.array([forward, outward, up])

    def place(self, point: Offsets) -> NDArray[np.float64]:
        """Return where a point of a load line lies.

        Parameters
        ----------
        point : Offsets

        Returns
        -------
        array (3,)
            In global axes [mm].
        """
        return self._from + point.vector @ self.axes

    def seen(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return a place in the standard's axes.

        Parameters
        ----------
        place : array (3,)
            In global axes [mm].

        Returns
        -------
        array (3,)
            Forward, outward, up [mm].
        """
        return np.asarray(self.axes @ (place - self._from))

    @property
    def _from(self) -> NDArray[np.float64]:
        return np.array(self.origin or (0.0, 0.0, 0.0))

    @property
    def title(self) -> str:
        """Standard, name and condition for people."""
        return f"{self.standard}, {self.name}" + (f", condition {self.condition}" if self.condition else "")

    @model_validator(mode="after")
    def _fits(self) -> Self:
        named = {entry: axis for entry in ("forward", "up", "outward") if (axis := getattr(self, entry)) is not None}
        if len({axis[1] for axis in named.values()}) < len(named):
            stated = ", ".join(f'{entry} = "{axis}"' for entry, axis in named.items())
            raise refusal(f"two of {stated} lie along one axis; give each an axis of its own")
        silent = [name for name, test in self.tests.items() if not (test.source.strip() or self.source.strip())]
        if silent:
            raise refusal(
                f"test '{silent[0]}' does not say where its numbers come from; write source, for the level or for "
                f"tests.{silent[0]}"
            )
        if self.test is not None and self.test not in self.tests:
            raise refusal(f"test = '{self.test}' is none of its tests; choose one of {', '.join(self.tests)}")
        return self


IN_FILE = ("standard", "name", "condition", "source", "tests")
"""Entries that a level file has; the others are of the case."""


def _unit(axis: Axis) -> NDArray[np.float64]:
    found = np.zeros(3)
    found["xyz".index(axis[1])] = -1.0 if axis[0] == "-" else 1.0
    return found
