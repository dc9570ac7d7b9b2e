"""The quantities that claims can name, computed when first asked for.

A tree of mappings; its leaves are values with their dimensions, or words. Roots of a case:

    pose.mobility, pose.angles.LINK (0 to 360°), pose.points.POINT.x|y
    statics.LOADCASE.joints.JOINT.fx|fy|magnitude (what the joint's first link does to its second)
    statics.LOADCASE.drive_torque
    audit.reactions.COLUMN (the published system as its formulas give it), audit.printed.COLUMN (as rounded),
    audit.exact.ROW.COLUMN (coefficients), audit.rows.ROW.equilibrium ("yes"|"no")|defect
    beam.LOADCASE, solid.LOADCASE: largest_stress, least_safety_factor, most_stressed_link, most_stressed_joint,
    links.LINK.von_mises|principal|safety_factor|displacement|moment,
    held.WAY (how far the case's point moves with the linkage held in that way)
    hand.NAME.moment|stress|safety_factor
    material.LINK.yield|ultimate|modulus|density|allowable, section.LINK.second_moment|area
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from alula.fea.check.run import check_case, effort_of, hand_calculations, links_by_hand
from alula.fea.common.reason import reason
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.result import CheckResult, LinkResult, SolidResult
from alula.fea.standing.case_statics import CaseStatics, solve_case_statics
from alula.fea.standing.joint_forces import WayToHold, ways_to_hold
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.geometry.mechanisms.flapping import FlappingWing
from alula.geometry.mechanisms.fourbar import FourBar
from alula.geometry.mechanisms.grashof import Grashof
from alula.geometry.mechanisms.ornithopter import OrnithopterDimensions
from alula.geometry.mechanisms.synthesis import Synthesis, synthesise
from alula.geometry.mechanisms.wing_drive import WingDrive
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case, read_companion
from alula.loads.sources.claim import (
    CaseSystem,
    FlappingSystem,
    OrnithopterSystem,
    SynthesisSystem,
    System,
)
from alula.loads.sources.expression import Path
from alula.loads.sources.published_statics import read_matrix
from alula.loads.sources.quantity import Value
from alula.loads.text.explain import printable


class Tree(Mapping[str, Any]):
    """Named branches, each computed once, when it is first looked at (not when its name is asked for)."""

    def __init__(self, **branches: Callable[[], Any]) -> None:
        self._branches = branches
        self._known: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._known:
            self._known[name] = self._branches[name]()
        return self._known[name]

    def __contains__(self, name: object) -> bool:
        return name in self._branches

    def __iter__(self) -> Iterator[str]:
        return iter(self._branches)

    def __len__(self) -> int:
        return len(self._branches)


def look_up(tree: Mapping[str, Any], path: Path) -> Value | str:
    """Return the leaf at a path.

    Parameters
    ----------
    tree : dict of str to Any
        Quantities by name.
    path : Path
        Names from the root to the leaf.

    Returns
    -------
    Value or str
        The leaf.

    Raises
    ------
    CaseError
        Naming what there is instead.
    """
    here: Any = tree
    for i, name in enumerate(path):
        if not isinstance(here, Mapping) or name not in here:
            above = ".".join(path[:i]) or "the claims' quantities"
            choice = f"choose one of {', '.join(here)}" if isinstance(here, Mapping) else "it holds nothing further"
            raise CaseError(f"path '{printable('.'.join(path))}': {above} has no '{printable(name)}'; {choice}")
        here = here[name]
    if isinstance(here, Mapping):
        raise CaseError(f"path '{printable('.'.join(path))}': it is no quantity; go on with one of {', '.join(here)}")
    if isinstance(here, Value | str):
        return here
    raise AssertionError(f"the leaf at {path} is neither value nor word")


def _leaves(record: object, units: Mapping[str, str]) -> dict[str, Value]:
    """Give fields of a record their units."""
    return {name: Value.of(float(getattr(record, name)), unit) for name, unit in units.items()}


def _yes(fact: bool) -> str:
    return "yes" if fact else "no"


def case_tree(
    case: Case, name: str, *, fidelity: str = "solid", threads: int = 2, known: CheckResult | None = None
) -> Tree:
    """Return the quantities of a case.

    Parameters
    ----------
    case : Case
        The case. The sources calculate in one plane, so its layers are left out.
    name : str
        Its path or built-in name.
    fidelity : str, optional
        "solid" or "beam", which leaves out the branch ``solid``.
    threads : int, optional
        Upper bound on the threads of a solver.
    known : CheckResult, optional
        A check; if it is of this case, or of the same in layers, its frames are not solved again.

    Returns
    -------
    Tree
        Its quantities, each computed when it is first asked for.
    """
    case = case.in_one_plane() if case.layered else case
    frames = _frames(case, known)
    parts = Tree(
        statics=lambda: solve_case_statics(case, name),
        solid=lambda: check_case(
            case, name=name, fidelity="solid", threads=threads, effort=replace(effort_of(case), stated=True)
        ),
    )
    branches: dict[str, Callable[[], Any]] = {
        "pose": lambda: _pose(parts["statics"]),
        "statics": lambda: _statics(parts["statics"]),
        "beam": lambda: _by_hand(parts["statics"], frames),
        "hand": lambda: {
            key: _leaves(hand, {"moment": "N*mm", "stress": "MPa", "safety_factor": ""})
            for key, hand in hand_calculations(case).items()
        },
        "material": lambda: {link: _material(case, link) for link in case.checked_links},
        "section": lambda: {
            link: {
                "second_moment": Value.of(case.part_of(link).section.i_z, "mm^4"),
                "area": Value.of(case.part_of(link).section.area, "mm^2"),
            }
            for link in case.checked_links
        },
    }
    if case.published_statics is not None:
        branches["audit"] = lambda: _audit(parts["statics"], name)
    if fidelity == "solid":
        branches["solid"] = lambda: _check(parts["solid"])
    return Tree(**branches)


def _frames(case: Case, known: CheckResult | None) -> Mapping[str, LargeDisplacement] | None:
    """Return what is known already of a case's frames.

    Of links in layers it is known at least whether their numbers are those of the undeformed pose, as the sources' are:
    no frame is solved in one plane then.
    """
    if known is None or known.case == case:
        return None if known is None else known.frames
    undeformed = all(one.state != "deformed" for one in known.frames.values())
    if not (known.case.layered and undeformed and known.case.in_one_plane() == case):
        return None
    return {
        name: LargeDisplacement(state="unknown", span=one.span, points={}, links={}, reason=reason("frame_not_solved"))
        for name, one in known.frames.items()
    }


def _pose(statics: CaseStatics) -> Mapping[str, Any]:
    pose = statics.pose
    return {
        "mobility": Value.of(pose.linkage.mobility),
        "angles": {link: Value.of(math.degrees(angle) % 360.0, "deg") for link, angle in pose.angles.items()},
        "points": {
            name: {"x": Value.of(float(at[0]), "mm"), "y": Value.of(float(at[1]), "mm")}
            for name, at in pose.points.items()
        },
    }


def _statics(statics: CaseStatics) -> Mapping[str, Any]:
    return {
        title: {
            "joints": {
                name: {
                    "fx": Value.of(float(joint.force[0]), "N"),
                    "fy": Value.of(float(joint.force[1]), "N"),
                    "magnitude": Value.of(joint.magnitude, "N"),
                }
                for name, joint in reactions.joints.items()
            },
            "drive_torque": Value.of(reactions.drive_torque, "N*mm"),
        }
        for title, reactions in statics.reactions.items()
    }


def _audit(statics: CaseStatics, name: str) -> Mapping[str, Any]:
    audit, published = statics.audit, statics.case.published_statics
    assert audit is not None
    assert published is not None
    columns, exact = read_matrix(read_companion(name, published.exact))
    units = ["N*m" if column == "T" else "N" for column in columns]
    return {
        "reactions": {c: Value.of(float(x), u) for c, x, u in zip(columns, audit.exact, units, strict=True)},
        "printed": {c: Value.of(float(x), u) for c, x, u in zip(columns, audit.printed, units, strict=True)},
        "exact": {
            str(i): {c: Value.of(float(x)) for c, x in zip(columns, row, strict=True)} for i, row in enumerate(exact, 1)
        },
        "rows": {
            str(row.number): {"equilibrium": _yes(row.valid), "defect": Value.of(row.defect)} for row in audit.rows
        },
    }


def _check(result: CheckResult) -> Mapping[str, Any]:
    for load_case in result.load_cases.values():
        for name, link in load_case.links.items():
            if isinstance(link, SolidResult) and link.discretisation.status != "converged":
                raise CannotRunError(
                    f"no claim on stress can be judged, since that of {name} has not converged: "
                    f"its meshes are {link.discretisation.status}"
                )
    return {title: _links(result.case, one.links, one.ways_to_hold) for title, one in result.load_cases.items()}


def _by_hand(statics: CaseStatics, frames: Mapping[str, LargeDisplacement] | None) -> Mapping[str, Any]:
    case, found = statics.case, links_by_hand(statics, frames)
    ways = {title: ways_to_hold(case, statics.pose, loads) for title, loads in statics.loads.items()}
    return {title: _links(case, links, ways[title]) for title, links in found.items()}


def _links(case: Case, links: Mapping[str, LinkResult], ways: Sequence[WayToHold]) -> Mapping[str, Any]:
    worst = max(links.values(), key=_von_mises)
    points = case.links[worst.link].points
    near = min(points, key=lambda point: math.hypot(*(np.array(points[point]) - worst.location[:2])))
    return {
        "largest_stress": Value.of(_von_mises(worst), "MPa"),
        "least_safety_factor": Value.of(min(map(_safety_factor, links.values()))),
        "most_stressed_link": worst.link,
        "most_stressed_joint": near,
        "held": {held.name: Value.of(held.size, "mm") for held in ways},
        "links": {
            name: {
                "von_mises": Value.of(_von_mises(link), "MPa"),
                "principal": Value.of(link.principal_max.value, "MPa"),
                "displacement": Value.of(link.displacement_max.value, "mm"),
                "moment": Value.of(float(np.hypot(link.beam.m_y, link.beam.m_z).max()), "N*mm"),
            }
            | ({"safety_factor": Value.of(_safety_factor(link))} if math.isfinite(_safety_factor(link)) else {})
            for name, link in links.items()
        },
    }


def _by_beam(link: LinkResult) -> bool:
    return not isinstance(link, SolidResult) and not link.beam.without


def _von_mises(link: LinkResult) -> float:
    """Largest stress [MPa] of the solid, else by beam theory alone, as the hand calculations of sources are."""
    return float(link.beam.equivalent.max()) if _by_beam(link) else link.von_mises_max.value


def _safety_factor(link: LinkResult) -> float:
    return link.beam.safety_factor if _by_beam(link) else link.safety_factor.value


def _material(case: Case, link: str) -> Mapping[str, Any]:
    card = case.material_of(link)
    stated = {"yield": card.yield_strength, "ultimate": card.ultimate_strength, "modulus": card.youngs_modulus}
    return {name: Value.of(value, "MPa") for name, value in stated.items() if value is not None} | {
        "allowable": Value.of(card.allowable, "MPa"),
        "density": Value.of(card.density, "tonne/mm^3"),
    }


def system_tree(system: System, *, fidelity: str = "solid", threads: int = 2) -> Mapping[str, Any]:
    """Return the quantities of a system that a source describes.

    Parameters
    ----------
    system : System
        Record of the system in its source.
    fidelity : str, optional
        "solid" or "beam", which leaves out the branch ``solid``.
    threads : int, optional
        Upper bound on the threads of a solver.

    Returns
    -------
    dict of str to Any
        Its quantities by name.
    """
    if isinstance(system, CaseSystem):
        return case_tree(read_case(system.case), system.case, fidelity=fidelity, threads=threads)
    if isinstance(system, FlappingSystem):
        return flapping_tree(
            FlappingWing(
                crank=system.crank,
                coupler=system.coupler,
                rocker=system.rocker,
                width=system.width,
                height=system.height,
            )
        )
    if isinstance(system, OrnithopterSystem):
        return _ornithopter(system)
    if isinstance(system, SynthesisSystem):
        return _synthesis(synthesise(system.theta, system.psi, system.d))
    raise CaseError("a path cannot name a table of designs; name one of its rows")


def flapping_tree(wing: FlappingWing) -> Tree:
    """Return ground, Grashof, and the metrics by the source's definition (``published``) and by their names.

    Parameters
    ----------
    wing : FlappingWing
        The mechanism's dimensions.

    Returns
    -------
    Tree
        Its quantities by name.
    """
    rad = ("phase_lag", "oscillation", "asymmetry")
    return Tree(
        ground=lambda: Value.of(wing.ground, "mm"),
        grashof=lambda: _yes(wing.grashof.satisfied),
        collides=lambda: _yes(wing.rocker > wing.width),
        published=lambda: _leaves(wing.published_metrics(), dict.fromkeys(rad, "rad")),
        metrics=lambda: _leaves(wing.metrics(), dict.fromkeys((*rad, "mean_side_difference"), "rad")),
    )


def _ornithopter(system: OrnithopterSystem) -> Tree:
    lengths = [field.name for field in fields(OrnithopterDimensions)]

    def motion(drive: WingDrive) -> Mapping[str, Any]:
        units = (
            dict.fromkeys(("highest", "lowest", "stroke"), "rad")
            | dict.fromkeys(("fastest_up", "fastest_down"), "rad/s")
            | dict.fromkeys(("greatest_acceleration", "least_acceleration"), "rad/s^2")
            | dict.fromkeys(("pin_speed_up", "pin_speed_down"), "mm/s")
            | dict.fromkeys(("pin_acceleration_max", "pin_acceleration_min"), "mm/s^2")
        )
        return _leaves(drive.extremes(system.speed), units)

    return Tree(
        dimensions=lambda: _leaves(system.rules.dimensions(), dict.fromkeys(lengths, "mm")),
        motion=lambda: motion(system.rules.drive()),
    )


def _grashof(grashof: Grashof) -> Mapping[str, Any]:
    return {
        "shortest_plus_longest": Value.of(grashof.shortest_plus_longest, "mm"),
        "other_two": Value.of(grashof.other_two, "mm"),
        "satisfied": _yes(grashof.satisfied),
        "condition": "s + l <= p + q",
        "inversion": grashof.inversion,
    }


def _synthesis(found: Synthesis) -> Tree:
    bar: FourBar = found.four_bar
    locked = {drive: [lock for lock in found.lock_ups if lock.drive == drive] for drive in ("a", "b", "c")}
    return Tree(
        K1=lambda: Value.of(found.K[0]),
        K2=lambda: Value.of(found.K[1]),
        K3=lambda: Value.of(found.K[2]),
        a=lambda: Value.of(bar.a, "mm"),
        b=lambda: Value.of(bar.b, "mm"),
        c=lambda: Value.of(bar.c, "mm"),
        grashof=lambda: _grashof(bar.grashof),
        points=lambda: {
            str(i): {f"branch_driven_by_{drive}": branch or "dead point" for drive, branch in point.branches.items()}
            for i, point in enumerate(found.points, 1)
        },
        lock_up=lambda: {
            drive: {
                str(i): {
                    "theta": Value.of(lock.theta, "rad"),
                    "psi": Value.of(lock.psi, "rad"),
                }
                for i, lock in enumerate(locks, 1)
            }
            for drive, locks in locked.items()
        },
    )
