"""Sentences on the linkage's frame: joint forces, the deformed shape, buckling, and what play makes of it."""

import math

from alula.fea.common.reason import Reason
from alula.reports.sentences.catalogue import Sentence, told
from alula.reports.words.numbers import plain, short


def _under_load_cases(load_cases: tuple[str, ...], why: Reason | str) -> str:
    return f"load case{'s' if len(load_cases) > 1 else ''} {', '.join(load_cases)}: {told(why)}"


def _joints_bonded(bonded: tuple[str, ...], clamped: tuple[str, ...]) -> str:
    said = []
    for names, how in ((bonded, "bonded"), (clamped, "clamped")):
        if names:
            said.append(f"joint {names[0]} is {how}" if len(names) == 1 else f"joints {', '.join(names)} are {how}")
    return " and ".join(said)


def _compressed_column(compression: float, where: Reason | None, factor: float, pins: tuple[float, ...]) -> str:
    at = " and ".join(short(x, 4) for x in pins)
    held = f"free to turn on pins at {at} mm" if len(pins) > 1 else f"built in at {at} mm"
    pose = "" if where is None else f" at {told(where)}"
    return f"largest compression {short(compression, 3)} N{pose}; buckling at {short(factor, 3)} times that, {held}"


def _solid_buckles(factor: float, most: float, held: Reason | str, least: float | None) -> str:
    times = f"at {short(factor, 3)}" if math.isfinite(factor) else f"at more than {plain(most)}"
    lower = "" if least is None else f"; at {short(least, 3)} times where its joints move with it"
    return f"its solid buckles {times} times the load, {told(held)}{lower}"


def _buckling_judged(found: Reason | str, judgement: Reason | None) -> str:
    return told(found) if judgement is None else told(found) + told(judgement)


def _may_change_this(sources: tuple[str, ...]) -> str:
    return f"{' and '.join(sources)} may change this"


def _through_dead_point(driven: str | None) -> str:
    who = "the structure" if driven is None else f"the driven link {driven}"
    return (
        f"play of pins may take the linkage through a dead point of {who}, where joint forces grow without bound, so "
        "no band that depends on them has an end"
    )


_COUPLES = "how pins share the couples between layers may make the stress of {link}"

