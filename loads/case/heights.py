"""At what height along the pins each link lies."""

import json
from collections.abc import Iterable, Mapping

from alula.geometry.base.errors import CaseError
from alula.geometry.linkage.linkage import Link
from alula.geometry.parts.part import FilePart, Part

Links = Mapping[str, Link]
Parts = Mapping[str, Part]


def heights(links: Links, parts: Parts, spacing: float | None, washer: float | None) -> dict[str, float]:
    """Return the height of every link's mid-plane.

    A layer k stands at k times ``layer_spacing``. Without a spacing the lowest layer stands at 0, and each further one
    by half of both layers' thickness and a ``washer`` above the one before; a layer is as thick as its thickest link.

    Parameters
    ----------
    links : mapping of str to Link
        Which state a layer or a height each, or none at all.
    parts : mapping of str to Part
        Of the links.
    spacing, washer : float or None
        As the case states them [mm].

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
    stated = [name for name, link in links.items() if link.layer is not None or link.z is not None]
    if not stated:
        for entry, value in (("layer_spacing", spacing), ("washer", washer)):
            if value is not None:
                raise CaseError(f"{entry}: no link states a layer; give every link one, such as {layer_of(links)}")
        return dict.fromkeys(links, 0.0)
    for name, link in links.items():
        if link.layer is None and link.z is None:
            raise CaseError(
                f"links.{name}.layer: it is missing, while link '{stated[0]}' states where it lies; give every link a "
                "layer or z, the ground too"
            )
        if link.layer is not None and link.z is not None:
            raise CaseError(f"links.{name}.z: the link states a layer as well; leave one of them out")
    layers = sorted({link.layer for link in links.values() if link.layer is not None})
    levels = _levels(links, parts, layers, spacing, washer)
    return {name: levels[link.layer] if link.layer is not None else link.z or 0.0 for name, link in links.items()}


def plates_apart(link: Link, spacing: float | None) -> float | None:
    """Return the distance of the mid-planes of a pair's plates: stated, or such that its mate lies between them.

    Parameters
    ----------
    link : Link
    spacing : float or None
        Of the case's layers [mm].

    Returns
    -------
    float or None
        [mm]; None for a link that is no pair, and where it does not follow.
    """
    if link.count == 1 or link.apart is not None or spacing is None:
        return link.apart
    return 2.0 * spacing


def layer_of(links: Iterable[str]) -> str:
    """Return the line by which the first link of a case states its layer, as an example.

    Parameters
    ----------
    links : iterable of str
        Their names.

    Returns
    -------
    str
    """
    name = next(iter(links))
    plain = name.isascii() and " " not in name and "+" not in name
    return f"links.{name if plain else json.dumps(name, ensure_ascii=False)}.layer = 0"


def _levels(
    links: Links, parts: Parts, layers: list[int], spacing: float | None, washer: float | None
) -> dict[int, float]:
    """Return layer -> its height."""
    if spacing is not None and spacing > 0.0 and washer is not None:
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
        thick = _thickness_of({name: link for name, link in links.items() if link.layer == layer}, parts)
        level += 0.0 if below is None else below / 2.0 + washer + thick / 2.0
        found[layer], below = level, thick
    return found


def _thickness_of(links: Links, parts: Parts) -> float:
    """Return the height along the pins of the thickest of the links of a layer."""
    known = [found + (link.apart or 0.0) for link in links.values() if (found := thickness(link, parts)) is not None]
    if not known:
        raise CaseError(
            f"links.{next(iter(links))}.thickness: how high the link is along the pins does not follow from its part, "
            'but washers between layers need it; state it, for example "3 mm", or layer_spacing in place of washer'
        )
    return max(known)


def thickness(link: Link, parts: Parts) -> float | None:
    """Return the height along the pins that a link takes up; of a pair, that of one plate.

    Parameters
    ----------
    link : Link
    parts : mapping of str to Part

    Returns
    -------
    float or None
        [mm]; None where the link neither states it nor has a part of a shape of alula's own.
    """
    part = None if link.part is None else parts.get(link.part)
    if link.thickness is not None or part is None or isinstance(part, FilePart):
        return link.thickness
    eyes = [eye.thickness for eye in link.eyes.values() if eye.thickness is not None]
    return max(part.eye_thickness, 2.0 * part.section.half_z, *eyes, 0.0)
