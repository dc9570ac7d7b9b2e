"""Sentences on the linkage as a whole: joint forces, frames, play, pins, displacement, mass, size, clearance."""

from alula.fea.common.reason import Reason
from alula.reports.sentences.catalogue import Sentence, told
from alula.reports.words.numbers import short


def _frame_is_blind(*, link: str, rigid: bool) -> str:
    taken = "rigid" if rigid else "a beam along its axis"
    return f"the frame takes link {link} for {taken}, which does not tell how far it gives"


def _solid_tells_how_far_it_gives(*, link: str, rigid: bool) -> str:
    return f"{_frame_is_blind(link=link, rigid=rigid)}; its solid model does: run --fidelity solid"


def _solids_and_beams(*, solids: tuple[str, ...], beams: tuple[str, ...]) -> str:
    if not solids:
        return "the frame of the linkage"
    beside = f" and of the frame's beams of {', '.join(beams)}" if beams else ""
    return f"the solid model{'s' if len(solids) > 1 else ''} of {', '.join(solids)}{beside}"


def _play_lets_it_move(*, plane: float, across: float | None, without: str | None) -> str:
    tilted = ""
    if across is not None:
        tilted = f" in the plane and, as they tilt in their holes, by up to {short(across, 3)} mm across it"
    decides = "" if without is None else f"; without play the verdict would be {without}"
    return f"play of pins lets it move by up to {short(plane, 3)} mm to either side{tilted}{decides}"


def _made_up_of(*, masses: tuple[tuple[str, float], ...], others: float | None, not_counted: tuple[Reason, ...]) -> str:
    parts, left = ", ".join(f"{kind} {short(mass, 4)} g" for kind, mass in masses), ", ".join(map(told, not_counted))
    parts = parts or "no part weighs anything"
    if others is not None:
        return f"{parts}, others as stated {short(others, 4)} g{f', which stand for {left}' if left else ''}"
    return f"{parts}{f'; not counted: {left}' if left else ''}"


def _from_side_to_side(*, first: Reason, last: Reason, not_counted: tuple[Reason, ...]) -> str:
    left = f"; not counted: {', '.join(map(told, not_counted))}" if not_counted else ""
    return f"from {told(first)} to {told(last)}{left}"


SENTENCES: dict[str, Sentence] = {
    # Displacement of points
    "frame_is_blind": _frame_is_blind,
    "solid_tells_how_far_it_gives": _solid_tells_how_far_it_gives,
    "may_give_way_at": "may give way at {factor:short3} times the load or less, below {least:short3}",
    "moves_it_far": "moves it by {displacement:short3} mm, above {most:share6} of the span",
    "linear_frame_not_valid": (
        "the linear frame {why}, so it is not valid; remove large_displacement = off from the case"
    ),
    "no_upper_end": "the band has no upper end, since {why}",
    "play_through_dead_point": "play of pins may take the linkage through a dead point",
    "gives_way_in_some_air": "the linkage gives way within the stated range of C_N",
    "gives_way_with_any_friction": "the linkage locks itself or gives way with friction as large as it may be",
    "locks_by_tilting_pins": (
        "the linkage locks itself or gives way with friction as large as it may be, by the couples of pins that tilt "
        "in their holes; tight_in of joints {joints}, in both links, narrows it"
    ),
    "softly_held_by_tilting_pins": (
        "pins that tilt in their holes let the frame move it by {most:short3} mm in place of {tight:short3} mm, so "
        "softly held that nothing bounds how this grows; tight_in of joints {joints} narrows it"
    ),
    "gives_way_as_soft_as_may_be": "the linkage gives way with links as soft, or a load as large, as they may be",
    "near_giving_way": "by linear theory a factor of {factor:short2} or less on the load may make it give way",
    "towards_buckling_or_dead_point": "towards buckling or a dead point",
    "as_largest_displacement_of_solids": "of every link's solid, as that of its largest displacement",
    "frame_of_solids": "the frame of the links' solids",
    "solids_and_beams": _solids_and_beams,
    "displacement_by_linear_theory": "by {model}, by linear theory: {found}",
    "displacement_on_deformed_shape": "by {model}, on its deformed shape: {found}",
    "pins_may_sink": (
        "pins move as the mean of their bores; sinking into the sides that they press could add up to {most:short2} "
        "mm, which the band does not hold"
    ),
    "pins_may_sink_beyond_limit": (
        "pins move as the mean of their bores; sinking into the sides that they press could add up to {most:short2} "
        "mm, which the band does not hold and which would miss the limit"
    ),
    "play_lets_it_move": _play_lets_it_move,
    "holes_as_long_as_shortest": (
        "the holes of {links} are taken to be as long as the shortest of the others, {length:short3} mm, since no "
        "thickness is stated"
    ),
    "less_play_would_decide": "only less play would decide it: a smaller clearance, or longer holes",
    "solids_have_narrower_band": "solid models of all links (--fidelity solid) have a narrower band",
    "no_mesh_would_decide": "finer meshes would not decide it",
    "smaller_mesh_size_would_decide": "a smaller solid.mesh_size would decide it",
    "refinement_of_link_ended": "refinement of {link} ended because {why}",
    "frame_not_solved": "the frame in one plane was not solved",
    # Clearance, mass and size
    "none_at_one_height": "no two links, and no link and pin that passes it, lie at one height",
    "touch_first": "{names:and} touch first {where}",
    "come_nearest": "{names:and} come nearest {where}",
    "bounded_by_speed_of_outlines": "bounded by the speed of the outlines",
    "bounded_by_acceleration_of_outlines": "bounded by the acceleration of the outlines",
    "of_outlines": "of the outlines",
    "layers_come_nearest": (
        "links {links:and}, {gap:short3} mm apart along the pins without load, come nearest at x = {x:short4}, "
        "y = {y:short4} mm"
    ),
    "made_up_of": _made_up_of,
    "from_side_to_side": _from_side_to_side,
    "side": "{name} at {axis} = {value:short5} mm",
    "side_in_pose": "{name} at {axis} = {value:short5} mm ({coordinate} = {at:fixed2} {unit})",
}
