"""The checks that a case file may ask for."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from alula.geometry.base.model import CaseModel, Name, refusal
from alula.geometry.base.units import (
    NOT_NEGATIVE,
    POSITIVE,
    AngularSpeed,
    Current,
    Length,
    Mass,
    Moment,
    Number,
    Stress,
    Voltage,
)
from alula.loads.records.connection import Bond, CrossPin, Flat, Press, Screws, Way


class SafetyFactorCheck(CaseModel):
    """The safety factor of each link must be at least the minimum."""

    type: Literal["safety-factor"]
    minimum: Number | None = None
    """The limit; the material's own when left out."""
    links: tuple[Name, ...] = ()
    """The links to check; all that have a part when left out."""


class DisplacementCheck(CaseModel):
    """The largest displacement must be small enough: of each link by itself, or of one point of the linkage.

    Without ``at`` it is that of each link from the line through its own pins, which tells nothing of where the linkage
    as a whole takes its tip; with it, how far the named point moves while the linkage deforms.
    """

    type: Literal["displacement"]
    maximum: Annotated[Length, POSITIVE]
    """The limit."""
    links: tuple[Name, ...] = ()
    """The links to check, each by itself; all that have a part when neither these nor a point are stated."""
    at: Name | None = None
    """The point whose displacement with the whole linkage is checked: by the solid models of the links where these are
    solved and equilibrium gives the joint forces, else by the frame. Pins move as the mean of their bores."""
    link: Name | None = None
    """The moving link that has the point; may be left out where only one has, or where pins join those that have."""


class SustainedCheck(CaseModel):
    """The stress of each link must stay below what its material bears for as long and as warm as [conditions] say."""

    type: Literal["sustained"]
    links: tuple[Name, ...] = ()
    """The links to check; all that have a part when left out."""


class PinCheck(CaseModel):
    """The safety factor of each pin, in shear and bending under its joint force, must be at least the minimum."""

    type: Literal["pins"]
    minimum: Number | None = None
    """The limit; that of the pin's material when left out."""
    joints: tuple[Name, ...] = ()
    """The joints to check; all whose pin joins a link with a part when left out."""


class BearingCheck(CaseModel):
    """Bearing of each pin on its eyes, F/(d t), against the ultimate strength of the softer one."""

    type: Literal["bearing"]
    minimum: Number | None = None
    """The least safety factor; 3.33 when left out, 6.67 where flight depends on the joint."""
    flight_depends: bool = False
    """True for hinges that flight depends on."""
    joints: tuple[Name, ...] = ()
    """The joints to check; all whose pin joins a link with a part, or slides in its slot, when left out."""

    @property
    def limit(self) -> float:
        """The least safety factor: what is stated, else that of 14 CFR 23.693 or 23.657."""
        return self.minimum or (6.67 if self.flight_depends else 3.33)


BTH_1 = "ASME BTH-1"


class EyeCheck(CaseModel):
    """What the eyes of each link bear, over the forces of their pins, must be at least the minimum in every mode.

    Modes are tension beside the hole, dishing, fracture and shear beyond the pin, and bearing. It is for round eyes of
    bars, tubes, plates and discs, of ductile metals that are not printed; "plastic-collapse" is for others.
    """

    type: Literal["eye"]
    minimum: Number
    """The least factor. ASME BTH-1 asks for 1.20 times its design factor of 2 or 3; partial factors of EN 1993-1-8 are
    not in the number."""
    standard: Literal["ASME BTH-1", "EN 1993-1-8"] = "ASME BTH-1"
    """Whose formulas: those of ASME BTH-1 are against ultimate strength, those of EN 1993-1-8 against yield."""
    links: tuple[Name, ...] = ()
    """The links to check; all of a ductile metal and with round eyes when left out."""


class WallCheck(CaseModel):
    """All loads on each tube or bar must be able to grow by a factor before it buckles as a thin one.

    The wall of a tube buckles where it is compressed and bent, a bent tube flattens, and a deep strip that is bent in
    its stiff plane turns aside and twists. Buckling as a column is checked of every link.
    """

    type: Literal["wall"]
    minimum: Number
    """The least factor. Imperfections are in its band: for strips as for columns, where 1 is the limit."""
    links: tuple[Name, ...] = ()
    """The links to check; all that have a part when left out."""


