"""The case: everything a user states, validated. The case file (TOML) mirrors these records."""

import math
from functools import cached_property
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from geometry.errors import CaseError
from geometry.linkage import Joint, Link, Linkage
from geometry.material import Material, library
from geometry.model import CaseModel, Name
from geometry.part import Body, Part, Pin, PlainEnd
from geometry.pose import Pose, solve_pose
from geometry.units import NOT_NEGATIVE, POSITIVE, Acceleration, Angle, Force, Length, Moment
from loads.statics import Drive, check_drive

Vector = tuple[Force, Force] | tuple[Force, Force, Force]
SCHEMA_VERSION = 1


class PoseSpec(CaseModel):
    """Which position the linkage is in."""

    coordinate: Name | None = None
    """The link whose direction fixes the pose; leave it out for a structure that cannot move."""
    angle: Angle = 0.0
    """Direction of that link's x axis, counter-clockwise from the global x axis."""
    near: dict[Name, Angle] = {}
    """Rough directions of the other links: they choose the assembly branch."""


class DriveSpec(CaseModel):
    """Where the drive torque enters."""

    link: Name
    """The driven link."""
    joint: Name
    """The joint about which it is driven; the torque's reaction goes to the other link there."""
    transfer: Literal["eye-faces", "bore-shear"] = "eye-faces"
    """How the torque enters the driven part: as shear on the eye's flat faces, or on its bore."""


class PointForce(CaseModel):
    """A force at a point of a link, in global axes."""

    link: Name
    at: Name
    force: Vector


class PointMoment(CaseModel):
    """A moment about z at a point of a link, counter-clockwise positive."""

    link: Name
    at: Name
    moment: Moment


class SpreadForce(CaseModel):
    """A force spread evenly along the axis of a link between two of its points, in global axes."""

    link: Name
    start: Name
    end: Name
    total: Vector


class LoadCase(CaseModel):
    """One set of loads that act at the same time."""

    title: str = ""
    own_weight: bool = False
    """True: every link with a part weighs what its volume and density say. False: links are
    massless, and a stated total weight stands among the forces."""
    gravity: Annotated[Acceleration, NOT_NEGATIVE] = 9810.0
    gravity_direction: Angle = -math.pi / 2
    """Direction of the weight, from the global x axis."""
    forces: tuple[PointForce, ...] = ()
    moments: tuple[PointMoment, ...] = ()
    spread: tuple[SpreadForce, ...] = ()


class SafetyFactorCheck(CaseModel):
    """The safety factor of each link must be at least the minimum."""

    type: Literal["safety-factor"]
    minimum: Annotated[float, Field(gt=0)] | None = None
    """The limit; the material's own when left out."""
    links: tuple[Name, ...] = ()
    """The links to check; all that have a part when left out."""


class DisplacementCheck(CaseModel):
    """The largest displacement of each link, relative to the line through its pins, must be small enough."""

    type: Literal["displacement"]
    maximum: Annotated[Length, POSITIVE]
    links: tuple[Name, ...] = ()


Check = Annotated[SafetyFactorCheck | DisplacementCheck, Field(discriminator="type")]


class CantileverCalculation(CaseModel):
    """A hand calculation: a part as a cantilever under an evenly spread load."""

    type: Literal["cantilever"]
    part: Name
    length: Annotated[Length, POSITIVE]
    load: Annotated[Force, NOT_NEGATIVE]
    """The total load [N]."""


class PublishedStatics(CaseModel):
    """A published system of equilibrium equations, to be solved and audited."""

    source: str
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


class SolidSettings(CaseModel):
    """The solid finite-element model."""

    mesh_size: Annotated[float, Field(ge=0.1, le=4.0)] = 1.0
    """Factor on the mesher's own element sizes: 0.5 halves them, 2 doubles them."""
    curved: bool = True
    """Quadratic elements with curved edges; straight edges when false."""


