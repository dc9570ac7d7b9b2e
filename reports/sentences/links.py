"""Sentences on links by themselves: stress, meshes, solvers, layers, beams, buckling of one link."""

from alula.fea.common.reason import Reason
from alula.reports.sentences.catalogue import Sentence, told
from alula.reports.words.numbers import fixed, short


def _error_of_meshes(
    *, made: int, elements: int, values: tuple[float, ...], order: float | None, error: float, rule: Reason
) -> str:
    meshes = "one mesh" if made == 1 else f"{made} meshes, the finest"
    observed = "" if order is None else f", observed order {fixed(order, 1)}"
    peaks = ", ".join(short(value, 3) for value in values)
    most = f"{short(100.0 * error, 2)} %"
    return f"{meshes} of {elements:,} elements: peak {peaks} MPa{observed}, error at most {most} ({told(rule)})"


def _peak_of_layers(*, place: tuple[float, ...], tension: float, shear: float) -> str:
    x, y, z = (fixed(value, 1) for value in place)
    kind = "compression" if tension < 0.0 else "tension"
    across = f"{short(abs(tension), 3)} MPa of {kind} across the layers"
    return f"largest at x = {x}, y = {y}, z = {z} mm: {across}, {short(shear, 3)} MPa of shear along them"


def _size_of_system(*, unknowns: int, right_hand_sides: int) -> str:
    return f"{unknowns:,} unknowns, {right_hand_sides} right-hand side{'' if right_hand_sides == 1 else 's'}"


