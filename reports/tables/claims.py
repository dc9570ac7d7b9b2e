"""Findings on published figures, for the terminal, as JSON, and as a page of Markdown."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence

from alula.fea.claims.audit import ClaimResult, Finding

LONGEST_TABLE = 300
"""Claims of one source beyond which its page lists those alone that do not hold."""
_WORDS = {
    Finding.HOLDS: "holds",
    Finding.DOES_NOT_HOLD: "does not hold",
    Finding.DOES_NOT_FOLLOW: "does not follow",
    Finding.CANNOT_BE_REDERIVED: "cannot be re-derived",
}


def count(results: Sequence[ClaimResult]) -> str:
    """Return the number of claims of each finding, in one sentence.

    Parameters
    ----------
    results : sequence of ClaimResult

    Returns
    -------
    str
    """
    found = Counter(result.finding for result in results)
    several = {
        Finding.HOLDS: "hold",
        Finding.DOES_NOT_HOLD: "do not hold",
        Finding.DOES_NOT_FOLLOW: "do not follow",
        Finding.CANNOT_BE_REDERIVED: "cannot be re-derived",
    }
    words = ", ".join(f"{found[kind]} {(_WORDS if found[kind] == 1 else several)[kind]}" for kind in _WORDS)
    return f"{len(results)} {'claim' if len(results) == 1 else 'claims'}: {words}."


def as_records(results: Sequence[ClaimResult]) -> list[dict[str, str | None]]:
    """Return the findings as plain data.

    Parameters
    ----------
    results : sequence of ClaimResult

    Returns
    -------
    list of dict
        Entries name, quantity, published, ours, finding, source, note.
    """
    return [
        {
            "name": result.claim.name,
            "quantity": result.claim.quantity or result.claim.stated,
            "published": result.claim.published,
            "ours": result.ours,
            "finding": result.finding.value,
            "source": result.claim.source,
            "note": result.note,
        }
        for result in results
    ]


def as_json(results: Sequence[ClaimResult]) -> str:
    """Return the findings as a JSON list.

    Parameters
    ----------
    results : sequence of ClaimResult

    Returns
    -------
    str
    """
    return json.dumps(as_records(results), indent=2, ensure_ascii=False)


def as_text(results: Sequence[ClaimResult]) -> str:
    """Return the findings for the terminal: one line per claim, its sentence below, the counts at the end.

    Parameters
    ----------
    results : sequence of ClaimResult

    Returns
    -------
    str
    """
    lines = []
    for result in results:
        ours = "" if result.ours is None else f", ours {result.ours}"
        lines.append(f"{_WORDS[result.finding]:<21}{result.claim.name}: published {result.claim.published}{ours}")
        lines.append(f"{'':<21}{result.note}")
    return "\n".join([*lines, *([""] if lines else []), count(results)])


def as_markdown(found: Mapping[str, Sequence[ClaimResult]], titles: Mapping[str, str]) -> str:
    """Return a Markdown page with the counts and a table of findings per source.

    Parameters
    ----------
    found : mapping
        Findings by name of the source.
    titles : mapping
        What each source is called.

    Returns
    -------
    str
    """
    lines = [
        "# Published figures, re-derived",
        "",
        "Made by `alula claims --markdown`. A figure *holds* where it is re-derived within its printed digits or a "
        "stated tolerance; it *does not hold* where another number comes out; it *does not follow* where the source's "
        "own figures give another number; it *cannot be re-derived* where the source leaves out what it needs, which "
        "is not the same as wrong.",
        "",
        "| source | claims | " + " | ".join(_WORDS.values()) + " |",
        "|---" * (2 + len(_WORDS)) + "|",
    ]
    for name, results in found.items():
        kinds = Counter(result.finding for result in results)
        lines.append(f"| `{_cell(name)}` | {len(results)} | " + " | ".join(str(kinds[kind]) for kind in _WORDS) + " |")
    for name, results in found.items():
        lines += ["", f"## {_cell(titles[name])}", "", count(results)]
        shown = list(results)
        if len(shown) > LONGEST_TABLE:
            shown = [result for result in shown if result.finding is not Finding.HOLDS]
            lines.append(f"Listed are those that do not hold; `alula claims {name}` lists all.")
        lines += ["", "| claim | published | ours | finding | |", "|---|---|---|---|---|"]
        lines += [
            f"| {result.claim.name} | {_cell(result.claim.published)} | {_cell(result.ours or '')} "
            f"| {_WORDS[result.finding]} | {_cell(result.note)} |"
            for result in shown
        ]
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    plain = " ".join(text.split()).replace("&", "&amp;").replace("<", "&lt;")
    return plain.replace("|", "\\|").replace("*", "\\*")
