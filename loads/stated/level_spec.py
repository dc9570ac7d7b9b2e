"""The table ``[level]`` of a case file: tests of a standard's level, as whoever owns the standard types them once."""

import math
from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PrivateAttr, Strict, ValidationInfo, model_validator

from alula.geometry.base import units
from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel, Name, Stated, Text, refusal
from alula.geometry.base.units import LARGEST, LEAST, NOT_NEGATIVE, POSITIVE, Force, Length, Time, weight_in
from alula.loads.records.attachment import Attachment
from alula.loads.records.load_case import Block
from alula.loads.text.explain import printable
from alula.loads.text.number_table import read_number_table

Axis = Literal["+x", "-x", "+y", "-y", "+z", "-z"]
Number = Annotated[units.Number, Strict()]
"""Taken as it stands: neither true nor a text is a number, and no text is true or false."""
Asked = Annotated[bool, Strict()]


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


class LoadState(NamedTuple):
    """What is on the load line at one instant of a test.

    Attributes
    ----------
    name : str
        What the instant is called.
    force : float
        Along the line [N].
    tilt : float
        By which the line is turned [rad].
    time : float or None
        Since the profile began [s]; None of what is no row of one.
    """

    name: str
    force: float
    tilt: float = 0.0
    time: float | None = None


class LevelStep(CaseModel):
    """A step of a test: a force that settles or holds for a while, one that comes and goes, or a profile over time."""

    force: Annotated[Force, POSITIVE] | None = None
    """The force along the load line, from top to bottom; where it comes and goes the largest one."""
    duration: Annotated[Time, POSITIVE] | None = None
    """How long it is held."""
    least: Annotated[Force, NOT_NEGATIVE] | None = None
    """The least force of each cycle; none at all where left out."""
    cycles: Number | None = None
    """How often it comes and goes, or the profile is run through."""
    profile: Annotated[Text, Field(max_length=1000)] | None = None
    """In place of a force, the name of a CSV file beside the case with the columns ``time [ms]``, ``force [N]`` and, if
    the load line turns, ``tilt [deg]``. Positive, the tilt brings the lower end of the line forward of its upper one,
    as where the shank leans forward at the end of a step."""
    scale: Number | None = None
    """By which the forces of the profile are multiplied; 1 where left out."""
    _rows: tuple[LoadState, ...] = PrivateAttr(())

    @property
    def rows(self) -> tuple[LoadState, ...]:
        """Of a profile its rows; empty for other steps."""
        return self._rows

    @property
    def most(self) -> float:
        """Its largest force [N]."""
        return max(row.force for row in self._rows) if self.force is None else self.force

    @model_validator(mode="after")
    def _one_kind(self, info: ValidationInfo) -> Self:
        if (self.force is None) == (self.profile is None):
            raise refusal("a step is of a force or of a profile; state one of the two")
        if self.cycles is not None and self.duration is not None:
            raise refusal("a step is held for a duration or has cycles; state one of the two, or make two steps")
        if self.force is None:
            for entry in ("duration", "least"):
                if getattr(self, entry) is not None:
                    raise refusal(f"{entry} is that of a force, but the profile says when its own are; leave it out")
            try:
                self._rows = _profile_rows(self, info)
            except CaseError as error:
                raise refusal(f"profile: {error}") from None
            return self
        if self.scale is not None:
            raise refusal("scale is that of a profile, but none is stated; leave it out")
        if self.least is not None and self.cycles is None:
            raise refusal("least is that of cycles, but none are stated; add cycles or leave least out")
        if self.least is not None and self.least >= self.force:
            raise refusal(f"least is {self.least:g} N, but must be below force, {self.force:g} N; swap or correct them")
        return self


MOST_ROWS = 1_000
"""Of a profile: as many as a case may have load cases."""
_TIME, _FORCE, _TILT = "time", "force", "tilt"


