"""Sentences on what is followed over a motion: poses, fatigue, and bands from one mesh or several."""

from alula.fea.common.reason import Reason
from alula.reports.sentences.catalogue import Sentence, told
from alula.reports.words.numbers import fixed, short


def _least_of_poses(looked_at: int, poses: int, pose: Reason | None) -> str:
    return f"the least of {looked_at} of {poses} poses" + ("" if pose is None else f", at {told(pose)}")


def _place(place: tuple[float, ...]) -> str:
    return ", ".join(f"{axis} = {fixed(at, 1)}" for axis, at in zip("xyz", place, strict=True)) + " mm"


def _at_pose_and_place(pose: Reason, place: tuple[float, ...]) -> str:
    return f"at {told(pose)}, {_place(place)}"


def _fatigue_of_layers(tension: tuple[float, float], shear: tuple[float, float], place: tuple[float, ...]) -> str:
    pull, slip = (f"{short(mean, 3)} ± {short(amplitude, 3)} MPa" for mean, amplitude in (tension, shear))
    return f"{pull} across the layers, {slip} of shear along them, at {_place(place)}"


def _poses_near_dead_point(
    link: str, angles: tuple[float, ...], coordinate: str, left_out: int, poses: int, growth: float
) -> str:
    at = ", ".join(fixed(angle, 2) for angle in angles)
    return (
        f"the driven link {link} has a dead point at {at} deg of {coordinate}; {left_out} of {poses} poses are left "
        f"out, where the drive torque is more than {growth:g} times that at the best leverage"
    )


def _not_checked(checks: tuple[str, ...]) -> str:
    about = "is about" if len(checks) == 1 else "are about"
    return f"not checked over the motion: {', '.join(checks)}, which {about} one pose or the motor; see alula check"


_FOURFOLD = "fourfold estimate on one mesh, since none was refined for"

SENTENCES: dict[str, Sentence] = {
    # Poses.
    "pose_of_motion": "{coordinate} = {value:short5} {unit}",
    "at_pose_and_place": _at_pose_and_place,
    "least_of_poses": _least_of_poses,
    "under_force": "under {force:short3} N at {when}: {why}",
    "unstable_at_pose": (
        "at {pose} linear theory finds it unstable or at a dead point at {factor:short3} times the load"
    ),
    "check_that_pose": "check that pose with alula check, which follows the deformed shape",
    "poses_near_dead_point": _poses_near_dead_point,
    "poses_without_balance": "{left_out} of {poses} poses are left out, since no drive torque balances them",
    "left_out_near_dead_point": (
        "poses near a dead point of the driven link were left out, where its torque grows without bound"
    ),
    "not_checked_over_motion": _not_checked,
    "rigid_in_motion": "links are rigid in the motion: equilibrium is that of the undeformed linkage",
    "buckling_not_followed": (
        "no beam stands for its buckling, and its solid is not looked at over a motion; check single poses with alula "
        "check"
    ),
    # Fatigue.
    "not_asked_for": "it was not asked for",
    "no_fatigue_data": (
        "the material's card has no fatigue data; add [materials.<name>.fatigue] with stress, cycles and source"
    ),
    "no_ultimate_strength": (
        "Goodman's line needs ultimate_strength, which the material's card does not state; add it"
    ),
    "no_fatigue_data_of_layers": (
        "the card of '{material}' has no fatigue data across the layers; add [materials.<name>.fatigue_across_layers] "
        "with stress, cycles and source, measured on specimens built upright"
    ),
    "history_not_closed": "poses near a dead point are left out, so the stress history is not closed",
    "repetitions_beyond_card": "the material's card ends below the repetitions that are wanted",
    "card_ends_before": (
        "the material's card ends at {cycles:plain} cycles and states no exponent, so its strength for {wanted:plain} "
        "repetitions is not known; ask for at most as many, or add an exponent to the card"
    ),
    "fatigue_of_layers": _fatigue_of_layers,
    # Bands.
    "peak_not_known": "its peak is not known",
    "peak_without_limit": "the peak has no limit",
    "error_of_one_mesh_unknown": "the error of its one mesh is not estimated",
    "at_worst_pose": "{found}, at the worst pose",
    "fourfold_estimate_of_layers": f"{_FOURFOLD} layers",
    "fourfold_estimate_of_pose": f"{_FOURFOLD} this pose",
    "fourfold_estimate_of_fatigue": f"{_FOURFOLD} the place where fatigue is worst",
}
