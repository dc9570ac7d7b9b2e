"""What the library of materials states: all cards in a table, or one whole with its sources."""

import tomllib
from typing import Any

from alula.geometry.materials.material import Material, library, library_text
from alula.reports.sections.section import Cell, Column, Command, Number, Section, Table, Text, words

_SHORT = {
    "density": "density",
    "youngs_modulus": "E",
    "poissons_ratio": "ν",
    "yield_strength": "yield strength",
    "ultimate_strength": "ultimate strength",
    "ultimate_strength_by_diameter": "strength by diameter",
    "inherent_strength": "inherent strength",
    "fracture_toughness": "fracture toughness",
    "strength_across_layers": "strength across layers",
    "shear_strength_between_layers": "shear between layers",
}


def library_section() -> Section:
    """Return the cards of the library, one a row."""
    told = (
        "Strength is that of the safety factor n: yield against von Mises stress, ultimate against the largest "
        "principal stress. alula materials NAME shows a card with its sources."
    )
    return Section(key="library", title="Materials", parts=(library_table(), Text(told)), data={"materials": _cards()})


def library_table() -> Table:
    """Return what the cards of the library state, and what they assume and lack."""
    columns = (
        *map(words, ("name", "material")),
        Column("density", "kg/m³"),
        Column("E", "GPa"),
        Column("Poisson's ratio ν"),
        Column("strength", "MPa"),
        Column("across layers", "MPa"),
        Column("least safety factor n"),
        *map(words, ("assumed", "missing")),
    )
    return Table(columns=columns, rows=tuple(_row(name, card) for name, card in library().items()))


def _row(name: str, card: Material) -> tuple[Cell, ...]:
    assumed = [_SHORT.get(entry, entry) for entry, status in card.status.items() if status == "assumed"]
    return (
        name,
        card.title,
        Number(card.density, stated=True, factor=1e12),
        Number(card.youngs_modulus, stated=True, factor=1e-3),
        Number(card.poissons_ratio, stated=True),
        f"{card.strength} {Number(card.allowable, stated=True)}",
        Number(card.strength_across_layers, stated=True),
        Number(card.minimum_safety_factor, stated=True),
        ", ".join(assumed) or "–",
        ", ".join(missing(card)) or "–",
    )


def card_section(name: str) -> Section:
    """Return a card of the library with the sources of its entries.

    Parameters
    ----------
    name : str
        Of a card in the library.

    Returns
    -------
    Section
    """
    card, stated = library()[name], tomllib.loads(library_text())[name]
    sources, status = stated.pop("sources"), stated.pop("status")
    rows = []
    for entry, value in stated.items():
        if isinstance(value, dict):
            rows += [(f"{entry}.{key}", str(x), "", "") for key, x in value.items() if key != "source"]
            rows.append((entry, "", "", value["source"]))
        elif entry != "title":
            rows.append((entry, _text(value), status.get(entry, ""), sources.get(entry, "")))
    parts = (
        Table(columns=tuple(map(words, ("entry", "value", "status", "source"))), rows=tuple(rows)),
        Text(f"Missing: {', '.join(missing(card)) or 'nothing'}."),
        Command("As TOML, to paste into a case and edit:", f"alula materials --card {name}"),
    )
    return Section(key="card", title=f"{name}: {card.title}", parts=parts, data={"materials": _cards(name)})


def missing(material: Material) -> tuple[str, ...]:
    """Return what a card does not tell, in words.

    Parameters
    ----------
    material : Material
        The card.

    Returns
    -------
    tuple of str
        Such as ``"fatigue"``.
    """
    lasting = material.sustained_stress is None or material.sustained_modulus is None
    layers = material.strength_across_layers is not None and material.shear_strength_between_layers is None
    lacking = {
        "fatigue": material.fatigue is None,
        "sustained load": lasting,
        "temperature": not (material.temperature_factors and material.modulus_temperature_factors),
        "scatter of strength": material.strength_range is None,
        "scatter of E": material.youngs_modulus_range is None,
        "shear between layers": layers,
        "fatigue of layers": material.strength_across_layers is not None and material.fatigue_across_layers is None,
        "least safety factor": material.minimum_safety_factor is None,
    }
    return tuple(what for what, absent in lacking.items() if absent)


def _text(value: Any) -> str:
    """Return a value of a card in words: a range as "a to b", a table of pairs as "at a: b"."""
    if not isinstance(value, list):
        return str(value)
    if isinstance(value[0], list):
        return "; ".join(f"{at}: {x}" for at, x in value)
    return " to ".join(map(str, value))


def _cards(name: str | None = None) -> dict[str, Any]:
    """Return the cards as they are stated, with their units, and what each lacks."""
    stated = tomllib.loads(library_text())
    return {one: card | {"missing": missing(library()[one])} for one, card in stated.items() if name in (None, one)}
