"""Sentences on numbers and their bands: beside which side of a limit they lie, and what the bands cover."""

from alula.fea.common.reason import Reason
from alula.reports.sentences.catalogue import Sentence, told
from alula.reports.words.numbers import short


def _together(reasons: tuple[Reason | str, ...]) -> str:
    return "; ".join(map(told, reasons))


def _play(ends: tuple[float, float], joints: tuple[str, ...]) -> str:
    least, most = (short(end, 3) for end in ends)
    return f"{least if ends[0] == ends[1] else f'{least} to {most}'} mm at {', '.join(joints)}"


def _friction(ranges: tuple[tuple[float, float, tuple[str, ...]], ...]) -> str:
    return "; ".join(f"{short(low, 3)} to {short(high, 3)} at {', '.join(joints)}" for low, high, joints in ranges)


SENTENCES: dict[str, Sentence] = {
    "together": _together,
    "not_known": "it is not known",
    "band_holds_limit": "its band {low:short3} to {high:short3} holds the limit {limit:plain}, so it may pass or fail",
    "band_keeps_limit": (
        "its band {low:short3} to {high:short3} lies wholly on the safe side of the limit {limit:plain}"
    ),
    "band_misses_limit": (
        "its band {low:short3} to {high:short3} lies wholly on the wrong side of the limit {limit:plain}"
    ),
    "as_at_room_temperature": "{why}, and until then numbers are those of room temperature",
    # What a band covers.
    "covers_no_model_error": "no error of the model: {why}",
    "covers_nothing": "nothing: {why}",
    "source_of_error": "{kind} ({detail})",
    "over_half_and_quarter": "over 180° and over 90°",
    "more_than_pin_pressure": "up to {shortfall:.0%} more than the narrower pin pressure",
    "by_faces_and_bore": "by eye-faces and by bore-shear",
    "tight_or_tilting_pins": "pins tight in either link, or tilting in all holes",
    "normal_coefficients": "C_N from {least:plain} to {largest:plain}",
    "play_at_joints": _play,
    "friction_at_joints": _friction,
    "range_of_shares": "{low:.0%} to {high:.0%}",
    "range_of_stress": "{low:short4} to {high:short4} MPa",
    "range_of_stress_across_layers": "{low:short4} to {high:short4} MPa across the layers",
    "range_of_stress_along_layers": "{low:short4} to {high:short4} MPa in shear along the layers",
}
