"""The core of a case: what a user states, as the case file (TOML) mirrors it; ``case_rules`` holds its rules."""

from dataclasses import replace
from functools import cached_property
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import Name, Stated, Text
from alula.geometry.base.units import NOT_NEGATIVE, POSITIVE, STANDARD_GRAVITY, Length, Mass
from alula.geometry.bodies.body import PartKind
from alula.geometry.bodies.features import FlatFace
from alula.geometry.joints.joint import Joint
from alula.geometry.linkage.coordinate import Coordinate, Measure
from alula.geometry.linkage.linkage import Link, Linkage
from alula.geometry.linkage.motion import solve_motion
from alula.geometry.linkage.pose import Pose, solve_pose
from alula.geometry.materials.material import Material, library
from alula.geometry.parts.part import Body, FilePart, Part, Pin, PlainEnd
from alula.geometry.placement.fit import Wanted
from alula.geometry.placement.placed_body import faces_of, placed_body
from alula.loads.acting.cycle import Cycle
from alula.loads.acting.springs import Spring, Tendon
from alula.loads.acting.stop import Stop
from alula.loads.case.eyes import with_eye
from alula.loads.case.heights import heights, plates_apart
from alula.loads.records.aero import AirForces, air_forces
from alula.loads.records.carried import Carried
from alula.loads.records.check_spec import (
    Check,
    ClearanceCheck,
    DisplacementCheck,
    FatigueCheck,
    SafetyFactorCheck,
    SustainedCheck,
)
from alula.loads.records.conditions import Conditions, at_temperature, under
from alula.loads.records.cycle_spec import CycleSpec
from alula.loads.records.flapping import Wing
from alula.loads.records.load_case import Block, LoadCase
from alula.loads.records.motion_spec import MotionSpec
from alula.loads.records.settings import CantileverCalculation, DriveSpec, PoseSpec, SolidSettings, WaysToHold
from alula.loads.records.tolerances import TolerancesTable
from alula.loads.stated.level_spec import LevelSpec
from alula.loads.statics.statics import Drive
from alula.loads.text.places import check_point
from alula.loads.text.revisable import Revisable