SENTENCES: dict[str, Sentence] = {
    "under_load_cases": _under_load_cases,
    # Which model gives the joint forces.
    "all_joints_bonded": "its joints are bonded",
    "joints_bonded": _joints_bonded,
    "case_says": "the case says that {which}; {why}",
    "case_says_and_so": "the case says that {which}, and so {why}",
    "load_out_of_plane": "a load acts out of the linkage's plane, where pins carry moments",
    "more_constraints": "the linkage has more constraints than equilibrium has equations",
    "layers_make_couples": "the links lie in layers, between which joint forces make couples",
    "loads_in_plane": "all loads act in the linkage's plane, where equilibrium alone gives the forces",
    "rigid_in_frame": "link {link} has no part and is rigid in the frame",
    "forces_of_frame": "{why}, so the joint forces are those of a {model}",
    "followed_with_centre_lines": "equilibrium was followed on the deformed shape with the links' centre lines",
    "of_sharing_solids": "of the solids by whose stiffness the links share the load",
    "of_beams_in_frame": "of links that are beams in the frame",
    "solid_for_point": "the displacement of a point of the linkage asked for a solid",
    "pose_coordinate": "the pose coordinate {link}",
    "held_link": "the {held}",
    "close_to_dead_point": (
        "the pose is close to a dead point of {of} (smallest singular value {distance:short2}): small errors of length "
        "and angle change the joint forces considerably"
    ),
    "leaves_stop": (
        "on its deformed shape the linkage leaves stop '{stop}', which would have to pull there with {effort:short3} "
        "{unit}; stiffen its links, or let it balance beside the stop"
    ),
    # The deformed shape.
    "between": "between {one} and {other}",
    "large_displacement_off": ("large displacement was not checked, because the case says large_displacement = off"),
    "large_displacement_unknown": "large displacement was not checked: {error}",
    "moves_little": (
        "the linkage moves by at most {linear:short3} mm ({where}), {share:share3} of its span of {span:short4} mm "
        "(limit {limit:share3}): equilibrium in the undeformed pose is accurate enough"
    ),
    "moves_too_far": (
        "by linear theory the linkage moves by {linear:short3} mm ({where}), {share:share3} of its span of "
        "{span:short4} mm, too far for linear theory (limit {limit:share3})"
    ),
    "buckles_too_near": (
        "by linear theory the linkage buckles at {factor:short3} times its load, too near for linear theory (limit "
        "{limit:plain})"
    ),
    "dead_point_too_near": (
        "{factor:short3} times its displacements by linear theory take the linkage to a dead point, too near for "
        "linear theory (limit {limit:plain})"
    ),
    "buckles_below_load": (
        "{why}; on its deformed shape it does not hold the load: it buckles at {held:share3} of it (it is unstable "
        "beyond)"
    ),
    "gives_way_below_load": (
        "{why}; on its deformed shape it does not hold the load: it gives way at {held:share3} of it (a limit load or "
        "a snap-through)"
    ),
    "holds_on_deformed_shape": (
        "{why}; on its deformed shape its points move by up to {moved:short3} mm; joint forces and verdict come from "
        "that shape"
    ),
    "frame_gives_no_displacement": "the frame gives no displacement: {why}",
    "frame_blind_to_link": "the frame takes link {link} for a beam along its axis, which does not tell",
    "linear_theory_too_high": "linear theory puts it too high",
    "steps_of_load": "steps of the load",
    "buckling_below": "buckling at less than {factor:plain} times the load",
    "buckling_of_link": "buckling of a link by itself",
    # Buckling of the linkage.
    "no_equilibrium": (
        "the linkage gives way, so there is no equilibrium to judge; numbers are those of the undeformed pose"
    ),
    "unstable_by_linear_theory": "the linkage becomes unstable at {factor:short3} times its load by linear theory",
    "dead_point_by_linear_theory": (
        "{factor:short3} times its displacements by linear theory take the linkage to a dead point"
    ),
    "link_buckles_by_itself": "link {link} by itself buckles at {factor:short3} times its load, as a solid",
    "so_linkage_gives_way": "{how}, so the linkage gives way",
    "may_snap_through": "{how}; it may snap through at {factor:short3} times its load: {remedy}",
    "follow_deformed_shape": "follow its deformed shape",
    "displacements_grow": "{how}; displacements are up to {times:short3} times those of linear theory",
    "softer_by_solids": "by their solids the links are {times:short3} times as soft as the plain beams of that shape",
    "linear_buckling_factor": "the buckling factor by linear theory is {factor:short3}",
    "beyond_strength": (
        "all this is elastic and void once material gives way, and {link} bears {stress:short3} MPa by beam theory "
        "where its strength is {strength:short3} MPa"
    ),
    # Buckling of a link; a judgement begins with what separates it.
    "compressed_column": _compressed_column,
    "buckling_judged": _buckling_judged,
    "solid_buckles": _solid_buckles,
    "buckles_with_stiffest_joints": ", and at {most:short3} times with the stiffest joints, so it buckles",
    "stiffer_joints_raise_it": "; stiffer joints can raise this to {most:short3} times",
    "imperfections_grow": "; within {within:plain} times the load, geometric imperfections grow too much",
    "bending_grows_little": "; the linkage buckles at {linkage:short3} times its load, so bending grows little",
    "bending_has_grown": (
        "; bending is up to {times:short3} times that of linear theory; stress and deflection include this"
    ),
    "bending_grows": "bending that grows with compression",
    "built_in_at": "built in at {place}",
    "on_pins": "in place at pins {first} and {last} and free to turn there",
    "on_pins_and_third": "in place at pins {first} and {last}, out of the plane at {third} too, and free to turn there",
    # What play, air, friction and couples leave open.
    "growth_of_bending": "of bending under compression and of joint forces",
    "may_change_this": _may_change_this,
    "through_dead_point_by_play": _through_dead_point,
    "rests_nowhere_with_play": (
        "with play no single place was found where the linkage rests, since the force of a joint turns round as its "
        "pin changes sides; bands hold every place"
    ),
    "nearest_to_dead_point": "where play brings it nearest to a dead point, {why}",
    "with_normal_coefficient": "with C_N = {coefficient:plain}, {why}",
    "locks_with_most_friction": (
        "with the largest friction that may be ({friction}) the linkage locks itself, so no band that depends on joint "
        "forces has an end; state joints.*.friction_range where it is known"
    ),
    "couples_of_layers": f"{_COUPLES} {{times:short3}} times as large; {{helps}}",
    "couples_of_layers_at_most": f"{_COUPLES} up to {{times:short3}} times as large; {{helps}}",
    "no_tight_pins_decide": "no tight_in of joints would decide its check",
    "tight_in_both_decides": "tight_in of joints {joints}, in both links, would decide its check",
    "tight_in_first_decides": "tight_in of joints {joints}, in the first link of each, would decide its check",
    "tight_in_second_decides": "tight_in of joints {joints}, in the second link of each, would decide its check",
}