class Case(CaseModel):
    """A linkage with its pose, drive, parts, loads and checks."""

    schema_version: Literal[1]
    title: str
    description: str = ""
    source: str = ""
    assumptions: tuple[str, ...] = ()
    """What the case assumes beyond its source, one sentence each; the report lists them."""
    links: Annotated[dict[Name, Link], Field(min_length=2, max_length=200)]
    joints: Annotated[dict[Name, Joint], Field(min_length=1, max_length=400)]
    pose: PoseSpec = PoseSpec()
    drive: DriveSpec | None = None
    materials: dict[Name, Material] = {}
    """Material cards of the case's own; the library's are there by name without being listed."""
    parts: dict[Name, Part] = {}
    load_cases: Annotated[dict[Name, LoadCase], Field(min_length=1, max_length=100)]
    checks: dict[Name, Check] = {}
    hand_calculations: dict[Name, CantileverCalculation] = {}
    published_statics: PublishedStatics | None = None
    solid: SolidSettings = SolidSettings()

    def model_post_init(self, context: object) -> None:
        """Check that all names fit together; raises ``CaseError``."""
        check_drive(self.linkage, self.pinned_drive)
        if self.linkage.mobility > 0 and self.drive is None:
            raise CaseError(
                f"drive: the linkage has mobility {self.linkage.mobility}, but nothing drives it; "
                "add a [drive] with its link and joint"
            )
        for name, part in self.parts.items():
            if part.material not in self.all_materials:
                raise CaseError(
                    f"parts.{name}.material: '{part.material}' is unknown; choose one of "
                    f"{', '.join(self.all_materials)} or add a card under [materials]"
                )
        for name, link in self.links.items():
            if link.part is not None and link.part not in self.parts:
                raise CaseError(
                    f"links.{name}.part: '{link.part}' is unknown; the parts are {', '.join(self.parts) or 'none'}"
                )
            if link.part is not None:
                self.body(name)
        for name, load_case in self.load_cases.items():
            _check_loads(self, f"load_cases.{name}", load_case)
        for name, check in self.checks.items():
            for checked in check.links:
                if checked not in self.checked_links:
                    raise CaseError(
                        f"checks.{name}.links: '{checked}' is no moving link with a part; "
                        f"choose among {', '.join(self.checked_links) or 'none'}"
                    )
        for name, hand in self.hand_calculations.items():
            if hand.part not in self.parts:
                raise CaseError(
                    f"hand_calculations.{name}.part: '{hand.part}' is unknown; the parts are {', '.join(self.parts)}"
                )
        for audited in self.published_statics.links if self.published_statics else ():
            if audited not in self.linkage.moving:
                raise CaseError(f"published_statics.links: '{audited}' is not a moving link; name moving links")

    @cached_property
    def linkage(self) -> Linkage:
        """The links and joints as one linkage."""
        return Linkage(self.links, self.joints)

    @cached_property
    def pinned_drive(self) -> Drive | None:
        """The drive as statics needs it."""
        return Drive(link=self.drive.link, joint=self.drive.joint) if self.drive else None

    @cached_property
    def all_materials(self) -> dict[str, Material]:
        """The library's materials and the case's own, which win."""
        return library() | self.materials

    @property
    def checked_links(self) -> tuple[str, ...]:
        """The moving links that have a part, hence a stress."""
        return tuple(name for name in self.linkage.moving if self.links[name].part is not None)

    def material_of(self, link: str) -> Material:
        """The material of a link that has a part."""
        return self.all_materials[self.part_of(link).material]

    def part_of(self, link: str) -> Part:
        """The part of a link; raises ``CaseError`` where it has none."""
        name = self.links[link].part
        if name is None:
            raise CaseError(f"links.{link}.part: this link has no part; name one")
        return self.parts[name]

    def body(self, link: str) -> Body:
        """Everything that shapes a link: part, pins, plain ends, holes.

        Raises ``CaseError`` where a pin has no diameter, or a plain end does not lie on the axis.
        """
        record = self.links[link]
        pinned = {self.linkage.point_of(j, link): j for j in self.linkage.joints_of(link)}
        pins, ends = [], []
        for name, (x, y) in record.points.items():
            if name in pinned:
                diameter = self.joints[pinned[name]].pin_diameter
                if diameter is None:
                    raise CaseError(
                        f"joints.{pinned[name]}.pin_diameter: link '{link}' has a part, so this pin needs a diameter; "
                        'state it, for example "1.5 mm"'
                    )
                pins.append(Pin(name=name, x=x, y=y, diameter=diameter))
            elif abs(y) > 1e-9 * self.linkage.longest:
                raise CaseError(
                    f"links.{link}.points.{name}: a load point without pin must lie on the link's axis (y = 0), "
                    f"but y is {y:g} mm; move it onto the axis or make it a joint"
                )
            else:
                ends.append(PlainEnd(name=name, x=x, patch=record.end_patch))
        return Body(part=self.part_of(link), pins=tuple(pins), ends=tuple(ends), holes=record.holes)

    def solve_pose(self) -> Pose:
        """Assemble the linkage in the stated pose."""
        return solve_pose(self.linkage, coordinate=self.pose.coordinate, angle=self.pose.angle, near=self.pose.near)


def _check_loads(case: Case, where: str, load_case: LoadCase) -> None:
    for kind in ("forces", "moments", "spread"):
        for i, load in enumerate(getattr(load_case, kind)):
            entry = f"{where}.{kind}.{i}"
            if load.link not in case.links:
                raise CaseError(f"{entry}.link: '{load.link}' does not exist; the links are {', '.join(case.links)}")
            points = case.links[load.link].points
            for point in (load.start, load.end) if kind == "spread" else (load.at,):
                if point not in points:
                    raise CaseError(
                        f"{entry}: link '{load.link}' has no point '{point}'; its points are {', '.join(points)}"
                    )
            if kind == "spread" and np.isclose(points[load.start][0], points[load.end][0]):
                raise CaseError(f"{entry}: start and end lie at the same station; name two different points")
    if load_case.own_weight and not case.checked_links:
        raise CaseError(f"{where}.own_weight: no moving link has a part, so nothing has a weight; add a part")


def vector3(components: tuple[float, ...]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return a stated vector of two or three components as (3,)."""
    return np.array([*components, 0.0][:3])
