"""Layers: how much of the height along the pins each link takes up, and what must fit together."""

from geometry.base.errors import CaseError
from loads.case.core import CoreCase
from loads.case.forks import forked_link
from loads.case.heights import thickness


def slab(case: CoreCase, name: str) -> tuple[float, float]:
    """Return the heights between which the material of a link lies.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the link.

    Returns
    -------
    tuple of float
        Lowest and highest z [mm]; equal where its thickness is not known.
    """
    level, known = case.heights[name], thickness(case.links[name], case.parts)
    if known is None and case.links[name].part is not None:
        body = case.body(name)
        rings = [body.ring(pin) for pin in body.pins]
        return level + min(ring.low for ring in rings), level + max(ring.high for ring in rings)
    half = (known or 0.0) / 2.0
    return level - half, level + half


def check_layers(case: CoreCase) -> None:
    """Check that heights are known, and what joints state about pins between layers.

    Parameters
    ----------
    case : CoreCase

    Raises
    ------
    CaseError
        As ``heights``; for a pin that is tight in a link that its joint does not have, or where no layers are stated;
        for a gap that the layers tell already.
    """
    case.linkage  # noqa: B018 - its own rules come first
    layered = case.layered
    for name, joint in case.joints.items():
        if joint.tight_in is not None and joint.tight_in not in joint.links:
            raise CaseError(
                f"joints.{name}.tight_in: '{joint.tight_in}' is no link of this joint; choose one of "
                f"{', '.join(joint.links)}"
            )
        for entry in ("tight_in",) if not layered else ("pin_gap",):
            in_fork = layered and forked_link(case, name) is not None  # both links lie in one layer
            if entry in joint.model_fields_set and not in_fork:
                why = "the layers tell the gap" if layered else "it has a meaning only where links lie in layers"
                raise CaseError(f"joints.{name}.{entry}: {why}; leave it out")
