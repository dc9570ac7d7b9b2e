"""Sentences on motions: envelopes, fatigue, natural frequencies, motors."""

import math

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason
from alula.reports.sentences.catalogue import Sentence, told
from alula.reports.words.numbers import ordinal, short


def _held(*, ways: tuple[Reason, ...], free: int) -> str:
    told_ways = " and ".join(map(told, ways))
    if not told_ways:
        return "free" if free else ""
    left = "a rigid motion" if free == 1 else f"{free} rigid motions"
    return f"{told_ways}, {left} of it left free" if free else told_ways


def directions(in_plane: float) -> str:
    """Say in which directions a shape moves.

    Parameters
    ----------
    in_plane : float
        Share of its kinetic energy in the plane of the linkage.

    Returns
    -------
    str
    """
    if in_plane > 0.9:
        return "in the plane"
    if in_plane < 0.1:
        return "out of the plane"
    return "mostly in the plane" if in_plane >= 0.5 else "mostly out of the plane"


def _banded(value: Band) -> str:
    """Return ``43.2 (38.0 to 47.0)``, without powers of ten."""
    if math.isinf(value.high):
        return f"{_three(value.value)} (no band)" if math.isfinite(value.value) else "unknown"
    shown, low, high = (_three(end) for end in (value.value, value.low, value.high))
    return shown if low == high else f"{shown} ({low} to {high})"


def _three(value: float) -> str:
    """Return a number with three digits, and without a power of ten."""
    return f"{value:#.3g}".rstrip(".") if value < 999.5 else _stated(value)


def _stated(value: float) -> str:
    """Return a stated number with three digits, without padding zeros."""
    return f"{float(f'{value:.3g}'):g}"


def _lowest(*, frequency: Band, at: Reason, in_plane: float) -> str:
    return f"the lowest natural frequency is {_banded(frequency)} Hz {told(at)}, {directions(in_plane)}"


def _lowest_frequency(*, frequency: Band, at: Reason, in_plane: float, link: str, driving: float) -> str:
    most = f", where {link} moves most" if link else ""
    ratio = ""
    if driving > 0.0:
        over = _banded(frequency.times(1.0 / driving))
        ratio = f"; over the driving frequency of {_stated(driving)} Hz that is {over}"
    return f"{_lowest(frequency=frequency, at=at, in_plane=in_plane)}{most}{ratio}"


def _lowest_frequency_departs(*, frequency: Band, at: Reason, in_plane: float, **_: object) -> str:
    lowest = _lowest(frequency=frequency, at=at, in_plane=in_plane)
    return f"{lowest}: under its loads the linkage does not swing but departs"


def _hinges(joints: tuple[str, ...]) -> str:
    if not joints:
        return ""
    return (
        f"; the low end has hinges in holes at {', '.join(joints)}, where pins may run: nothing states that they are "
        "tight in both links (tight_in, or bonded)"
    )


def _frequency_of_linkage(*, lowest: Reason, harmonic: Reason, hinged: tuple[str, ...]) -> str:
    return f"{told(lowest)}; {told(harmonic)}{_hinges(hinged)}"


def _frequency_of_link(
    *, link: str, held: Reason, frequency: Band, in_plane: float, driving: float, hinged: tuple[str, ...]
) -> str:
    own = f"{link} vibrates at {_banded(frequency)} Hz, {directions(in_plane)}"
    return f"by itself, {told(held)}, {own}; the drive turns at {_stated(driving)} Hz{_hinges(hinged)}"


def _harmonics_may_meet(*, last: int, frequency: float, mode: int) -> str:
    up_to = f"harmonics up to the {ordinal(last)}, {_stated(frequency)} Hz, may meet"
    return f"{up_to} the {ordinal(mode)} natural frequency, since its band goes down to 0"


def _harmonic_meets(*, harmonic: int, frequency: float, mode: int, at: Reason, elsewhere: bool) -> str:
    met = f"the {ordinal(harmonic)} harmonic, {_stated(frequency)} Hz, meets the {ordinal(mode)} natural frequency"
    return f"{met} {told(at)}{' and elsewhere' if elsewhere else ''}"


def _harmonic_in_pose(*, harmonic: int, rpm: float, ratio: float, frequency: Band) -> str:
    return (
        f"in this pose the {ordinal(harmonic)} harmonic of {short(rpm, 4)} rpm is at {short(ratio, 3)} of the lowest "
        f"natural frequency, {_banded(frequency)} Hz"
    )


def _all_harmonics_below(*, highest: int, frequency: float) -> str:
    return f"all harmonics up to the {ordinal(highest)}, {_stated(frequency)} Hz, stay below it"


def _nearest_harmonic(*, highest: int, harmonic: int, frequency: float, mode: int, at: Reason) -> str:
    return (
        f"no harmonic up to the {ordinal(highest)} meets a natural frequency; the {ordinal(harmonic)}, "
        f"{_stated(frequency)} Hz, comes nearest to the {ordinal(mode)} one {told(at)}"
    )


