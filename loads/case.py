"""The case: everything a user states, validated. The case file (TOML) mirrors these records."""

import math
from functools import cached_property
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from geometry.body_rules import check_body
from geometry.errors import CaseError
from geometry.linkage import Joint, Link, Linkage
from geometry.material import Material, library
from geometry.model import CaseModel, Name, Text, check_file_names
from geometry.ornithopter import OrnithopterRules
from geometry.part import Body, Part, Pin, PlainEnd
from geometry.pose import Pose, solve_pose
from geometry.units import (
    NOT_NEGATIVE,
    POSITIVE,
    Acceleration,
    Angle,
    AngularSpeed,
    Force,
    Length,
    parse,
)
from loads.accuracy import Accuracy
from loads.aero import AirForces, AirLoad, air_forces, check_air
from loads.carried import Carried, CarriedSpread
from loads.check_spec import (
    BearingCheck,
    Check,
    DisplacementCheck,
    MotorCheck,
    PinCheck,
    SafetyFactorCheck,
    SustainedCheck,
)
from loads.claim import Claim
from loads.conditions import Conditions, under
from loads.mass_rules import check_masses, check_weighed
from loads.mechanism import FlappingWingSpec
from loads.motion_spec import MotionSpec
from loads.scatter import LoadScatter
from loads.statics import Drive, check_drive

Vector = Annotated[tuple[Force, ...], Field(min_length=2, max_length=3)]
Axes = Literal["global", "link"]


def _moment(stated: object) -> tuple[float, float, float]:
    if not isinstance(stated, list | tuple):
        return 0.0, 0.0, parse(stated, "moment")
    if len(stated) != 3:
        raise PydanticCustomError(
            "not_a_moment", 'it must be one moment about z or three about x, y and z; write for example "130 N*mm"'
        )
    x, y, z = (parse(component, "moment") for component in stated)
    return x, y, z


MomentVector = Annotated[
    tuple[float, float, float],
    PlainValidator(_moment),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "description": "moment about z with its unit", "examples": ["130 N*mm"]},
                {"type": "array", "items": {"type": "string"}, "minItems": 3, "maxItems": 3},
            ]
        }
    ),
]
SCHEMA_VERSION = 1
MOST_RESULTS = 2_000
"""Load cases times links with a part: each pair is solved, drawn and told of."""
MOST_MOTION = 40_000_000
"""Entries of a motion's equilibrium equations, some 44 bytes each (measured: 100,000 poses of four moving links)."""


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


class DriveSpec(CaseModel):
    """Where the drive torque enters, or at a slider the drive force."""

    link: Name
    """The driven link."""
    joint: Name
    """The joint about which it is driven, or the slider along which it is pushed; the reaction goes to the other link
    there."""
    transfer: Literal["eye-faces", "bore-shear"] = "eye-faces"
    """How the torque enters the driven part: as shear on the eye's flat faces, or on its bore."""


class PointForce(CaseModel):
    """A force at a point of a link."""

    link: Name
    at: Name
    force: Vector
    axes: Axes = "global"
    """Axes of the components: global, or the link's own, so that the force turns with the link."""


class PointMoment(CaseModel):
    """A moment at a point of a link, in global axes: about z, counter-clockwise positive, or about x, y and z."""

    link: Name
    at: Name
    moment: MomentVector


class SpreadForce(CaseModel):
    """A force spread evenly along the axis of a link between two of its points."""

    link: Name
    start: Name
    end: Name
    total: Vector
    axes: Axes = "global"
    """Axes of the components: global, or the link's own, so that the force turns with the link."""


class LoadCase(CaseModel):
    """One set of loads that act at the same time."""

    title: Text = ""
    own_weight: bool = False
    """True: every link weighs what its part's volume and density say and what it carries. False: links are
    massless, and a stated total weight stands among the forces."""
    gravity: Annotated[Acceleration, NOT_NEGATIVE] = 9810.0
    gravity_direction: Angle = -math.pi / 2
    """Direction of the weight, from the global x axis."""
    speed: AngularSpeed = 0.0
    """Constant angular speed of the pose's coordinate, counter-clockwise positive; where stated, the
    inertia of the parts and of what they carry acts as well."""
    carried: bool = True
    """False: without the masses that the links carry."""
    scatter: LoadScatter = (1.0, 1.0)
    """How far all loads of this load case may be off together, such as "20 %", or { low = "90 %", high = "130 %" };
    the bands of all that they do hold it."""
    forces: tuple[PointForce, ...] = ()
    moments: tuple[PointMoment, ...] = ()
    spread: tuple[SpreadForce, ...] = ()
    air: tuple[AirLoad, ...] = ()