class CoreCase(Revisable):
    """A linkage with its pose, drive, parts, loads and checks; ``Case`` adds tables that serve published sources."""

    schema_version: Literal[1]
    """Version of the case file's format."""
    title: Stated
    """What the case is, in a line; every report has it."""
    description: Text = ""
    """What it is about, in a few sentences."""
    source: Text = ""
    """Where its numbers come from."""
    assumptions: tuple[Text, ...] = ()
    """What the case assumes beyond its source, one sentence each; the report lists them."""
    body_mass: Annotated[Mass, POSITIVE] | None = None
    """Mass of the body whose weight, under standard gravity of 9.80665 m/s², is the unit body_weight: any force may be
    stated as "1.1 body_weight", any moment as "0.05 body_weight*m"."""
    links: Annotated[dict[Name, Link], Field(min_length=2, max_length=200)]
    """The links by name; one of them is the ground."""
    joints: Annotated[dict[Name, Joint], Field(min_length=1, max_length=400)]
    """The joints by name: each connects two links."""
    pose: PoseSpec = PoseSpec()
    """The position that is checked."""
    drive: DriveSpec | None = None
    """What holds the pose against the loads; left out for a structure, or where the pose balances by itself."""
    motion: MotionSpec | None = None
    """The motion over which ``alula motion`` and ``alula envelope`` go."""
    cycle: CycleSpec | None = None
    """A table of angles and loads, such as a stride, over which they go in place of a range."""
    springs: Annotated[dict[Name, Spring], Field(max_length=100)] = {}
    """Springs between points of two links, or about a revolute joint; they act in every load case."""
    tendons: Annotated[dict[Name, Tendon], Field(max_length=100)] = {}
    """Cords through points of links, which only pull; they act in every load case."""
    stops: Annotated[dict[Name, Stop], Field(max_length=100)] = {}
    """Stops in joints: an angle or a travel beyond which the two links cannot go."""
    materials: dict[Name, Material] = {}
    """Material cards of the case's own; the library's are there by name without being listed."""
    parts: dict[Name, Part] = {}
    """Shape and material by name; links name their part."""
    joint_model: Literal["pinned", "bonded"] = "pinned"
    """Whether pins turn freely, or are all bonded and carry moments about their own axis as well, as if every revolute
    joint stated bonded = true. Sliders and pins in slots slide all the same."""
    layer_spacing: Annotated[Length, NOT_NEGATIVE] | None = None
    """Distance between the mid-planes of neighbouring layers in which links lie; 0 mm puts all layers in one plane."""
    washer: Annotated[Length, NOT_NEGATIVE] | None = None
    """Thickness of the washers, or width of the gaps, between layers that are as thick as their links."""
    large_displacement: Literal["auto", "off"] = "auto"
    """auto: where the linkage moves by more than 5 % of its span, or may give way below ten times its load,
    equilibrium is sought on the deformed shape. off: never."""
    conditions: Conditions = Conditions()
    """How long loads stay, and how warm it is."""
    ways_to_hold: WaysToHold | None = None
    """A point whose displacement is told for every link that the drive might hold, with free and with bonded pins."""
    carried: tuple[Carried, ...] = ()
    """Masses that links carry besides their parts; they weigh where the parts weigh, and have inertia."""
    wings: Annotated[tuple[Wing, ...], Field(max_length=100)] = ()
    """Plates that links carry through the air, which acts on them in load cases with ``flapping``."""
    massless: tuple[Name, ...] = ()
    """Moving links without part or carried mass that are to weigh nothing where others weigh or move."""
    load_cases: Annotated[dict[Name, LoadCase], Field(min_length=1, max_length=1000)] = {}
    """Loads that act together, by name; each load case is checked by itself. Needed unless a level states tests, which
    are load cases then."""
    level: LevelSpec | None = None
    """Tests of a level of a standard, which ``alula check`` goes over one after the other."""
    checks: dict[Name, Check] = {}
    """What is to be decided, by name; the safety factor of every link where nothing is stated."""
    hand_calculations: dict[Name, CantileverCalculation] = {}
    """Further hand calculations, by name, which are told and decide nothing."""
    solid: SolidSettings = SolidSettings()
    """How links are meshed as solids."""
    tolerances: TolerancesTable = {}
    """How far entries of the case may be off, by their path, such as "links.AE.points.E" = "0.2 mm"; pins stands for
    every place of a pin in every link. A size of a part is one draw for all its links. For alula tolerance alone; no
    check counts them."""

    def model_post_init(self, context: object) -> None:
        """Let load cases that say nothing of it move at the speed of the motion, and what links carry weigh.

        Parameters
        ----------
        context : object
            Of the validation; it holds the cycle that the case was made from, where it has one.
        """
        super().model_post_init(context)
        cycle = context.get("cycle") if isinstance(context, dict) else None
        if isinstance(cycle, Cycle):
            self.__dict__["pose"] = self.pose.entered_at(cycle.entered if self.pose.coordinate is not None else None)
            if self.motion is not None:
                self.__dict__["motion"] = self.motion.through(cycle.states)
            self.__dict__["load_cases"] = {x: one.over(cycle.rows.get(x, ())) for x, one in self.load_cases.items()}
        self.__dict__["load_cases"] = {name: self._filled(one) for name, one in self.load_cases.items()}

    def _filled(self, load_case: LoadCase) -> LoadCase:
        """Return a load case with what it leaves to the motion and to the masses that links carry."""
        stated, found = load_case.model_fields_set, dict[str, object]()
        if "speed" not in stated and self.motion is not None and self.inert and self.turns_steadily:
            found["speed"] = self.motion.velocity
        if "own_weight" not in stated and "gravity_direction" in stated and self.carried and load_case.carried:
            found["own_weight"] = True
        return load_case.model_copy(update=found) if found else load_case

    @property
    def tests_alone(self) -> bool:
        """True where all load cases are those of tests of the level."""
        return self.level is not None and (self.level.test is not None or "load_cases" not in self.model_fields_set)

    def repeated(self, load_case: str) -> tuple[tuple[float, ...], tuple[Block, ...]]:
        """Return what is left of a load case at the states of its cycles in a pose, and how these follow each other.

        Parameters
        ----------
        load_case : str
            Its name.

        Returns
        -------
        tuple of (tuple of float, tuple of Block)
            Shares of the load, and blocks of the states. Where it comes and goes the first share is the stress ratio R
            of what its loads make alone, the second 1. No shares of a state of a profile, which others follow.
        """
        stated = self.load_cases[load_case]
        if stated.blocks:
            return stated.shares, stated.blocks
        least = stated.least if stated.least is not None else -1.0 if self.conditions.reverses else 0.0
        return (least, 1.0), (Block((0, 1), 1.0),)

    @property
    def inert(self) -> bool:
        """True where the speed of the motion means inertia, in load cases that state none: unless the case says no."""
        motion, masses = self.motion, bool(self.checked_links or self.carried)
        if motion is None or not motion.moves or self.pose.equilibrium or not self.sweeps:
            return False
        return masses if motion.inertia is None else motion.inertia

    @property
    def turns_steadily(self) -> bool:
        """True where the motion is at a constant speed of the angle that fixes the pose, so that a pose moves at it."""
        motion, pose = self.motion, self.pose
        if motion is None or motion.states is not None or self.drive is None:
            return False
        if motion.rate[1] != 0.0 or motion.travel is not None:
            return False
        return pose.travel is None and pose.coordinate is not None and motion.coordinate in (None, pose.coordinate)

    @cached_property
    def linkage(self) -> Linkage:
        """The links and joints as one linkage; with joint_model = bonded, every revolute joint is."""
        joints, bond = self.joints, {"bonded": True}
        if self.joint_model == "bonded":
            joints = {n: j if j.slides else j.model_copy(update=bond) for n, j in joints.items()}
        moduli, pins = self._moduli
        return Linkage(self.links, joints, self.heights, moduli, pins)

    @property
    def _moduli(self) -> tuple[dict[str, float], dict[str, float]]:
        """Young's moduli of links with parts, and of joints' pins [MPa]; of known materials."""
        known = self.all_materials
        parts = {name: self.parts[link.part] for name, link in self.links.items() if link.part in self.parts}
        links = {name: known[part.material].youngs_modulus for name, part in parts.items() if part.material in known}
        pins = {name: joint.pin_material for name, joint in self.joints.items() if joint.pin_material in known}
        return links, {name: known[material].youngs_modulus for name, material in pins.items()}

    @cached_property
    def heights(self) -> dict[str, float]:
        """Link -> z of its mid-plane [mm]; 0 where no layers are stated."""
        return heights(self.links, self.parts, self.layer_spacing, self.washer)

    def in_one_plane(self) -> Self:
        """Return the case with all links in one plane, whatever their layers; plates of pairs stay as far apart."""
        links = {
            name: link.model_copy(update={"layer": None, "z": None, "apart": plates_apart(link, self.layer_spacing)})
            for name, link in self.links.items()
        }
        joints = {name: joint.model_copy(update={"tight_in": ()}) for name, joint in self.joints.items()}
        return self.model_copy(update={"links": links, "joints": joints, "layer_spacing": None, "washer": None})

    @property
    def layered(self) -> bool:
        """True where links lie at several heights."""
        return len(set(self.heights.values())) > 1

    @property
    def stacked(self) -> bool:
        """True where links state how they lie along the pins, in one layer too; a layer_spacing of 0 takes it back."""
        stated = any(link.layer is not None or link.z is not None for link in self.links.values())
        return self.layered or (stated and self.layer_spacing != 0.0)

    @cached_property
    def pinned_drive(self) -> Drive | None:
        """The drive as statics needs it."""
        drive = self.drive
        return Drive(link=drive.link, joint=drive.joint, stop=drive.stop, idle=drive.idle) if drive else None

    @property
    def body_weight(self) -> float | None:
        """What the unit ``body_weight`` stands for [N]; None where no body is stated."""
        return None if self.body_mass is None else self.body_mass * STANDARD_GRAVITY

    @property
    def sprung(self) -> bool:
        """True where springs, tendons or stops are stated."""
        return bool(self.springs or self.tendons or self.stops)

    @property
    def torque_transfer(self) -> Literal["eye-faces", "bore-shear"]:
        """How a torque enters a part: as the drive's does; pins of a deformed shape, and sliders, need no drive."""
        return "eye-faces" if self.drive is None else self.drive.transfer

    @cached_property
    def all_materials(self) -> dict[str, Material]:
        """The library's materials and the case's own, which win."""
        return library() | self.materials

    @property
    def checked_links(self) -> tuple[str, ...]:
        """The links that have a part, hence a stress."""
        return tuple(name for name, link in self.links.items() if link.part is not None)

    @property
    def bending_links(self) -> tuple[str, ...]:
        """The links that bend in frames: those with a part that move. A frame takes the ground for rigid."""
        return tuple(name for name in self.checked_links if name != self.linkage.ground)

    def material_of(self, link: str) -> Material:
        """Return the material of a link that has a part, as it is under the case's conditions.

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        Material
            Its card, with strength and modulus warm and after creep where conditions are stated; what the card does not
            tell at the stated temperature is as at room temperature.

        Raises
        ------
        CaseError
            Where the card lacks what a load that lasts needs.
        """
        return under(self._as_drawn(link), self.conditions)

    def fresh_material(self, link: str) -> Material:
        """Return the material of a link that has a part at the stated temperature, as loads begin: before it creeps.

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        Material
            Its card, with strength and modulus warm.
        """
        return at_temperature(self._as_drawn(link), self.conditions)

    def _as_drawn(self, link: str) -> Material:
        part = self.part_of(link)
        material = self.all_materials[part.material]
        if not part.section.round:
            return material
        return material.drawn(f"parts.{self.links[link].part}.outer_diameter", part.section.width)

    @property
    def all_checks(self) -> dict[str, Check]:
        """The stated checks, or the safety factor of every link where none is, and what is checked without being asked.

        That is whether loads may stay as long and come as often as they do, and whether links in layers touch. A test
        of a level asks for no more than it states.
        """
        checks = dict(self.checks)
        if not checks and (self.level is None or self.level.test is None):
            checks["safety factor"] = SafetyFactorCheck(type="safety-factor")
        if self.conditions.duration is not None and not any(isinstance(c, SustainedCheck) for c in checks.values()):
            checks["sustained load"] = SustainedCheck(type="sustained")
        if self.conditions.cycles is not None and not any(isinstance(c, FatigueCheck) for c in checks.values()):
            checks["fatigue"] = FatigueCheck(type="fatigue")
        if self.stacked and self.checked_links and not any(isinstance(c, ClearanceCheck) for c in checks.values()):
            checks["clearance"] = ClearanceCheck(type="clearance")
        return checks

    def displaced_point(self, name: str, check: DisplacementCheck) -> tuple[str, str]:
        """Find the point that a check of displacement is about.

        Parameters
        ----------
        name : str
            Name of the check, for messages.
        check : DisplacementCheck
            A check that names a point.

        Returns
        -------
        tuple of str
            Link and point.

        Raises
        ------
        CaseError
            Where there is no such point, or more than one.
        """
        point = check.at or ""
        if check.link is not None:
            check_point(self.linkage, f"checks.{name}", check.link, point)
            return check.link, point
        owners = [link for link in self.linkage.moving if point in self.links[link].points]
        if not owners:
            every = dict.fromkeys(p for link in self.linkage.moving for p in self.links[link].points)
            raise CaseError(f"checks.{name}.at: no moving link has a point '{point}'; choose one of {', '.join(every)}")
        pinned = {
            link
            for joint, record in self.joints.items()
            if not record.slides and set(self.linkage.joint_points(joint)) == {point}
            for link in record.links
        }
        if len(owners) > 1 and not set(owners) <= pinned:
            raise CaseError(
                f"checks.{name}.at: links {', '.join(owners)} have a point '{point}' each, which no pin joins; "
                "state link as well"
            )
        return owners[0], point

    def pin_material(self, joint: str) -> Material:
        """Return the material of a joint's pin at the stated temperature; pins do not creep.

        Parameters
        ----------
        joint : str
            Name of the joint.

        Returns
        -------
        Material
            Its card, with the strength of a wire of that diameter where the card has one, warm.
        """
        record = self.joints[joint]
        material = self.all_materials[record.pin_material]
        if record.pin_diameter is not None:
            material = material.drawn(f"joints.{joint}.pin_diameter", record.pin_diameter)
        return at_temperature(material, self.conditions)

    @property
    def pinned_joints(self) -> tuple[str, ...]:
        """The revolute joints whose pin sits in a link with a part; a clamped joint has none."""
        return tuple(
            name
            for name, joint in self.joints.items()
            if not joint.slides and not joint.clamped and set(joint.links) & set(self.checked_links)
        )

    @property
    def bearing_joints(self) -> tuple[str, ...]:
        """The joints whose pin bears on a part: those of ``pinned_joints``, and pins in slots of links with a part."""
        return (*self.pinned_joints, *self.slotted_joints)

    @property
    def slotted_joints(self) -> tuple[str, ...]:
        """The joints whose pin slides in the slot of a link with a part."""
        return tuple(name for name, joint in self.joints.items() if joint.slotted in self.checked_links)

    def part_of(self, link: str) -> PartKind:
        """Return the part of a link.

        Parameters
        ----------
        link : str
            Name of the link.

        Returns
        -------
        PartKind
            Its part; an imported one as it lies in the link.

        Raises
        ------
        CaseError
            Where it has none.
        """
        part = self._stated_part(link)
        return self.body(link).part if isinstance(part, FilePart) else part

    @cached_property
    def _imported(self) -> dict[str, Body]:
        """Bodies of imported parts, each placed once since that reads its file."""
        return {}

    def _stated_part(self, link: str) -> Part:
        name = self.links[link].part
        if name is None:
            raise CaseError(f"links.{link}.part: this link has no part; name one")
        return self.parts[name]

    def body(self, link: str) -> Body:
        """Put together everything that shapes a link: part, pins, plain ends, holes.

        Holes for pins are as wide as the case lets them be, so that the walls about them are the weakest: the link in
        its least material condition (ISO 2692). Those of an imported part are as its file has them.

        Parameters
        ----------
        link : str
            Name of a link with a part.

        Returns
        -------
        Body
            The link's body in the link's frame [mm].

        Raises
        ------
        CaseError
            Where a pin has no diameter, a plain end does not lie on the axis, or a slot or arm does not fit its joints.
        """
        record, part = self.links[link], self._stated_part(link)
        pinned: dict[str, str] = {}
        for joint in self.linkage.joints_of(link):
            first = pinned.setdefault(self.linkage.point_of(joint, link), joint)
            if self.joints[first].pin_diameter != self.joints[joint].pin_diameter:
                raise CaseError(
                    f"joints.{joint}.pin_diameter: it differs from that of joint '{first}', but both pins sit in one "
                    f"hole of link '{link}'; give both the same diameter"
                )
        pins, ends, feet = [], [], self.bare_feet(link)
        for name, (x, y) in record.points.items():
            clamp = self.joints[pinned[name]].clamp_length if name in pinned else None
            if name in pinned and clamp is None:
                diameter = self.joints[pinned[name]].pin_diameter
                if diameter is None:
                    raise CaseError(
                        f"joints.{pinned[name]}.pin_diameter: link '{link}' has a part, so this pin needs a diameter; "
                        'state it, for example "1.5 mm"'
                    )
                pins.append(_pin(self, link, name, diameter))
            elif name in feet:
                continue
            elif isinstance(part, FilePart) or part.patches_anywhere:
                ends.append(PlainEnd(name=name, x=x, patch=clamp or record.end_patch, y=y, clamped=clamp is not None))
            elif abs(y) > 1e-9 * self.linkage.longest:
                raise CaseError(
                    f"links.{link}.points.{name}: a {'clamped end' if clamp else 'load point without pin'} must lie on "
                    f"the link's axis (y = 0), but y is {y:g} mm; move it onto the axis"
                    f"{'' if clamp else ' or make it a joint'}"
                )
            else:
                ends.append(PlainEnd(name=name, x=x, patch=clamp or record.end_patch, clamped=clamp is not None))
        if isinstance(part, FilePart):
            wanted = tuple(
                Wanted(
                    name=pin.name,
                    place=(pin.x, pin.y),
                    diameter=pin.pin_diameter,
                    slot=pin.span if pin.slot > 0.0 else None,
                    clearance=pin.clearance if pin.slot > 0.0 else 0.0,
                )
                for pin in pins
            )
            if link not in self._imported:
                others = tuple((end.name, (end.x, end.y)) for end in ends)
                placed = placed_body(part, wanted, others)
                bores, faces = {pin.name for pin in placed.pins}, faces_of(part, placed)
                outside = tuple(replace(end, face=faces.get(end.name)) for end in ends if end.name not in bores)
                self._imported[link] = replace(placed, ends=outside, holes=record.holes)
            return self._imported[link]
        return Body(part=part, pins=tuple(pins), ends=tuple(ends), holes=record.holes)

    def body_to_make(self, link: str) -> Body:
        """Put together the body of a link as it is to be made: each hole in the middle of what the case states of it.

        Parameters
        ----------
        link : str
            Name of a link with a part.

        Returns
        -------
        Body
            As ``body``, but for the widths of holes. Of a clearance that two holes share each has half.
        """
        return self._with_holes(link, 1)

    def narrowest_body(self, link: str) -> Body:
        """Put together the body of a link whose holes are as narrow as the case allows; ``body`` has the widest.

        Parameters
        ----------
        link : str
            Name of a link with a part.

        Returns
        -------
        Body
            As ``body``, but for the widths of holes.
        """
        return self._with_holes(link, 0)

    def _with_holes(self, link: str, end: int) -> Body:
        """Return a body with holes at their least (0), in the middle (1) or at their most (2); a file keeps its own."""
        body = self.body(link)
        if isinstance(self._stated_part(link), FilePart):
            return body
        pins = [(pin, pin.clearance if pin.slot else self.linkage.wider(link, pin.name)[end]) for pin in body.pins]
        return replace(
            body, pins=tuple(replace(p, diameter=p.pin_diameter + wider, clearance=wider) for p, wider in pins)
        )

    def face(self, link: str, point: str) -> FlatFace | None:
        """Return the flat face of an imported part that a point of its link stands for.

        Parameters
        ----------
        link, point : str
            Their names.

        Returns
        -------
        FlatFace or None
            In the link's frame; None for any other point.
        """
        part = self.parts.get(self.links[link].part or "")
        named = isinstance(part, FilePart) and point in part.faces
        return next((end.face for end in self.body(link).ends if end.name == point), None) if named else None

    def bare_feet(self, link: str) -> set[str]:
        """Return the points without a joint at which arms of a link start, as those of tubes do.

        Parameters
        ----------
        link : str
            Name of a link.

        Returns
        -------
        set of str
            Names of points; no load enters there.
        """
        joints = {self.linkage.point_of(joint, link) for joint in self.linkage.joints_of(link)}
        return set(self.links[link].arms.values()) - joints

    @property
    def pose_coordinate(self) -> Coordinate | None:
        """The link whose direction, or slider whose travel, fixes the stated pose; None where nothing moves."""
        name, travel = self.pose.coordinate, self.pose.travel
        return None if name is None else Coordinate(name, Measure.ANGLE if travel is None else Measure.TRAVEL)

    @property
    def motion_coordinate(self) -> Coordinate:
        """The link whose direction, or slider whose travel, the motion prescribes.

        Raises ``CaseError`` where the case has no motion.
        """
        name = None if self.motion is None else self.motion.coordinate or self.pose.coordinate
        if self.motion is None or name is None:
            tests = "" if self.level is None else "; tests of its level stand in the pose: alula check goes over them"
            raise CaseError(
                f"motion: the case states no motion; add [motion] with a coordinate and a range or turn = true{tests}"
            )
        return Coordinate(name, Measure.ANGLE if self.motion.travel is None else Measure.TRAVEL)

    @property
    def sweeps(self) -> bool:
        """True where the case states a motion in which its linkage does not stand still, as under a cycle of loads."""
        states = None if self.motion is None else self.motion.states
        return self.motion is not None and (states is None or bool(np.ptp(states.values) > 0.0))

    @property
    def moves(self) -> bool:
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
        """Return lift and drag of every air load of a load case.

        Parameters
        ----------
        load_case : str
            Name of the load case.

        Returns
        -------
        tuple of AirForces
            In the order of the case file.
        """
        return tuple(
            air_forces(air, f"load_cases.{load_case}.air.{i}") for i, air in enumerate(self.load_cases[load_case].air)
        )

    @cached_property
    def stated_pose(self) -> Pose:
        """The linkage assembled in the stated pose."""
        stated, entered = self.pose, self.pose.entered
        angle, travel = stated.angle, stated.travel
        if entered is not None:
            angle, travel = (entered, None) if travel is None else (angle, entered)
        pose = solve_pose(self.linkage, coordinate=stated.coordinate, angle=angle, near=stated.near, travel=travel)
        if entered is None:
            return pose
        return solve_motion(pose, [stated.angle if stated.travel is None else stated.travel]).pose(0)

    def solve_pose(self) -> Pose:
        """Return the linkage assembled in the stated pose.

        Returns
        -------
        Pose

        Raises
        ------
        CaseError
            Where it cannot be assembled.
        """
        return self.stated_pose


def _pin(case: CoreCase, link: str, name: str, diameter: float) -> Pin:
    """Return the hole or slot at a point of a link for a pin of that diameter."""
    record = case.links[link]
    (x, y), slot = record.points[name], record.slots.get(name)
    if slot is not None:
        middle, length = (slot.first + slot.last) / 2.0, slot.last - slot.first
        width = diameter + slot.wider
        pin = Pin(name=name, x=middle, y=y, diameter=width, slot=length, clearance=slot.wider)
    else:
        foot, (*_, wider) = record.arms.get(name), case.linkage.wider(link, name)
        pin = Pin(
            name=name,
            x=x,
            y=y,
            diameter=diameter + wider,
            clearance=wider,
            foot=None if foot is None else record.points[foot],
        )
    return with_eye(case.linkage, case.parts, case.body, link, pin)
