"""The smaller tables of a case file: pose, drive, solid models, hand calculations, ways to hold."""

from typing import Annotated, Literal, NamedTuple

from pydantic import Field, PlainValidator, PrivateAttr, WithJsonSchema
from pydantic_core import PydanticCustomError

from alula.geometry.base.model import CaseModel, Name, Text, refusal
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, Angle, Force, Length, parse
from alula.geometry.linkage.coordinate import Measure
from alula.loads.text.shares import Accuracy


class PoseSpec(CaseModel):
    """Which position the linkage is in."""

    coordinate: Name | None = None
    """The link whose direction fixes the pose, or with a travel the slider or slot that does; leave it out for a
    structure that cannot move."""
    angle: Angle = 0.0
    """Direction of that link's x axis, counter-clockwise from the global x axis."""
    travel: Length | None = None
    """Travel of that slider or slot, from the point of its first link to that of its second, along its direction."""
    near: dict[Name, Angle] = {}
    """Rough directions of the other links: they choose the assembly branch."""
    equilibrium: bool = False
    """True: the linkage is let go at the stated angle or travel, and its pose is where springs, tendons, weights and
    loads balance, or where a stop holds it. A drive then drives the motion alone."""
    _entered: float | None = PrivateAttr(None)

    @property
    def entered(self) -> float | None:
        """Angle [rad] or travel [mm] at which ``near`` chooses the branch, where a cycle moves the pose on from it."""
        return self._entered

    def entered_at(self, value: float | None) -> "PoseSpec":
        """Return the pose of a cycle's instant, on the branch of a stated one.

        Parameters
        ----------
        value : float or None
            Angle [rad] or travel [mm] of the stated one; None where the pose states none.

        Returns
        -------
        PoseSpec
        """
        found = self.model_copy()
        found._entered = value
        return found


class DriveStiffness(NamedTuple):
    """How stiff a drive is.

    Attributes
    ----------
    value : float
        Torque per angle [N mm/rad], or force per travel [N/mm].
    measure : Measure
        Which of the two it is.
    """

    value: float
    measure: Measure


def _drive_stiffness(stated: object) -> DriveStiffness:
    try:
        found = DriveStiffness(parse(stated, "torsional stiffness"), Measure.ANGLE)
    except PydanticCustomError as wrong:
        try:
            found = DriveStiffness(parse(stated, "stiffness"), Measure.TRAVEL)
        except PydanticCustomError:
            raise refusal(
                f'{wrong.message()} for a drive about a joint, or a stiffness such as "20 N/mm" for one along a slider'
            ) from None
    if found.value <= 0.0:
        raise refusal("it must be greater than zero; leave it out for a drive that does not give")
    return found


class DriveSpec(CaseModel):
    """Where the drive torque enters, or at a slider the drive force."""

    link: Name
    """The driven link."""
    joint: Name
    """The joint about which it is driven, or the slider along which it is pushed; the reaction goes to the other link
    there."""
    transfer: Literal["eye-faces", "bore-shear"] = "eye-faces"
    """How the torque enters the driven part: as shear on the eye's flat faces, or on its bore. Where the part
    has no flat ring about that hole it enters through the bore."""
    stiffness: (
        Annotated[
            DriveStiffness,
            PlainValidator(_drive_stiffness),
            WithJsonSchema(
                {
                    "anyOf": [
                        {"type": "string", "format": "torsional stiffness", "examples": ["2 N*m/rad"]},
                        {"type": "string", "format": "stiffness", "examples": ["20 N/mm"]},
                    ]
                }
            ),
        ]
        | None
    ) = None
    """How stiffly it holds its link, for natural frequencies alone: torque per angle about the joint, or force per
    travel along a slider. Left out, it does not give."""
    _stop: str = PrivateAttr("")
    _idle: bool = PrivateAttr(False)

    @property
    def stop(self) -> str:
        """The stop that bears in place of the drive; "" for what a case file states."""
        return self._stop

    @property
    def idle(self) -> bool:
        """True where the pose balances by itself, so that this holds it without any torque."""
        return self._idle

    def in_place(self, *, link: str, joint: str, stop: str = "") -> "DriveSpec":
        """Return what holds the linkage in place of this drive.

        Parameters
        ----------
        link, joint : str
            As for the drive.
        stop : str, optional
            The stop that bears; without one nothing does, and the pose balances by itself.

        Returns
        -------
        DriveSpec
        """
        found = self.model_copy(update={"link": link, "joint": joint})
        found._stop, found._idle = stop, not stop
        return found


class CantileverCalculation(CaseModel):
    """A hand calculation: a part as a cantilever under an evenly spread load."""

    type: Literal["cantilever"]
    part: Name
    """The part whose section bends."""
    length: Annotated[Length, POSITIVE]
    """Length of the cantilever."""
    load: Annotated[Force, NOT_NEGATIVE]
    """The total load [N]."""


class WaysToHold(CaseModel):
    """How far a point moves, by the frame, depending on which link the drive holds and on whether pins turn."""

    link: Name
    """The moving link that has the point."""
    at: Name
    """The point whose displacement is told."""
    published: Annotated[Length, POSITIVE] | None = None
    """A published displacement, to stand beside them."""
    load_case: Name | None = None
    """The load case that it was published for; needed where the case has several."""
    source: Text = ""
    """Where the published displacement stands."""


class SolidSettings(CaseModel):
    """The solid finite-element model."""

    mesh_size: Annotated[float, Field(ge=0.1, le=4.0)] = 1.0
    """Factor on the mesher's own element sizes: 0.5 halves them, 2 doubles them."""
    curved: bool = True
    """Quadratic elements with curved edges; straight edges when false."""
    accuracy: Accuracy | None = None
    """Largest error of the meshes that is wanted in the deciding stress and the displacement, such as "5 %"; without
    it meshes are refined until the verdict is clear or that error is 5 %."""