class CantileverCalculation(CaseModel):
    """A hand calculation: a part as a cantilever under an evenly spread load."""

    type: Literal["cantilever"]
    part: Name
    length: Annotated[Length, POSITIVE]
    load: Annotated[Force, NOT_NEGATIVE]
    """The total load [N]."""


class PublishedStatics(CaseModel):
    """A published system of equilibrium equations, to be solved and audited."""

    source: Text
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


class WaysToHold(CaseModel):
    """How far a point moves, by the frame, depending on which link the drive holds and on whether pins turn."""

    link: Name
    at: Name
    published: Annotated[Length, POSITIVE] | None = None
    """A published displacement, to stand beside them."""
    load_case: Name | None = None
    """The load case that it was published for; needed where the case has several."""
    source: Text = ""


class SolidSettings(CaseModel):
    """The solid finite-element model."""

    mesh_size: Annotated[float, Field(ge=0.1, le=4.0)] = 1.0
    """Factor on the mesher's own element sizes: 0.5 halves them, 2 doubles them."""
    curved: bool = True
    """Quadratic elements with curved edges; straight edges when false."""
    accuracy: Accuracy | None = None
    """Largest error of the meshes that is wanted in the deciding stress and the displacement, such as "5 %"; without
    it meshes are refined until the verdict is clear or that error is 5 %."""


