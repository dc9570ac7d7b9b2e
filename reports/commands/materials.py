"""``alula materials``: the cards of the library, as a table, one by one, as TOML to paste, as JSON or Markdown."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from alula.geometry.materials.material import Material

app = typer.Typer()
_COLUMNS = (
    ("name", False),
    ("material", False),
    ("density\n[kg/m³]", True),
    ("E\n[GPa]", True),
    ("Poisson's\nratio ν", True),
    ("strength\n[MPa]", True),
    ("across layers\n[MPa]", True),
    ("least safety\nfactor n", True),
    ("assumed", False),
    ("missing", False),
)
_SHORT = {
    "density": "density",
    "youngs_modulus": "E",
    "poissons_ratio": "ν",
    "yield_strength": "yield strength",
    "ultimate_strength": "ultimate strength",
    "ultimate_strength_by_diameter": "strength by diameter",
    "strength_across_layers": "strength across layers",
    "shear_strength_between_layers": "shear between layers",
}


@app.command()
def materials(
    name: Annotated[
        str | None, typer.Argument(help="A card to show whole; default: list all.", show_default=False)
    ] = None,
    card: Annotated[
        bool, typer.Option("--card", help="Print the named card as TOML, to paste into a case and edit.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the cards as JSON.")] = False,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print the list as a table of Markdown.")] = False,
) -> None:
    """List the material library: values, sources, what is assumed and what is missing."""
    from alula.geometry.base.errors import CaseError
    from alula.geometry.materials.directional import directional
    from alula.geometry.materials.material import library
    from alula.loads.text.explain import require

    if name is not None:
        if why := directional(name):
            raise CaseError(f"materials: '{name}' {why}")
        require("materials", name, library(), "is not in the library")
    if card:
        if name is None:
            raise CaseError("--card: it needs the name of a card; alula materials lists them")
        print(card_text(name), end="")
    elif json:
        print(_as_json(name))
    elif markdown:
        print(as_markdown(), end="")
    else:
        _print(name)


def missing(material: "Material") -> tuple[str, ...]:
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


def card_text(name: str) -> str:
    """Return a card of the library as TOML under ``[materials.NAME]``, as a case states it.

    Parameters
    ----------
    name : str
        Of a card in the library.

    Returns
    -------
    str
        Its lines as they stand in the library.
    """
    from alula.geometry.materials.material import library_text

    lines, inside = [], False
    for line in library_text().splitlines():
        if line.startswith("["):
            inside = line.strip("[]").split(".")[0] == name
            line = f"[materials.{line[1:]}"
        if inside and line:
            lines.append(line)
    return "\n".join(lines) + "\n"


def as_markdown() -> str:
    """Return the list of the library as a table of Markdown."""
    heads = [head.replace("\n", " ") for head, _ in _COLUMNS]
    rule = ["--:" if right else "---" for _, right in _COLUMNS]
    return "".join(f"| {' | '.join(row)} |\n" for row in (heads, rule, *_rows()))


def _rows() -> list[tuple[str, ...]]:
    from alula.geometry.materials.material import library

    return [_row(name, material) for name, material in library().items()]


def _row(name: str, material: "Material") -> tuple[str, ...]:
    from alula.reports.words.numbers import plain

    across, least = material.strength_across_layers, material.minimum_safety_factor
    assumed = [_SHORT.get(entry, entry) for entry, status in material.status.items() if status == "assumed"]
    return (
        name,
        material.title,
        plain(float(f"{1e12 * material.density:.6g}")),
        plain(float(f"{1e-3 * material.youngs_modulus:.6g}")),
        plain(material.poissons_ratio),
        f"{material.strength} {plain(material.allowable)}",
        "–" if across is None else plain(across),
        "–" if least is None else plain(least),
        ", ".join(assumed) or "–",
        ", ".join(missing(material)) or "–",
    )


def _print(name: str | None) -> None:
    from rich.console import Console

    from alula.geometry.materials.material import library
    from alula.reports.words.terminal import say, say_table

    console = Console()
    if name is None:
        say_table(console, _COLUMNS, _rows())
        say(console, "Strength is that of the safety factor n: yield against von Mises stress, ultimate against the "
                     "largest principal stress. alula materials NAME shows a card with its sources.")  # fmt: skip
        return
    material, stated = library()[name], _raw()[name]
    say(console, f"{name}: {material.title}", style="bold")
    sources, status = stated.pop("sources"), stated.pop("status")
    rows = []
    for entry, value in stated.items():
        if isinstance(value, dict):
            rows += [(f"{entry}.{key}", str(x), "", "") for key, x in value.items() if key != "source"]
            rows.append((entry, "", "", value["source"]))
        elif entry != "title":
            rows.append((entry, _text(value), status.get(entry, ""), sources.get(entry, "")))
    say_table(console, [("entry", False), ("value", False), ("status", False), ("source", False)], rows)
    say(console, f"Missing: {', '.join(missing(material)) or 'nothing'}.")
    say(console, f"alula materials --card {name} prints it as TOML, to paste into a case and edit.")


def _text(value: Any) -> str:
    """Return a value of a card in words: a range as "a to b", a table of pairs as "at a: b"."""
    if not isinstance(value, list):
        return str(value)
    if isinstance(value[0], list):
        return "; ".join(f"{at}: {x}" for at, x in value)
    return " to ".join(map(str, value))


def _raw() -> dict[str, Any]:
    import tomllib

    from alula.geometry.materials.material import library_text

    return tomllib.loads(library_text())


def _as_json(name: str | None) -> str:
    """Return the cards as they are stated, with their units, and what each lacks."""
    import json

    from alula.geometry.base.version import result_stamp
    from alula.geometry.materials.material import library

    cards = {one: card | {"missing": missing(library()[one])} for one, card in _raw().items() if name in (None, one)}
    return json.dumps({**result_stamp(), "materials": cards}, indent=2, ensure_ascii=False)