def _profile_rows(step: LevelStep, info: ValidationInfo) -> tuple[LoadState, ...]:
    """Return the rows of the profile that a step names, with its scale."""
    table = read_number_table(
        (info.context or {}).get("folder", ""), step.profile or "", "time [ms],force [N],tilt [deg]"
    )
    for name in (_TIME, _FORCE):
        table.column(name)
    if strange := [name for name in table.units if name not in (_TIME, _FORCE, _TILT)]:
        raise CaseError(
            f"'{table.name}', column {printable(strange[0])}: a profile has {_TIME}, {_FORCE} and {_TILT} alone; "
            "rename or remove it"
        )
    if len(table.rows) > MOST_ROWS:
        raise CaseError(
            f"'{table.name}' has {len(table.rows)} rows, each of which is a load case, but at most {MOST_ROWS} can be; "
            "thin it out"
        )
    table.rising(_TIME)
    times, forces = table.quantity(_TIME, "time"), table.quantity(_FORCE, "force", weight_in(info))
    tilts = table.quantity(_TILT, "angle") if _TILT in table.units else np.zeros(len(times))
    for wrong, column, rule in (
        (forces < 0.0, _FORCE, "it pulls, but a load line pushes from top to bottom; write a force of at least 0"),
        (np.abs(tilts) >= math.pi / 2.0, _TILT, "the line would lie across; write a tilt below 90 deg"),
    ):
        for i in np.flatnonzero(wrong)[:1]:
            raise table.wrong(table.rows[i], column, rule)
    if not forces.any():
        raise CaseError(f"'{table.name}': all its forces are 0, which loads nothing; correct them")
    scaled = (step.scale or 1.0) * forces
    for i in np.flatnonzero((scaled > LARGEST) | ((scaled > 0.0) & (scaled < LEAST)))[:1]:
        raise table.wrong(table.rows[i], _FORCE, f"with its scale it is {scaled[i]:.3g} N; correct scale or the force")
    every = zip(table.rows, scaled, tilts, times - times[0], strict=True)
    return tuple(LoadState(f"row {row}", float(f), float(tilt), float(t)) for row, f, tilt, t in every)


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
    """What is done one after the other, such as settling, holding and cycles. The largest force decides, of a profile
    the worst row; the harm of cycles adds up over all steps."""
    tilts_about: Offsets | None = None
    """The point about which the load line of a profile turns, by an axis along outward: that of the tilting table, or
    the ``top`` where the line always goes through it. Needed where a profile has a tilt."""
    elastic: Asked = False
    """True: nothing may yield."""
    permanent_set: Annotated[Length, POSITIVE] | None = None
    """How much the distance of the ends of the load line may be changed after the force is gone."""
    no_break: Asked = False
    """True: nothing may break or give way."""
    lasts: Asked = False
    """True: nothing may fail by fatigue before the end of the cycles."""

    @property
    def decisive(self) -> LevelStep:
        """The step with the largest force; of equal ones the last, of which those before are a part."""
        return max(reversed(self.steps), key=lambda step: step.most)

    @property
    def hold(self) -> float | None:
        """How long the decisive force is held [s]; None where no step says."""
        most = self.decisive.most
        times = [one.duration for one in self.steps if one.force == most and one.duration is not None]
        return sum(times) if times else None

    @property
    def cycles(self) -> float | None:
        """Cycles of all steps together; None where none has any."""
        return sum(step.cycles or 0.0 for step in self.steps) or None

    @property
    def profiled(self) -> bool:
        """True where a step is a profile, so that the states of load are not all in proportion."""
        return any(step.profile is not None for step in self.steps)

    @property
    def counted(self) -> tuple[tuple[int, LevelStep], ...]:
        """Number and step of those whose states count: not of what holds no more than cycles reach as well."""
        every = tuple(enumerate(self.steps, 1))
        if self.profiled or self.cycles is None:
            return every
        reached = max(step.most for step in self.steps if step.cycles)
        return tuple(one for one in every if one[1].cycles or one[1].most > reached)

    @property
    def states(self) -> tuple[LoadState, ...]:
        """All states of load that the test goes through in their order; unloaded first, where steps follow each other.

        A step with cycles of a force has its least and its largest, one that holds its force, a profile its rows.
        """
        found, several = list[LoadState](), len(self.counted) > 1
        for number, step in self.counted:
            before = f"step {number}"
            if step.force is None:
                found += [row._replace(name=f"{before} {row.name}") if several else row for row in step.rows]
            else:
                if step.cycles:
                    found.append(LoadState(f"{before} least", step.least or 0.0))
                found.append(LoadState(before, step.force))
        return (LoadState("unloaded", 0.0), *found) if several else tuple(found)

    @property
    def blocks(self) -> tuple[Block, ...]:
        """How often which states follow each other in each of the cycles, for Miner's sum: the cycles of each step.

        Where steps follow each other, the whole test, from no load through all of them and back, counts once besides:
        the way from cycles to a force that is held, and from one step to the next. Empty without cycles.
        """
        if self.cycles is None:
            return ()
        several = len(self.counted) > 1
        found, first = list[Block](), int(several)
        for _, step in self.counted:
            count = len(step.rows) or (2 if step.cycles else 1)
            if step.cycles:
                found.append(Block(tuple(range(first, first + count)), step.cycles / self.cycles))
            first += count
        return (*found, Block(tuple(range(first)), 1.0 / self.cycles)) if several else tuple(found)

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
        tilted = [step for step in self.steps if any(row.tilt for row in step.rows)]
        if bool(tilted) != (self.tilts_about is not None):
            raise refusal(
                "the load line is tilted, but not said about which point it turns; write tilts_about, such as "
                '{ forward = "0 mm", outward = "0 mm", up = "80 mm" }'
                if tilted
                else "tilts_about is that of a profile with a tilt, but there is none; leave it out"
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

    def line(self, test: LevelTest, state: LoadState) -> NDArray[np.float64]:
        """Return where the load line of a test lies at one of its states.

        Tilted, it is turned by the tilt γ about the axis along outward through ``tilts_about``: (forward, up) from
        there becomes (forward cos γ - up sin γ, forward sin γ + up cos γ).

        Parameters
        ----------
        test : LevelTest
        state : LoadState

        Returns
        -------
        array (2, 3)
            Its upper and its lower end in global axes [mm].
        """
        return np.array([self._from + end @ self.axes for end in turned(test, state.tilt)])

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
        if self.leaves == self.enters:
            raise refusal(
                "its forces would enter and leave at one point, so that nothing is left; name another in leaves"
            )
        if self.test is not None and self.test not in self.tests:
            raise refusal(f"test = '{self.test}' is none of its tests; choose one of {', '.join(self.tests)}")
        return self


IN_FILE = ("standard", "name", "condition", "source", "tests")
"""Entries that a level file has; the others are of the case."""


def turned(test: LevelTest, tilt: float) -> NDArray[np.float64]:
    """Return the ends of the load line of a test that is tilted, as ``LevelSpec.line`` says.

    Parameters
    ----------
    test : LevelTest
    tilt : float
        [rad]

    Returns
    -------
    array (2, 3)
        Top and bottom in the axes of the standard [mm].
    """
    ends = np.array([test.top.vector, test.bottom.vector])
    if tilt == 0.0 or test.tilts_about is None:
        return ends
    c, s, about = math.cos(tilt), math.sin(tilt), test.tilts_about.vector
    return np.asarray(about + (ends - about) @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]))


def _unit(axis: Axis) -> NDArray[np.float64]:
    found = np.zeros(3)
    found["xyz".index(axis[1])] = -1.0 if axis[0] == "-" else 1.0
    return found