class Case(CaseModel):
    """A linkage with its pose, drive, parts, loads and checks."""

    schema_version: Literal[1]
    title: Text
    description: Text = ""
    source: Text = ""
    assumptions: tuple[Text, ...] = ()
    """What the case assumes beyond its source, one sentence each; the report lists them."""
    ornithopter: OrnithopterRules | None = None
    """Rules by which ``read_case`` works out the dimensions of the built-in ornithopter or of a copy of it."""
    links: Annotated[dict[Name, Link], Field(min_length=2, max_length=200)]
    joints: Annotated[dict[Name, Joint], Field(min_length=1, max_length=400)]
    pose: PoseSpec = PoseSpec()
    drive: DriveSpec | None = None
    motion: MotionSpec | None = None
    materials: dict[Name, Material] = {}
    """Material cards of the case's own; the library's are there by name without being listed."""
    parts: dict[Name, Part] = {}
    joint_model: Literal["pinned", "bonded"] = "pinned"
    """Whether pins turn freely, or are bonded and carry moments about their own axis as well."""
    large_displacement: Literal["auto", "off"] = "auto"
    """auto: where the linkage moves by more than 5 % of its span, equilibrium is sought on the deformed shape."""
    conditions: Conditions = Conditions()
    ways_to_hold: WaysToHold | None = None
    carried: tuple[Carried, ...] = ()
    """Masses that links carry besides their parts; they weigh where the parts weigh, and have inertia."""
    massless: tuple[Name, ...] = ()
    """Moving links without part or carried mass that are to weigh nothing where others weigh or move."""
    load_cases: Annotated[dict[Name, LoadCase], Field(min_length=1, max_length=100)]
    checks: dict[Name, Check] = {}
    hand_calculations: dict[Name, CantileverCalculation] = {}
    published_statics: PublishedStatics | None = None
    flapping_wing: FlappingWingSpec | None = None
    """The joints of a flapping wing with one crank and two rockers, whose design figures are to be shown."""
    claims: Annotated[tuple[Claim, ...], Field(max_length=1000)] = ()
    """Published figures about the case, for ``alula claims`` to re-derive."""
    solid: SolidSettings = SolidSettings()

    def model_post_init(self, context: object) -> None:
        """Check that all names fit together; raises ``CaseError``."""
        check_file_names("links", self.links)
        check_file_names("load_cases", self.load_cases)
        check_drive(self.linkage, self.pinned_drive)
        if self.linkage.mobility > 0 and self.drive is None and self.joint_model == "pinned":
            raise CaseError(
                f"drive: the linkage has mobility {self.linkage.mobility}, but nothing drives it; "
                "add a [drive] with its link and joint"
            )
        drives = 1 if self.drive else 0
        fits = self.linkage.mobility == drives or (self.linkage.mobility < drives and self._moves)
        if not fits and self.joint_model == "pinned":
            raise CaseError(
                f"drive: the linkage has mobility {self.linkage.mobility} (Gruebler) but {1 if self.drive else 0} "
                "drive; they must be equal, so add or remove joints or links"
            )
        _check_pose(self)
        for name, part in self.parts.items():
            if part.material not in self.all_materials:
                raise CaseError(
                    f"parts.{name}.material: '{part.material}' is unknown; choose one of "
                    f"{', '.join(self.all_materials)} or add a card under [materials]"
                )
        for name, joint in self.joints.items():
            if joint.pin_material not in self.all_materials:
                raise CaseError(
                    f"joints.{name}.pin_material: '{joint.pin_material}' is unknown; choose one of "
                    f"{', '.join(self.all_materials)} or add a card under [materials]"
                )
        for name, link in self.links.items():
            if link.part is not None and link.part not in self.parts:
                raise CaseError(
                    f"links.{name}.part: '{link.part}' is unknown; the parts are {', '.join(self.parts) or 'none'}"
                )
            if link.part is not None:
                _check_body(f"links.{name}", self.body(name))
            elif link.slots or link.arms:
                raise CaseError(f"links.{name}: it has slots or arms, but no part that they shape; name its part")
        for i, mass in enumerate(self.carried):
            _check_carried(self, f"carried.{i}", mass)
        for name, load_case in self.load_cases.items():
            _check_loads(self, f"load_cases.{name}", load_case)
        _check_masses(self)
        for name, check in self.checks.items():
            if isinstance(check, PinCheck | BearingCheck):
                _check_pins(self, name, check)
                continue
            if isinstance(check, MotorCheck):
                _check_motor(self, name)
                continue
            if isinstance(check, DisplacementCheck) and (check.at, check.link) != (None, None):
                _check_displaced(self, name, check)
                continue
            if isinstance(check, SustainedCheck) and self.conditions.duration is None:
                raise CaseError(
                    f"checks.{name}: a sustained load needs to be known for how long; "
                    'add [conditions] with its duration, for example "10 year"'
                )
            for checked in check.links:
                if checked not in self.checked_links:
                    raise CaseError(
                        f"checks.{name}.links: '{checked}' is no moving link with a part; "
                        f"choose among {', '.join(self.checked_links) or 'none'}"
                    )
            for checked in check.links or self.checked_links:
                stated = not isinstance(check, SafetyFactorCheck) or check.minimum is not None
                if not stated and self.material_of(checked).minimum_safety_factor is None:
                    raise CaseError(
                        f"checks.{name}.minimum: it is missing, and '{self.part_of(checked).material}', the material "
                        f"of link '{checked}', states no minimum_safety_factor; add one of the two"
                    )
        if self.conditions != Conditions():
            for checked in self.checked_links:
                self.material_of(checked)
        if self.ways_to_hold is not None:
            _check_point(self, "ways_to_hold", self.ways_to_hold.link, self.ways_to_hold.at)
            _check_published(self, self.ways_to_hold)
        _check_size(self)
        for name, hand in self.hand_calculations.items():
            if hand.part not in self.parts:
                raise CaseError(
                    f"hand_calculations.{name}.part: '{hand.part}' is unknown; the parts are {', '.join(self.parts)}"
                )
        if self.flapping_wing is not None:
            self.flapping_wing.wing(self.linkage)
        if self.motion is not None:
            _check_motion(self)
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
        """The material of a link that has a part, as it is under the case's conditions.

        Raises ``CaseError`` where its card lacks what the conditions ask for.
        """
        return under(self.all_materials[self.part_of(link).material], self.conditions)

    @property
    def all_checks(self) -> dict[str, Check]:
        """The stated checks, or the safety factor of every link where none is; and, where loads stay, that they may."""
        checks = dict(self.checks) or {"safety factor": SafetyFactorCheck(type="safety-factor")}
        if self.conditions.duration is not None and not any(isinstance(c, SustainedCheck) for c in checks.values()):
            checks["sustained load"] = SustainedCheck(type="sustained")
        return checks

    def displaced_point(self, name: str, check: DisplacementCheck) -> tuple[str, str]:
        """Return link and point of a check called ``name`` that is about a point.

        Raises ``CaseError`` where there is no such point, or more than one.
        """
        point = check.at or ""
        if check.link is not None:
            _check_point(self, f"checks.{name}", check.link, point)
            return check.link, point
        owners = [link for link in self.linkage.moving if point in self.links[link].points]
        if not owners:
            every = dict.fromkeys(p for link in self.linkage.moving for p in self.links[link].points)
            raise CaseError(f"checks.{name}.at: no moving link has a point '{point}'; choose among {', '.join(every)}")
        pinned = {
            link
            for joint, record in self.joints.items()
            if record.type == "revolute" and set(self.linkage.joint_points(joint)) == {point}
            for link in record.links
        }
        if len(owners) > 1 and not set(owners) <= pinned:
            raise CaseError(
                f"checks.{name}.at: links {', '.join(owners)} have a point '{point}' each, not joined there by a pin; "
                "add link, the one that is meant"
            )
        return owners[0], point

    def pin_material(self, joint: str) -> Material:
        """The material of a joint's pin; the case's conditions, which are those of the links, leave it alone."""
        return self.all_materials[self.joints[joint].pin_material]

    @property
    def pinned_joints(self) -> tuple[str, ...]:
        """The revolute joints whose pin sits in a link with a part."""
        return tuple(
            name
            for name, joint in self.joints.items()
            if joint.type == "revolute" and set(joint.links) & set(self.checked_links)
        )

    @property
    def bearing_joints(self) -> tuple[str, ...]:
        """The joints whose pin bears on a part: those of ``pinned_joints``, and pins in slots of links with a part."""
        slotted = [
            name
            for name, joint in self.joints.items()
            if joint.type == "pin-in-slot" and joint.links[0] in self.checked_links
        ]
        return (*self.pinned_joints, *slotted)

    def part_of(self, link: str) -> Part:
        """The part of a link; raises ``CaseError`` where it has none."""
        name = self.links[link].part
        if name is None:
            raise CaseError(f"links.{link}.part: this link has no part; name one")
        return self.parts[name]

    def body(self, link: str) -> Body:
        """Everything that shapes a link: part, pins, plain ends, holes.

        Raises ``CaseError`` where a pin has no diameter, a plain end does not lie on the axis, or a slot or arm does
        not fit its joints.
        """
        record = self.links[link]
        _check_slots(self, link)
        pinned: dict[str, str] = {}
        for joint in self.linkage.joints_of(link):
            first = pinned.setdefault(self.linkage.point_of(joint, link), joint)
            if self.joints[first].pin_diameter != self.joints[joint].pin_diameter:
                raise CaseError(
                    f"joints.{joint}.pin_diameter: it differs from that of joint '{first}', but both pins sit in one "
                    f"hole of link '{link}'; give both the same diameter"
                )
        pins, ends = [], []
        for name, (x, y) in record.points.items():
            if name in pinned:
                diameter = self.joints[pinned[name]].pin_diameter
                if diameter is None:
                    raise CaseError(
                        f"joints.{pinned[name]}.pin_diameter: link '{link}' has a part, so this pin needs a diameter; "
                        'state it, for example "1.5 mm"'
                    )
                pins.append(_pin(self, link, name, diameter))
            elif abs(y) > 1e-9 * self.linkage.longest:
                raise CaseError(
                    f"links.{link}.points.{name}: a load point without pin must lie on the link's axis (y = 0), "
                    f"but y is {y:g} mm; move it onto the axis or make it a joint"
                )
            else:
                ends.append(PlainEnd(name=name, x=x, patch=record.end_patch))
        return Body(part=self.part_of(link), pins=tuple(pins), ends=tuple(ends), holes=record.holes)

    @property
    def motion_coordinate(self) -> str:
        """The link whose direction, or slider whose travel, the motion prescribes.

        Raises ``CaseError`` where the case has no motion.
        """
        name = None if self.motion is None else self.motion.coordinate or self.pose.coordinate
        if name is None:
            raise CaseError(
                "motion: the case does not say what moves; add [motion] with its coordinate and a range or turn = true"
            )
        return name

    @property
    def _moves(self) -> bool:
        """True where the stated pose moves by the rank of its Jacobian, such as a parallelogram with a further link."""
        try:
            return self.pose.coordinate is not None and self.solve_pose() is not None
        except CaseError:
            return False

    @property
    def link_points(self) -> dict[str, dict[str, tuple[float, float]]]:
        """Link -> point -> (x, y) in the link's frame [mm]."""
        return {name: link.points for name, link in self.links.items()}

    def air_forces(self, load_case: str) -> tuple[AirForces, ...]:
        """Lift and drag of every air load of a load case."""
        return tuple(
            air_forces(air, f"load_cases.{load_case}.air.{i}") for i, air in enumerate(self.load_cases[load_case].air)
        )

    def solve_pose(self) -> Pose:
        """Assemble the linkage in the stated pose."""
        return solve_pose(
            self.linkage,
            coordinate=self.pose.coordinate,
            angle=self.pose.angle,
            near=self.pose.near,
            travel=self.pose.travel,
        )