def _power_of_drive(*, asked: tuple[Reason, ...], side: Reason, output: Reason, drives: Reason | None) -> str:
    return f"{''.join(map(told, asked))}; {told(side)}, {told(output)}{'' if drives is None else told(drives)}"


SENTENCES: dict[str, Sentence] = {
    # How joints hold a link by itself
    "held": _held,
    "built_in": "built in at {at:and}",
    "on_rigid_pins": "on rigid pins at {at:and}",
    "in_guide": "in the guide at {at:and}",
    "on_tilting_pins": "on pins that tilt at {at:and}",
    "across_slot": "held across the slot at {at:and}",
    "drive_joint": "the drive's joint {joint}",
    # Natural frequencies
    "lowest_frequency": _lowest_frequency,
    "lowest_frequency_departs": _lowest_frequency_departs,
    "frequency_of_linkage": _frequency_of_linkage,
    "frequency_of_link": _frequency_of_link,
    "harmonics_may_meet": _harmonics_may_meet,
    "harmonic_meets": _harmonic_meets,
    "harmonic_in_pose": _harmonic_in_pose,
    "harmonics_not_known": ("which harmonics meet a natural frequency is not known, since the lowest one has no band"),
    "all_harmonics_below": _all_harmonics_below,
    "nearest_harmonic": _nearest_harmonic,
    "in_stated_pose": "in the stated pose",
    "in_every_pose": "in every pose",
    "at_value": "at {coordinate} = {value:fixed1} {unit}",
    "from_value_to_value": "from {coordinate} = {first:fixed0} to {last:fixed0} {unit}",
    "frame_takes_ground_for_rigid": (
        "the frame takes the ground for rigid, so that beams do not tell its frequencies; its solid does"
    ),
    "at_rims_or_along_beams": "at the rims of eyes or along the beams",
    "estimated_on_mesh_of_file": "estimated on the mesh of the file, fourfold",
    "on_two_meshes": "meshes of {elements[0]:,} and {elements[1]:,} elements",
    "pins_taken_to_be_tight": (
        "pins between layers are taken to be tight in both of their links; low ends of bands have hinges in the holes "
        "in which pins may run"
    ),
    "tight_or_hinged": "pins tight in both links, or hinges in holes in which they may run",
    "pose_is_unstable": (
        "the pose is unstable under its loads: what moves it off grows by the factor e every {time:short3} s"
    ),
    "poses_left_out": "{count} poses were left out, in which there is no equilibrium",
    # Motors
    "from_mean_to_peak": "from the mean over the motion to the peak",
    "speed_of_drive": (
        "the drive turns at up to {fastest:short4} rpm, the motor without load at {without_load:short4} rpm"
    ),
    "share_of_torque": (
        "the drive needs at most {most:short3} of the motor's torque at that speed, on average {mean:short3} of its "
        "power; stall torque {stall:short3} N·mm, falling linearly to zero at {without_load:short4} rpm"
    ),
    "torque_of_drive": (
        "the drive torque is {effective:short3} N·mm (root mean square), with an ideal flywheel {mean:short3} N·mm; "
        "the rated torque is {rated:short3} N·mm"
    ),
    "asked_of_drive": ("the drive needs at most {torque:short3} N·mm and {power:short3} W, on average {mean:short3} W"),
    "asked_over_range_of_air": (
        " (C_N from {coefficients[0]:plain} to {coefficients[1]:plain}: at most {torque[0]:short3} to "
        "{torque[1]:short3} N·mm and {power[0]:short3} to {power[1]:short3} W, on average {mean[0]:short3} to "
        "{mean[1]:short3} W)"
    ),
    "asked_without_air": (
        "; without air at most {torque:short3} N·mm and {power:short3} W, on average {mean:short3} W"
    ),
    "power_of_drive": _power_of_drive,
    "output_of_motor": "{volt:plain} V × {milliampere:plain} mA × {efficiency:plain} = {watt:short3} W",
    "covers_peak": "the motor's output covers the peak",
    "below_mean": "the motor's output is below the mean",
    "covers_mean": "the motor's output covers the mean but not the peak, so a flywheel decides",
    "carries_air": "the motor carries the air as well, for its output covers the peak",
    "below_mean_without_air": "the motor's output is below the mean even without air",
    "below_mean_with_air": "the motor's output is below the mean with the air, which it does not carry",
    "covers_mean_with_air": ("the motor's output covers the mean with the air but not the peak, so a flywheel decides"),
    "depends_on_air": (
        "whether the motor carries the air depends on C_N, for its output covers the mean with the least alone"
    ),
    "can_drive": "; it can drive {mass:short3} g of carried mass (now {now:short3} g)",
}
