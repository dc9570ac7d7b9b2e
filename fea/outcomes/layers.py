"""Outcome of the check of a printed link's layers."""

from collections.abc import Iterator, Mapping

import numpy as np

from fea.common.band import Band
from fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from fea.outcomes.layer_stress import LayerStress
from fea.outcomes.limits import layer_limit
from fea.outcomes.result import LinkResult
from loads.case.case import Case

CHECK = "layers"
"""Name of the check, beside that of the safety factor."""


def layer_outcomes(case: Case, load_case: str, links: Mapping[str, LinkResult]) -> Iterator[CheckOutcome]:
    """Yield the outcome of the layers of every link whose safety factor is checked and that states how it was built.

    Parameters
    ----------
    case : Case
    load_case : str
        Its name.
    links : mapping of str to LinkResult

    Yields
    ------
    CheckOutcome
    """
    for link, result in links.items():
        limit = layer_limit(case, link)
        if limit is None:
            continue

        def outcome(value: Band, link: str = link, limit: float = limit) -> CheckOutcome:
            return CheckOutcome.of(CHECK, Subject.link(link), load_case, Quantity.LAYERS, value, limit)

        material, found = case.material_of(link), result.layers
        if found is not None:
            yield _judged(outcome(found.safety_factor), found, material.title)
        elif result.beam.idle:
            yield outcome(Band.exact(np.inf)).because("nothing acts on this link")
        elif material.strength_across_layers is None:
            yield outcome(Band.unknown()).because(no_strength(material.title))
        else:
            yield outcome(Band.unknown()).because(
                "hand calculation tells nothing of the stress on layers; run the solid model (--fidelity solid)"
            )


def _judged(outcome: CheckOutcome, found: LayerStress, title: str) -> CheckOutcome:
    meshes = found.discretisation
    if outcome.value.unknowable:
        return outcome.because(meshes.sentence)
    stopped = f"; refinement ended because {meshes.stopped}" if meshes.stopped else ""
    open_yet = outcome.verdict is Verdict.UNDECIDED
    outcome = outcome.because(f"{outcome.reason}{stopped if open_yet else ''}; {found.place}")
    return outcome if found.layers.between is not None else without_shear(outcome, title)


def no_strength(title: str) -> str:
    """Return why layers are not judged without their strength, and what to do.

    Parameters
    ----------
    title : str
        Of the material.

    Returns
    -------
    str
    """
    return (
        f"the card of '{title}' states no strength_across_layers; add it, measured on specimens built upright, or "
        "remove build_direction from the part"
    )


def without_shear(outcome: CheckOutcome, title: str) -> CheckOutcome:
    """Return an outcome by tension across the layers alone, which passes nothing.

    Parameters
    ----------
    outcome : CheckOutcome
    title : str
        Of the material, which states no strength against shear.

    Returns
    -------
    CheckOutcome
    """
    if outcome.verdict is not Verdict.FAIL:
        return outcome.left_open(
            f"shear along the layers may decide, but the card of '{title}' states no shear_strength_between_layers; "
            f"add it. By tension across the layers alone: {outcome.reason}"
        )
    return outcome