def _check_size(case: Case) -> None:
    results = len(case.load_cases) * len(case.checked_links)
    if results > MOST_RESULTS:
        raise CaseError(
            f"load_cases: {len(case.load_cases)} load cases of {len(case.checked_links)} links with a part are "
            f"{results:,} results, but at most {MOST_RESULTS:,} are computed; spread the load cases over several cases"
        )
    if case.motion is None:
        return
    unknowns = 3 * len(case.linkage.moving)
    each = unknowns * (unknowns + len(case.load_cases))
    if case.motion.poses * each > MOST_MOTION:
        raise CaseError(
            f"motion.poses: {case.motion.poses:,} poses of {len(case.linkage.moving)} moving links under "
            f"{len(case.load_cases)} load cases need about {44e-9 * case.motion.poses * each:.2g} GB of memory; "
            f"ask for at most {MOST_MOTION // each:,} poses"
        )


def _check_pose(case: Case) -> None:
    moving, slides = case.linkage.moving, case.pose.travel is not None
    for entry, names in (("pose.coordinate", [case.pose.coordinate]), ("pose.near", [*case.pose.near])):
        for name in names:
            if entry == "pose.coordinate" and slides:
                _check_slides(case, entry, "pose.travel", name)
            elif name is not None and name not in moving:
                raise CaseError(f"{entry}: '{name}' is not a moving link; choose among {', '.join(moving)}")
    if slides and "angle" in case.pose.model_fields_set:
        raise CaseError("pose.angle: a travel fixes the pose already; leave one of the two out")
    if case.linkage.mobility == 1 and case.pose.coordinate is None:
        raise CaseError("pose.coordinate: the linkage can move, but no link fixes its pose; name one and its angle")
    if case.drive is None and case.linkage.mobility == 0 and case.pose.coordinate is not None:
        raise CaseError(
            f"pose.coordinate: it is '{case.pose.coordinate}', but the linkage cannot move (mobility 0); remove it"
        )


