"""Sentences on runs: studies, tolerances, sizes, second opinions, claims."""

from alula.reports.sentences.catalogue import Sentence

SENTENCES: dict[str, Sentence] = {
    # Second opinions
    "no_second_opinion": "{link}: no second opinion: {why}; its deck is {deck}",
    "second_opinion_differs": (
        "{link}: CalculiX differs by {displacement:.2%} in displacement and {stress:.2%} in von Mises stress on the "
        "same mesh (at most {displacement_expected:.1%} and {stress_expected:.0%} are expected); on coarse curved "
        "elements, whose stiffness CalculiX integrates at fewer points, refining brings both together; else trust "
        "neither"
    ),
}
