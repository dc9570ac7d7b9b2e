"""Every pose of a motion, for CSV files."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from alula.fea.findings.joint_paths import moving_points, owners
from alula.fea.findings.of_motion import MotionFindings
from alula.fea.findings.rates import QUANTITIES, Rates, Values
from alula.geometry.linkage.coordinate import Coordinate, Measure
from alula.geometry.linkage.motion import Motion
from alula.loads.states.case_motion import CaseMotion
from alula.reports.motion.play import drive_play, point_play
from alula.reports.sections.section import Section, Series
from alula.reports.sections.springs import motion_springs

Real = NDArray[np.float64]
ANGULAR = ("angular_speed", "angular_acceleration")
"""Quantities of a link whose columns have shorter names in ``links.csv``."""


def motion_series(found: MotionFindings, rates: Mapping[str, Rates], own: Rates | None) -> Section:
    """Return every pose, for ``links.csv``, ``points.csv``, ``torque.csv`` and more.

    Torques and joint forces have one load case below the other. So have rates, where load cases have a speed: speeds,
    accelerations, momentum and energy at the speed of each.

    Parameters
    ----------
    found : MotionFindings
    rates : mapping of str to Rates
        Load case -> at its speed; those with a speed.
    own : Rates or None
        Rates at the motion's own speed; None without one.

    Returns
    -------
    Section
        Of files alone.
    """
    result = found.moved
    motion = result.motion
    whole = {
        "links": _link_columns(result, own),
        "points": _point_columns(found),
        "springs": dict(motion_springs(result)),
    }
    below: dict[str, dict[str, Mapping[str, Real]]] = {
        "torque": {name: _torque_columns(found, name) for name in result.torque},
        "rates": {name: _rate_columns(one) for name, one in rates.items()},
        "joint-forces": {name: _force_columns(result, name) for name in result.forces},
    }
    files = [
        Series(file=f"{file}.csv", columns={**pose_columns(motion), **columns}, digits=12)
        for file, columns in whole.items()
        if columns
    ]
    files += [
        Series.below(
            f"{file}.csv", {name: {**pose_columns(result.moved[name]), **columns} for name, columns in cases.items()}
        )
        for file, cases in below.items()
        if cases
    ]
    return Section(key="files", series=tuple(files))


def pose_columns(motion: Motion) -> dict[str, Real]:
    """Return the first columns of every file: the share of the cycle, the coordinate, and the time.

    Parameters
    ----------
    motion : Motion

    Returns
    -------
    dict
        Title with unit -> values (n,).
    """
    columns = {} if motion.instants is None else {motion.progress_title: motion.progress}
    columns |= {f"{motion.coordinate} {motion.coordinate.measure.word} [{motion.unit}]": motion.told(motion.angles)}
    return columns if motion.times is None else columns | {"time [s]": motion.times}


def _link_columns(result: CaseMotion, own: Rates | None) -> dict[str, Real]:
    motion, columns = result.motion, dict[str, Real]()
    coordinate, per = motion.coordinate, "rad/mm" if motion.coordinate.slides else "1"
    for i, link in enumerate(motion.linkage.moving):
        if coordinate != Coordinate(link):
            columns[f"{link} angle [deg]"] = np.degrees(motion.angle(link))
        columns[f"{link} speed over speed of {coordinate} [{per}]"] = motion.first[:, i]
        if motion.times is not None:
            columns[f"{link} speed [rad/s]"] = motion.angular_speed(link)
            columns[f"{link} acceleration [rad/s^2]"] = motion.angular_acceleration(link)
    for joint in motion.closure.slots:
        if coordinate != Coordinate(joint, Measure.TRAVEL):
            columns[f"{joint} travel [mm]"] = motion.travel(joint)
    for link, values in {} if own is None else own.links.items():
        columns |= _named(link, {key: found for key, found in values.items() if key not in ANGULAR})
    return columns


def _rate_columns(found: Rates) -> dict[str, Real]:
    """Columns of all rates of a load case."""
    columns: dict[str, Real] = {}
    for of in (found.links, found.points, {"linkage": found.whole}):
        for name, values in of.items():
            columns |= _named(name, values)
    return columns


def _named(name: str, values: Mapping[str, Values]) -> dict[str, Real]:
    """Columns of some quantities of a link or point, two for a vector."""
    columns: dict[str, Real] = {}
    for key, found in values.items():
        unit, what = QUANTITIES[key].replace("·", " ").replace("²", "^2"), key.replace("_", " ")
        if np.iscomplexobj(found):
            columns |= {f"{name} {what} x [{unit}]": found.real, f"{name} {what} y [{unit}]": found.imag}
        else:
            columns[f"{name} {what} [{unit}]"] = found
    return columns


def _point_columns(found: MotionFindings) -> dict[str, Real]:
    motion, columns = found.moved.motion, dict[str, Real]()
    fields = [("", "mm", motion.position)]
    if motion.times is not None:
        fields += [("v", "mm/s", motion.velocity), ("a", "mm/s^2", motion.linear_acceleration)]
    for label in moving_points(motion):
        for prefix, unit, of in fields:
            values = of(*owners(motion, label)[0])
            columns[f"{label} {prefix}x [{unit}]"] = values[:, 0]
            columns[f"{label} {prefix}y [{unit}]"] = values[:, 1]
            if prefix:
                columns[f"{label} {prefix} [{unit}]"] = np.linalg.norm(values, axis=1)
        columns |= point_play(found, label)
    return columns


def _torque_columns(found: MotionFindings, load_case: str) -> dict[str, Real]:
    result = found.moved
    what, unit = result.effort.word, result.effort.unit
    columns = {f"{what} on {result.drive.link} [{unit.replace('·', ' ')}]": result.torque[load_case]}
    if result.rubbing:
        columns[f"{what} without friction [{unit.replace('·', ' ')}]"] = result.frictionless[load_case]
        columns["efficiency [1]"] = result.work(load_case).efficiency
    columns |= drive_play(found, load_case)
    if any(np.any(moved.speed) for moved in result.moved.values()):
        columns["drive power [N mm/s]"] = result.drive_power(load_case)
        columns["kinetic energy [N mm]"] = result.power[load_case].kinetic
        columns["potential energy [N mm]"] = result.power[load_case].potential
    return columns


def _force_columns(result: CaseMotion, load_case: str) -> dict[str, Real]:
    columns: dict[str, Real] = {}
    solved = result.forces[load_case]
    for name, force in solved.forces.items():
        first, second = result.case.joints[name].links
        columns[f"{name} Fx of {first} on {second} [N]"] = force[:, 0]
        columns[f"{name} Fy of {first} on {second} [N]"] = force[:, 1]
        columns[f"{name} size [N]"] = np.linalg.norm(force, axis=1)
        if name in solved.moments:
            columns[f"{name} M of {first} on {second} [N mm]"] = solved.moments[name]
    return columns