class LineContactCheck(CaseModel):
    """Contact of each pin with the flank of its slot along a line must not make either of them yield.

    The factor is that on stress, which grows with the root of the force.
    """

    type: Literal["line-contact"]
    minimum: Number
    """The least safety factor: yield strength over the largest von Mises stress below the line, or ``pressure`` over
    the largest pressure."""
    pressure: Annotated[Stress, POSITIVE] | None = None
    """Largest pressure that the softer one may bear, in place of the yield strengths of the cards."""
    joints: tuple[Name, ...] = ()
    """The joints to check; all whose pin slides in the slot of a link with a part when left out."""


class ConnectionCheck(CaseModel):
    """What fixes a link to a shaft, a horn or another link must bear what goes through the joint.

    That is the torque of the drive at its joint, or the moment of a bonded or clamped joint, and the joint's force. One
    of bond, press, flat, cross_pin and screws says what holds it. The shaft has the joint's pin_diameter and
    pin_material.
    """

    type: Literal["connection"]
    joint: Name
    """The drive's joint, or a bonded or clamped one."""
    minimum: Number
    """The least safety factor: what the connection bears over what goes through it, in the mode that bears least."""
    link: Name | None = None
    """The link that is fixed; the driven link when left out, at another joint its second link."""
    bond: Bond | None = None
    """Glue, as a sleeve about the shaft or between flat faces."""
    press: Press | None = None
    """A press fit or a clamp about the shaft."""
    flat: Flat | None = None
    """A D-shaped shaft."""
    cross_pin: CrossPin | None = None
    """A pin across the shaft."""
    screws: Screws | None = None
    """Screws or pins on a circle about the axis."""

    @model_validator(mode="after")
    def _one_way(self) -> "ConnectionCheck":
        stated = [name for name in _WAYS if getattr(self, name) is not None]
        if len(stated) != 1:
            raise refusal(
                f"a connection states one of {', '.join(_WAYS)}, not {' and '.join(stated) or 'none'}; state what "
                "holds it, and a second check where two hold it one after the other"
            )
        return self

    @property
    def way(self) -> Way:
        """What holds it."""
        found: Way = next(way for name in _WAYS if (way := getattr(self, name)) is not None)
        return found

    @property
    def on_shaft(self) -> bool:
        """True where it grips a shaft: all but screws and a glued face."""
        way = self.way
        return not (isinstance(way, Screws) or (isinstance(way, Bond) and way.length is None))

    @property
    def press_by_excess(self) -> bool:
        """True of a press whose pressure follows from its interference, hence from the hub's modulus."""
        return self.press is not None and self.press.interference is not None


_WAYS = ("bond", "press", "flat", "cross_pin", "screws")


class MotorCheck(CaseModel):
    """The motor must cover the drive power over the [motion], in every load case with a speed.

    Where its speed and torque are stated, those of the driven link, against the other link of its joint, must keep to
    them too. All are at the driven link: behind a gear they are those of its output.
    """

    type: Literal["motor"]
    voltage: Annotated[Voltage, POSITIVE]
    """Voltage at the motor."""
    current: Annotated[Current, POSITIVE]
    """Current that it may draw; voltage times current is the electrical power."""
    efficiency: Annotated[float, Field(gt=0, le=1)]
    """Share of the electrical power that reaches the crank."""
    no_load_speed: Annotated[AngularSpeed, POSITIVE] | None = None
    """Speed without load, which the drive must not exceed."""
    stall_torque: Annotated[Moment, POSITIVE] | None = None
    """Torque at standstill; the motor's torque falls from it in a straight line to nothing at no_load_speed."""
    rated_torque: Annotated[Moment, POSITIVE] | None = None
    """Torque that it may give for long, which the root mean square of the drive torque must not exceed."""

    @model_validator(mode="after")
    def _line(self) -> "MotorCheck":
        if self.stall_torque is not None and self.no_load_speed is None:
            raise refusal("stall_torque alone does not say how torque falls with speed; add no_load_speed")
        return self

    @property
    def output_power(self) -> float:
        """Mechanical power at the crank [W]."""
        return self.voltage * self.current * self.efficiency


class LimitLoadCheck(CaseModel):
    """All loads must be able to grow by a factor before the linkage as a whole gives way.

    It gives way by buckling or snapping through on its deformed shape, whatever its material bears.
    """

    type: Literal["limit-load"]
    minimum: Annotated[float, Field(ge=1, le=10)]
    """The least limit-load factor; the deformed shape is followed to ten times the load."""


class PlasticCollapseCheck(CaseModel):
    """All loads on each link must be able to grow by a factor before it flows without end, or to its largest strain.

    Of ductile materials alone, by their yield strength and what hardening_factors and compression_ratio of their cards
    say. It tells whether the link breaks down as a whole, where the safety factor tells where it first yields.
    """

    type: Literal["plastic-collapse"]
    minimum: Number
    """The least plastic-collapse factor of each link."""
    links: tuple[Name, ...] = ()
    """The links to check; all that are ductile and not printed when left out. One whose safety factor is not at or
    above the minimum is solved as a solid."""