def _check_slides(case: Case, entry: str, stated: str, name: str | None) -> None:
    slots = [joint for joint, record in case.joints.items() if record.type != "revolute"]
    if name not in slots:
        raise CaseError(
            f"{entry}: {stated} is the travel of a slider or slot, but '{name}' is none; "
            f"choose among {', '.join(slots) or 'none'}"
        )


def _check_motion(case: Case) -> None:
    spec, name = case.motion, case.motion_coordinate
    assert spec is not None
    if spec.travel is not None:
        _check_slides(case, "motion.coordinate", "motion.travel", name)
    elif spec.coordinate is None and case.pose.travel is not None:
        raise CaseError(
            f"motion: the pose's coordinate '{name}' is a slider, so the motion needs its travel, for example "
            'travel = ["0 mm", "10 mm"], or a coordinate of its own'
        )
    elif name not in case.linkage.moving:
        raise CaseError(f"motion: '{name}' is not a moving link; choose among {', '.join(case.linkage.moving)}")


def _check_body(entry: str, body: Body) -> None:
    try:
        check_body(body)
    except CaseError as error:
        raise CaseError(f"{entry}: {error}") from None


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
            if kind != "spread":
                _check_no_slot(case, entry, load.link, load.at)
            if kind == "spread" and np.isclose(points[load.start][0], points[load.end][0]):
                raise CaseError(f"{entry}: start and end lie at the same station; name two different points")
            if kind == "moments" and load.moment[2] != 0.0:
                _check_torque(case, entry, load)
    for i, air in enumerate(load_case.air):
        check_air(air, f"{where}.air.{i}", case.link_points)
        for patch in air.spread:
            if patch.at is not None:
                _check_no_slot(case, f"{where}.air.{i}", patch.link, patch.at)
    if load_case.speed != 0.0 and case.pose.coordinate is None:
        raise CaseError(f"{where}.speed: the linkage cannot move, so it has no speed; remove it")
    if load_case.speed != 0.0 and case.pose.travel is not None:
        raise CaseError(
            f"{where}.speed: it is the angular speed of the pose's coordinate, but '{case.pose.coordinate}' is a "
            "slider; leave it out and state motion.travel_speed"
        )


