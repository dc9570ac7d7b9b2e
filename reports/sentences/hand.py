"""Sentences on hand calculation: whether it decides a link, what its numbers hold, and what it found at details."""

from alula.fea.common.reason import Reason
from alula.reports.sentences.catalogue import Sentence, told
from alula.reports.words.numbers import short


def _cut_part(stations: int, held: int, ends: tuple[float, float], odd_sections: bool) -> str:
    first, last = (short(end, 3) for end in ends)
    where = f"x = {first} to {last} mm" if held > 1 else f"x = {first} mm"
    odd = "; sections that are no rectangle, rod or tube count with their mean shear stress" if odd_sections else ""
    return (
        f"hand calculation cuts the part at {stations} stations between its pins and decides nothing; beam theory "
        f"holds at {held} of them ({where}){odd}"
    )


def _open_bores(bores: tuple[tuple[str, float], ...]) -> str:
    told = ", ".join(f"{pin} has {share:.0%}" for pin, share in bores)
    return f"bores are not round all the way ({told} of its circle): pressure acts on the rest"


def _bores_off_plane(bores: tuple[tuple[str, float], ...]) -> str:
    told = ", ".join(f"{pin} at z = {short(middle, 4)} mm" for pin, middle in bores)
    return (
        f"the middles of bores lie off the plane of forces ({told}): there the couple of the force about the middle is "
        "a pressure linear along the bore"
    )


def _limit(ends: tuple[float, float]) -> str:
    low, high = (short(end, 3) for end in ends)
    return low if ends[0] == ends[1] else f"{low} to {high} (with stated scatter)"


def _limit_within(what: str, low: float, high: float, limit: tuple[float, float], unit: str) -> str:
    return f"the {what} is {short(low, 3)} to {short(high, 3)} {unit}; the limit, {_limit(limit)} {unit}, lies inside"


def _clear_by_hand(
    ends: tuple[float, float],
    place: Reason | str,
    limits: tuple[tuple[float, float], ...],
    displacement: tuple[float, float] | None,
) -> str:
    low, high = (short(end, 3) for end in ends)
    text = f"by hand the peak stress lies between {low} and {high} MPa, at most at {told(place)}"
    if limits:
        text += f", clear of the limit {', '.join(map(_limit, limits))} MPa"
    if displacement is not None:
        least, most = (short(end, 3) for end in displacement)
        text += f"; the displacement, {least} to {most} mm, is clear of its limits"
    return text


_TOO_CLOSE = "are too close for the hand formula (gap {gap:short3} widths, needs {needed:short3})"

SENTENCES: dict[str, Sentence] = {
    # Why it is not calibrated for a link.
    "sharp_junctions": "its junctions are sharp, where stress has no limit",
    "pin_off_axis": "a pin lies off its axis",
    "eyes_too_close": f"its eyes {_TOO_CLOSE}",
    "holes_too_close": f"a hole and its neighbour {_TOO_CLOSE}",
    "loaded_end_too_close": f"a loaded end and the nearest eye or hole {_TOO_CLOSE}",
    "outside_calibration": (
        "its {proportion} {value:short3} is outside the calibrated range {low:short3} to {high:short3}"
    ),
    "disc_is_no_beam": "a disc is as wide as it is long, where beam theory does not hold",
    "shape_not_measured": "no part of shape {shape} was measured",
    "has_slot": "it has a slot",
    "has_fork": "it has a fork",
    "has_eye_of_own_sizes": "it has an eye of sizes of its own",
    "clamp_not_measured": "it is clamped, and what the edge of a clamp adds was not measured",
    "uncalibrated": "hand calculation is not calibrated for this link",
    "uncalibrated_since": "hand calculation is not calibrated for this link: {outside}",
    "run_solid_of_uncalibrated": (
        "hand calculation is not calibrated for this link: {outside}; run the solid model (--fidelity solid)"
    ),
    "calibration": (
        "solid models of {parts} parts under {load_cases} load cases, least and largest factor, widened by {margin:.0%}"
    ),
    # Which model decides a link.
    "idle_link": "nothing acts on it",
    "solid_requested": "a solid was requested",
    "accuracy_requested": "an accuracy was requested",
    "hand_requested": "hand calculation was requested",
    "left_out_of_what_gives_way": (
        "no link passes where the linkage gives way, so its solid was not solved; --fidelity solid solves it"
    ),
    "open_whatever_solid_tells": (
        "what its checks hold besides leaves them open wherever in its band the stress by hand lies, so its solid was "
        "not solved; --fidelity solid solves it"
    ),
    "layers_open_by_hand": ("by hand only the least of layers in any direction is known, so finite elements decided"),
    "limit_within": _limit_within,
    "open_by_hand": "by hand {open_limit}, so finite elements decided",
    "clear_by_hand": _clear_by_hand,
    "cost_of_solid": "a solid model of some {elements:,} elements, about {seconds:,} s",
    # What its numbers hold.
    "beam_without_concentration": "beam theory without stress concentration",
    "beam_alone": "beam theory alone: stress concentration at eyes and holes is not in these numbers",
    "idle_in_load_case": "nothing acts on this link in this load case",
    "no_beam": "no beam stands for this link; run the solid model (--fidelity solid)",
    "times_stress_at_mouth": "up to {factor:plain} times the nominal stress at its mouth",
    "no_mesh_tells": "no mesh tells what it is",
    "sharp_edges_left": (
        "elasticity has no finite stress at the {edges} sharp inner edges of this link; they bear less than "
        "{share:.0%} of its peak here, or do not grow as such edges do, and were left at that"
    ),
    # Places.
    "hole_of_row": "hole at x = {x:plain} mm of row {row}",
    # A part that is cut into sections.
    "sections_in_pieces": "its sections are in several pieces",
    "sections_change_fast": "its sections change fast along the line of its pins, or run off it",
    "pins_too_near_for_depth": "its pins are too near one another for its depth",
    "cut_part_is_no_beam": (
        "the part is no beam: {why}; hand calculation by its sections at {stations} stations is an estimate that "
        "decides nothing"
    ),
    "cut_part": _cut_part,
    # Details.
    "detail_bears": "by hand {name} bears {stress:short3} MPa at x = {x:short3} mm ({remark})",
    "net_section_of_flanks": "net section of two flanks {height:short3} mm high, and their own bending",
    "net_section_of_stocky_flanks": (
        "net section of two flanks {height:short3} mm high, and their own bending; an estimate, since they are only "
        "{slender:short2} times as long as high"
    ),
    "net_section_of_walls": "net section of the tube's walls, without the stress concentration at the hole",
    "cheek_built_in": "a cheek built in at the root of the gap, without the stress concentration there",
    "section_of_arm": "its own section at the eye or wall from which it starts, under the pin's force alone",
    "pin_on_slot_flank": (
        "as a solid a pin pushes on half, and for the band on a quarter of its diameter, of a slot's flank"
    ),
    "open_bores": _open_bores,
    "bores_off_plane": _bores_off_plane,
}
