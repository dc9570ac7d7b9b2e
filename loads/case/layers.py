"""Layers: at what height along the pins each link lies, and how much of that height it takes up."""

from typing import TYPE_CHECKING

from geometry.base.errors import CaseError
from geometry.parts.part import FilePart

if TYPE_CHECKING:
    from loads.case.core import CoreCase


def heights(case: "CoreCase") -> dict[str, float]:
    """Return the height of every link's mid-plane.

    A layer k stands at k times ``layer_spacing``. Without a spacing the lowest layer stands at 0, and each further one
    by half of both layers' thickness and a ``washer`` above the one before; a layer is as thick as its thickest link.

    Parameters
    ----------
    case : CoreCase
        Whose links state a layer or a height each, or none at all.

    Returns
    -------
    dict of str to float
        Link -> z [mm]; all 0 where none is stated.

    Raises
    ------
    CaseError
        For a link without layer beside others with one, for both a layer and a height, for layers without spacing, and
        for thicknesses that are not known.
    """
    stated = [name for name, link in case.links.items() if link.layer is not None or link.z is not None]
    if not stated:
        for entry in ("layer_spacing", "washer"):
            if getattr(case, entry) is not None:
                raise CaseError(f"{entry}: no link states a layer; give every link one, such as links.A.layer = 1")
        return dict.fromkeys(case.links, 0.0)
    for name, link in case.links.items():
        if link.layer is None and link.z is None:
            raise CaseError(
                f"links.{name}.layer: it is missing, while link '{stated[0]}' states where it lies; give every link a "
                "layer or z, the ground too"
            )
        if link.layer is not None and link.z is not None:
            raise CaseError(f"links.{name}.z: the link states a layer as well; leave one of them out")
    layers = sorted({link.layer for link in case.links.values() if link.layer is not None})
    levels = _levels(case, layers)
    return {name: levels[link.layer] if link.layer is not None else link.z or 0.0 for name, link in case.links.items()}


def _levels(case: "CoreCase", layers: list[int]) -> dict[int, float]:
    """Return layer -> its height."""
    spacing, washer = case.layer_spacing, case.washer
    if spacing is not None and washer is not None:
        raise CaseError("washer: layer_spacing is stated as well; leave one of them out")
    if spacing is not None:
        return {layer: layer * spacing for layer in layers}
    if not layers:
        return {}
    if washer is None:
        raise CaseError(
            'layer_spacing: it is missing, while links state layers; state it, such as layer_spacing = "7 mm", or a '
            "washer between layers that are as thick as their links"
        )
    level, found, below = 0.0, {}, None
    for layer in layers:
        thick = max(_height(case, name) for name, link in case.links.items() if link.layer == layer)
        level += 0.0 if below is None else below / 2.0 + washer + thick / 2.0
        found[layer], below = level, thick
    return found


def _height(case: "CoreCase", name: str) -> float:
    found = thickness(case, name)
    if found is None:
        raise CaseError(
            f"links.{name}.thickness: how high the link is along the pins does not follow from its part, but washers "
            'between layers need it; state it, for example "3 mm", or state layer_spacing in place of washer'
        )
    return found


def thickness(case: "CoreCase", name: str) -> float | None:
    """Return the height along the pins that a link takes up.

    Parameters
    ----------
    case : CoreCase
    name : str
        Of the link.

    Returns
    -------
    float or None
        [mm]; None where the link neither states it nor has a part of a shape of alula's own.
    """
    link = case.links[name]
    part = None if link.part is None else case.parts.get(link.part)
    if link.thickness is not None or part is None or isinstance(part, FilePart):
        return link.thickness
    eyes = [eye.thickness for eye in link.eyes.values() if eye.thickness is not None]
    return max(part.eye_thickness, 2.0 * part.section.half_z, *eyes, 0.0)


def slab(case: "CoreCase", name: str) -> tuple[float, float]:
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
    level, known = case.heights[name], thickness(case, name)
    if known is None and case.links[name].part is not None:
        body = case.body(name)
        rings = [body.ring(pin) for pin in body.pins]
        return level + min(ring.low for ring in rings), level + max(ring.high for ring in rings)
    half = (known or 0.0) / 2.0
    return level - half, level + half


def check_layers(case: "CoreCase") -> None:
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
            if entry in joint.model_fields_set:
                why = "the layers tell the gap" if layered else "it has a meaning only where links lie in layers"
                raise CaseError(f"joints.{name}.{entry}: {why}; leave it out")