SENTENCES: dict[str, Sentence] = {
    # Meshes and their refinement
    "mesh_too_coarse": (
        "mesh too coarse: estimated error {error:share2} in the energy norm, limit {limit:share2}. No stress is "
        "reported; {remedy}"
    ),
    "sharp_edge_bears_much": (
        "a sharp inner edge bears at least {least:share2} of the peak stress. Showing whether that stress has a limit "
        "takes {wanted} meshes, this run made {made}. No safety factor is reported; state the real fillet_radius (of a "
        "pocket: floor_radius; of a part from CAD: round it there); {remedy}"
    ),
    "peak_still_grows": (
        "the peak stress still grows after {made} meshes ({values:short3} MPa), by {step:share2} in the last step. No "
        "safety factor is reported; {remedy}"
    ),
    "one_mesh_was_enough": (
        "one mesh of {elements:,} elements was enough: its error ({error:share2}, with a fourfold margin) keeps clear "
        "of every limit"
    ),
    "singular_edge": (
        "the stress at the sharp inner edge at x = {place[0]:short3}, y = {place[1]:short3}, z = {place[2]:short3} mm "
        "({degrees:fixed0}° of material) is singular: it has no limit, but grows with every finer mesh, as element "
        "size to the power {power:fixed2} (theory {theory:fixed2}). State the real fillet_radius (of a pocket: "
        "floor_radius; of a part from CAD: round it there). For screening only: {distance:short2} mm or more from such "
        "edges, the von Mises stress is at most {screening:short3} MPa"
    ),
    "error_of_meshes": _error_of_meshes,
    "meshes_converged": "{found}: converged",
    "meshes_decided": "{found}, more than the {aim:share2} aimed at, but no limit lies within it",
    "meshes_stopped": "{found}, more than the {aim:share2} asked for: {why}",
    "by_index": "index with factor {factor:plain}",
    "by_estimate": "{factor:plain} times the estimate at the place",
    "estimated_on_one_mesh": "estimated on one mesh, fourfold",
    "two_meshes": "two meshes, no observed order: {rule}",
    "grid_convergence": "grid convergence over {meshes} meshes, {rule}",
    "without_sharp_edges": (
        "{found}; without the stress at sharp edges ({edges}), below {most:.0%} of the peak and without limit"
    ),
    "refine_further": "refine further",
    "refinement_ended": "refinement ended because {why}",
    "finer_mesh_unusable": "a finer mesh could not be used: {why}",
    "memory_ran_out": "memory ran out",
    "mesh_of_file": "the mesh is that of the part's file, which is not refined",
    "most_meshes_reached": "the largest number of meshes, {most}, is reached",
    "time_limit_used_up": "the time limit of {limit:plain} s is used up",
    "no_finer_mesh_decides": (
        "what its checks hold besides leaves them open wherever in the band of the meshes its numbers lie, so no finer "
        "one decides them"
    ),
    "next_mesh_too_large": "the next mesh has {unknowns:,} unknowns, more than the {allowed:,} allowed",
    "mesh_too_coarse_for_buckling": (
        "its mesh is too coarse for a buckling factor, which may be off by more than {error:.0%}"
    ),
    # Layers
    "nothing_acts_on_link": "nothing acts on this link",
    "none_is_stated": "none is stated",
    "least_of_layers_by_hand": "{found}; by hand this is the least for any direction of the layers",
    "layers_by_hand": (
        "by hand only the least of layers in any direction is known; run the solid model (--fidelity solid)"
    ),
    "no_build_direction": (
        "parts.{part} states no build_direction, and built in the weakest one its layers part first; state it"
    ),
    "neither_direction_nor_shear_strength": (
        "parts.{part} states no build_direction, and the card of '{material}' states no shear_strength_between_layers, "
        "which may be the weakest; state both"
    ),
    "open_for_meshes": "{found}; refinement ended because {why}",
    "peak_of_layers": _peak_of_layers,
    "no_strength_across_layers": (
        "the card of '{material}' states no strength_across_layers; add it, measured on specimens built upright, or "
        "remove build_direction from the part"
    ),
    "no_shear_strength_of_layers": (
        "shear along the layers may decide, but the card of '{material}' states no shear_strength_between_layers; "
        "add it. By tension across the layers alone: {by_tension}"
    ),
    # Buckling of solids
    "no_beam_and_no_solid": (
        "no beam stands for its buckling, and its solid was not solved; run the solid model (--fidelity solid)"
    ),
    "up_to_share_of_factor": "up to {share:.1%} of the factor",
    "bending_towards_buckling": "bending towards buckling at {factor:short3} times the load",
    # Loads and pins
    "evenly_over_projected_area": "the joint force of statics, evenly over the pin's projected area",
    "bearing_on_eye": "bearing on the eye of {link}: {why}",
    "torque_by_pin_or_faces": "of a bonded joint, by its pin or by its faces",
    "nothing_acts": (
        "nothing acts inside any link under load case '{load_case}' ({why}), so its checks cannot decide; add a load"
    ),
    "loads_cancel": "its loads cancel where they act, or pass by every link with a part",
    "states_no_load": "it states no load",
    # Solutions and their solvers
    "supports_react": "the supports react with {share:.2%} of the load in case '{case}'",
    "nearly_incompressible": (
        "Poisson's ratio {ratio:plain} is above {most:plain}: elements resist changes of volume, and displacements "
        "come out too small, by 3 % at 0.4999 with four elements through a wall"
    ),
    "half_the_body": "half the body, {why}",
    "chosen_by_user": "chosen by the user",
    "size_of_system": _size_of_system,
    "factorisation_alone_suits": "{size}: factorisation alone suits this system",
    "too_slender_for_linear_elements": (
        "{size}: the body is {slenderness:fixed0} times as long as wide, where linear elements lock"
    ),
    "linear_elements_lock": "ν = {ratio:plain} is above {most:plain}, where linear elements lock",
    "factor_does_not_fit": "{size}: a factorisation needs about {needed:short2} GB of {left:short2} GB left",
    "small_enough_for_factorisation": "{size}: small enough for a factorisation",
    "iteration_takes_less_work": "{size}: more than {most:,} unknowns, up to which {solver} takes less work",
}