def _check_torque(case: Case, entry: str, load: PointMoment) -> None:
    """A pin that turns freely passes no torque about its own axis; only the drive's does."""
    linkage = case.linkage
    pins = [name for name in linkage.joints_of(load.link)
            if linkage.point_of(name, load.link) == load.at and linkage.joints[name].type == "revolute"]  # fmt: skip
    driven = case.drive is not None and case.drive.joint in pins
    if pins and not driven and case.joint_model == "pinned":
        raise CaseError(
            f"{entry}: the pin at '{load.at}' turns freely and nothing drives it, so no torque about z enters link "
            f"'{load.link}' there; name a point of the link without pin, drive that joint, or write "
            'joint_model = "bonded"'
        )


def _check_masses(case: Case) -> None:
    known = {
        "moving": case.linkage.moving,
        "with_part": case.checked_links,
        "carrying": [mass.link for mass in case.carried],
        "massless": case.massless,
    }
    check_masses(**known)
    for name, load_case in case.load_cases.items():
        if load_case.own_weight or load_case.speed != 0.0:
            check_weighed(f"load_cases.{name}.{'own_weight' if load_case.own_weight else 'speed'}", **known)
    if case.motion is not None and case.motion.inertia:
        check_weighed("motion.inertia", **known)


def _check_pins(case: Case, name: str, check: PinCheck | BearingCheck) -> None:
    bearing = isinstance(check, BearingCheck)
    known = case.bearing_joints if bearing else case.pinned_joints
    for joint in check.joints:
        if joint not in known:
            raise CaseError(
                f"checks.{name}.joints: '{joint}' is no revolute joint{' or slot' if bearing else ''} of a link with a "
                f"part; choose among {', '.join(known) or 'none'}"
            )
    if isinstance(check, BearingCheck):
        return
    for joint in check.joints or case.pinned_joints:
        if check.minimum is None and case.pin_material(joint).minimum_safety_factor is None:
            raise CaseError(
                f"checks.{name}.minimum: it is missing, and '{case.joints[joint].pin_material}', the material of the "
                f"pin at joint '{joint}', states no minimum_safety_factor; add one of the two"
            )


def _check_point(case: Case, entry: str, link: str, point: str) -> None:
    if link not in case.linkage.moving:
        raise CaseError(f"{entry}.link: '{link}' is not a moving link; choose among {', '.join(case.linkage.moving)}")
    if point not in case.links[link].points:
        raise CaseError(
            f"{entry}: link '{link}' has no point '{point}'; its points are {', '.join(case.links[link].points)}"
        )


def _check_published(case: Case, asked: WaysToHold) -> None:
    """A published displacement stands beside that of the loads that it was published for, and of no others."""
    known = ", ".join(case.load_cases)
    if asked.load_case is not None and asked.load_case not in case.load_cases:
        raise CaseError(f"ways_to_hold.load_case: '{asked.load_case}' does not exist; the load cases are {known}")
    if asked.published is not None and asked.load_case is None and len(case.load_cases) > 1:
        raise CaseError(f"ways_to_hold.load_case: it is missing; name the one that was published for, among {known}")


def _check_displaced(case: Case, name: str, check: DisplacementCheck) -> None:
    if check.at is None:
        raise CaseError(f"checks.{name}.link: it says whose point is meant, but none is named; add at, or use links")
    if check.links:
        raise CaseError(
            f"checks.{name}.at: it is about one point of the linkage, but links are about each by itself; remove one"
        )
    case.displaced_point(name, check)


def _check_motor(case: Case, name: str) -> None:
    if case.motion is None or case.drive is None:
        raise CaseError(f"checks.{name}: a motor needs a motion to drive; add [motion] and [drive]")
    if Drive(link=case.drive.link, joint=case.drive.joint).pushes(case.linkage):
        raise CaseError(f"checks.{name}: a motor turns, but the drive pushes slider '{case.drive.joint}'; remove one")
    if not any(load_case.speed != 0.0 for load_case in case.load_cases.values()):
        raise CaseError(
            f"checks.{name}: no load case states the speed at which the motor runs; "
            'add one, for example speed = "150 rpm"'
        )