class PermanentSetCheck(CaseModel):
    """How far the point at which the load enters stays displaced along its line, once it is gone, must be small enough.

    Along the line of the one force, or the one load line, of each load case: what all links that yield leave of it, by
    their plastic solutions, with strengths as plastic collapse has them. A load line that leaves by another link has
    its two ends nearer to each other by as much. Brittle and printed links must stay elastic.
    """

    type: Literal["permanent-set"]
    maximum: Annotated[Length, POSITIVE]
    """The limit. A link whose safety factor is not wholly at or above 1 is solved as a solid."""


class NotchCheck(CaseModel):
    """Each link of a brittle material must not break at its notches: holes, fillets, edges.

    By the stress at its card's critical distance from them, and by the volume under tension where the card has the
    modulus of Weibull; the lower factor counts. The safety factor has the largest stress of the surface in its place.
    Layers of printed links are judged beside it.
    """

    type: Literal["notch"]
    minimum: Number
    """The least factor."""
    links: tuple[Name, ...] = ()
    """The links to check; all that are brittle when left out. Each is solved as a solid."""


class FatigueCheck(CaseModel):
    """The fatigue strength of each link for the cycles of [conditions], over its stress, must be at least the minimum.

    Both as peaks of a cycle like that of the tests on its material's card. In a pose the stress goes from nothing to
    that of the load and back, over a motion its cycles are counted by rainflow.
    """

    type: Literal["fatigue"]
    minimum: Number = 2.0
    """The least factor. Lives scatter much more than stress, so that it is the stress that is judged."""
    links: tuple[Name, ...] = ()
    """The links to check; all that have a part when left out."""


class ClearanceCheck(CaseModel):
    """Links that lie at one height, and pins and the links that they pass, must stay apart.

    Over the [motion], or in the pose where none is stated. Links in layers are checked even if no check asks for it.
    Deflection and tilting pins must not close the gap between links of different layers.
    """

    type: Literal["clearance"]
    minimum: Annotated[Length, NOT_NEGATIVE] = 0.0
    """The least gap between their outlines in the plane."""


class MassCheck(CaseModel):
    """All that the case models, and what it states besides, must weigh no more than the maximum.

    Parts by volume and density (of a pair both plates, and of the ground where it has one), pins between layers from
    face to face, and what links carry.
    """

    type: Literal["mass"]
    maximum: Annotated[Mass, POSITIVE]
    """The limit."""
    others: Annotated[Mass, NOT_NEGATIVE] | None = None
    """Mass of what the case does not model, such as motor and frame. Left out, what is not counted is named."""


class SizeCheck(CaseModel):
    """The linkage must fit into a box along the global axes, over all poses of the [motion] together.

    In the pose where no motion is stated. Parts and pins count by their outlines and heights, links without a part by
    their points, and [[wings]] as plates.
    """

    type: Literal["size"]
    maximum: tuple[Annotated[Length, POSITIVE], Annotated[Length, POSITIVE], Annotated[Length, POSITIVE]]
    """Its lengths along x, y and z."""


class FrequencyCheck(CaseModel):
    """The lowest natural frequency must be well above the driving frequency, that it does not resonate.

    Over the [motion], or in the pose where none is stated, in every load case with a speed: one turn of the
    coordinate's link is one period, so that the driving frequency is its speed over 2π. Links of a drive that turns
    evenly move unevenly, and so excite at multiples of the driving frequency (harmonics), the less the higher they are.
    A minimum of 4 keeps the first two an octave below the lowest natural frequency.
    """

    type: Literal["frequency"]
    minimum: Number
    """The least lowest natural frequency of the linkage over the driving frequency."""
    links: tuple[Name, ...] = ()
    """The links that are checked by themselves as well; all that have a part when left out."""


Check = Annotated[
    SafetyFactorCheck
    | DisplacementCheck
    | SustainedCheck
    | PinCheck
    | BearingCheck
    | EyeCheck
    | WallCheck
    | LineContactCheck
    | ConnectionCheck
    | LimitLoadCheck
    | PlasticCollapseCheck
    | PermanentSetCheck
    | NotchCheck
    | FatigueCheck
    | ClearanceCheck
    | FrequencyCheck
    | MassCheck
    | MotorCheck
    | SizeCheck,
    Field(discriminator="type"),
]
