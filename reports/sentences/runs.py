"""Sentences on runs: studies, tolerances, sizes, second opinions, claims."""

from alula.reports.sentences.catalogue import Sentence


def _samples_in_undeformed_pose(*, load_cases: tuple[str, ...]) -> str:
    return (
        f"load case{'s' if len(load_cases) > 1 else ''} {', '.join(load_cases)}: joint forces of the samples are those "
        "of the undeformed pose, in proportion to the nominal ones on the deformed shape; how deviations change the "
        "deformed shape is not covered"
    )


SENTENCES: dict[str, Sentence] = {
    # Second opinions
    "no_second_opinion": "{link}: no second opinion: {why}; its deck is {deck}",
    "second_opinion_differs": (
        "{link}: CalculiX differs by {displacement:.2%} in displacement and {stress:.2%} in von Mises stress on the "
        "same mesh (at most {displacement_expected:.1%} and {stress_expected:.0%} are expected); on coarse curved "
        "elements, whose stiffness CalculiX integrates at fewer points, refining brings both together; else trust "
        "neither"
    ),
    # Tolerances
    "check_left_out": "{name} of {subject} (without deviations: {verdict})",
    "samples_do_not_cover": "the samples do not cover, and no probability counts: {checks}",
    "samples_in_undeformed_pose": _samples_in_undeformed_pose,
    "nominal_couples_of_layers": (
        "links lie in layers: the couples between these are those of the nominal case, in proportion to what the links "
        "and pins bear in one plane; how deviations change their shares is not covered"
    ),
    "some_samples_compress": (
        "some samples compress {links}, which the nominal loads pull; their buckling is not covered"
    ),
    "samples_fail": "{count} of {samples} samples {why}; they count as failed",
    "cannot_stand_in_pose": (
        "cannot stand in the pose: {coordinate} comes to a dead point up to {by:short2} {unit} before it"
    ),
    "do_not_assemble": "do not assemble on the branch of the nominal pose, even when led there in steps",
    "at_dead_point_of_drive": "are at a dead point of the drive, where joint forces grow without limit",
}