def _check_carried(case: Case, entry: str, mass: Carried) -> None:
    if mass.link not in case.linkage.moving:
        raise CaseError(
            f"{entry}.link: '{mass.link}' is not a moving link; choose among {', '.join(case.linkage.moving)}"
        )
    points = case.links[mass.link].points
    named = (mass.start, mass.end) if isinstance(mass, CarriedSpread) else (mass.at,)
    for point in named:
        if point not in points:
            raise CaseError(f"{entry}: link '{mass.link}' has no point '{point}'; its points are {', '.join(points)}")
    if not isinstance(mass, CarriedSpread):
        _check_no_slot(case, entry, mass.link, mass.at)
    if isinstance(mass, CarriedSpread) and np.isclose(points[mass.start][0], points[mass.end][0]):
        raise CaseError(f"{entry}: start and end lie at the same station; name two different points")


def _check_no_slot(case: Case, entry: str, link: str, point: str) -> None:
    if point in case.links[link].slots:
        raise CaseError(
            f"{entry}: point '{point}' of link '{link}' is a slot, where the pin alone can push; name another point"
        )


def _check_slots(case: Case, link: str) -> None:
    """Check that a link's slots and arms are where pins are, and that every pin that slides in it has a slot."""
    record, linkage = case.links[link], case.linkage
    sliding = {linkage.point_of(name, link): name for name in linkage.joints_of(link)
               if linkage.joints[name].type == "pin-in-slot" and linkage.joints[name].links[0] == link}  # fmt: skip
    for point in record.slots:
        joints = [name for name in linkage.joints_of(link) if linkage.point_of(name, link) == point]
        if point not in sliding or len(joints) != 1:
            raise CaseError(
                f"links.{link}.slots.{point}: a slot belongs to a point with one joint, a pin in slot with "
                f"'{link}' first, but this point has {', '.join(joints) or 'none'}; name another point"
            )
        if case.drive is not None and case.drive.joint in joints:
            raise CaseError(
                f"links.{link}.slots.{point}: its joint '{joints[0]}' is driven, but no torque enters a part at a "
                "slot; drive the linkage at another joint"
            )
        if abs(math.sin(linkage.joints[joints[0]].direction)) > 1e-9:
            raise CaseError(
                f"links.{link}.slots.{point}: a part's slot runs along its link's axis, but joint '{joints[0]}' slides "
                f"in another direction, {math.degrees(linkage.joints[joints[0]].direction):g} deg; state 0 deg and "
                "turn the link's frame"
            )
    for point, name in sliding.items():
        if point not in record.slots:
            raise CaseError(
                f"links.{link}.slots: the pin of joint '{name}' slides in this link, whose part needs a slot for it; "
                f'add slots.{point} = {{ first = "...", last = "..." }}, how far the pin travels along x'
            )
    for point, foot in record.arms.items():
        if point not in record.points or foot not in record.points:
            raise CaseError(
                f"links.{link}.arms: an arm from '{foot}' to '{point}' needs two points of the link; "
                f"its points are {', '.join(record.points)}"
            )
        if not {point, foot} <= {linkage.point_of(name, link) for name in linkage.joints_of(link)}:
            raise CaseError(
                f"links.{link}.arms: an arm from '{foot}' to '{point}' needs a pin at both; make them joints"
            )


def _pin(case: Case, link: str, name: str, diameter: float) -> Pin:
    """Return the hole or slot at a point of a link for a pin of that diameter."""
    record = case.links[link]
    (x, y), slot = record.points[name], record.slots.get(name)
    if slot is not None:
        middle, length = (slot.first + slot.last) / 2.0, slot.last - slot.first
        width = diameter + slot.clearance
        return Pin(name=name, x=middle, y=y, diameter=width, slot=length, clearance=slot.clearance)
    foot = record.arms.get(name)
    return Pin(name=name, x=x, y=y, diameter=diameter, foot=None if foot is None else record.points[foot])


def gravity(load_case: LoadCase) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return the weight per mass of a load case (3,) [mm/s²]."""
    direction = load_case.gravity_direction
    return load_case.gravity * np.array([math.cos(direction), math.sin(direction), 0.0])


def vector3(components: tuple[float, ...]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return a stated vector of two or three components as (3,)."""
    return np.array([*components, 0.0][:3])
