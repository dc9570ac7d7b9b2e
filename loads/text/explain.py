"""What is wrong with a case file, in one sentence: entry, value, rule, remedy."""

from collections.abc import Collection
from typing import Any

from pydantic import BaseModel, ValidationError

from alula.geometry.base.errors import CaseError
from alula.loads.text.entries import alike, known_keys, of_another_kind

_TABLE = "it must be a table of entries; write it as [{entry}] with one entry per line below"
_LIST = "it must be a list of values in square brackets; write for example {example}"
_RULES = {
    "string_type": "it must be text; write it in double quotes",
    "dict_type": _TABLE,
    "model_type": _TABLE,
    "model_attributes_type": _TABLE,
    "tuple_type": _LIST,
    "bool_type": "it must be true or false; write one of them without quotes",
    "bool_parsing": "it must be true or false; write one of them without quotes",
    "int_type": "it must be a whole number; write for example 5",
    "int_parsing": "it must be a whole number; write for example 5",
    "int_from_float": "it must be a whole number; write for example 5",
    "float_type": "it must be a number without unit; write for example 1.5",
    "float_parsing": "it must be a number without unit; write for example 1.5",
    "finite_number": "it must be a finite number; write for example 1.5",
    "greater_than": "it must be greater than {gt:g}; make it larger",
    "greater_than_equal": "it must be at least {ge:g}; make it larger",
    "less_than": "it must be less than {lt:g}; make it smaller",
    "less_than_equal": "it must be at most {le:g}; make it smaller",
    "literal_error": "it must be one of {expected}; choose one of them",
    "too_short": "it has {actual_length}, but at least {min_length} must be there; add what is missing",
    "string_too_long": "it must have at most {max_length} characters; write less",
    "too_long": "it must hold at most {max_length}, but holds more; remove some",
    "not_positive": "it must be greater than zero; make it larger",
    "negative": "it must not be negative; write zero or more",
}
_ENDS = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
"""What pydantic calls NaN as well."""
_WRITTEN = {
    "sources": 'sources = { density = "data sheet of its maker" }, for each value where it comes from',
    "status": 'status = { density = "datasheet" }, for each value "measured", "datasheet", "handbook" or "assumed"',
}
"""Tables that a material's card must have and whose form is not plain from their names -> the line to write."""
_LISTED = 20
"""Missing entries that one sentence lists."""


def printable(text: str) -> str:
    """Make text fit for a message.

    Parameters
    ----------
    text : str
        What a user wrote.

    Returns
    -------
    str
        At most 80 characters, with a question mark for each that does not print.
    """
    clean = _clean(text)
    return clean if len(clean) <= 80 else clean[:77] + "..."


def require(entry: str, name: str | None, known: Collection[str], rule: str, remedy: str = "") -> None:
    """Check that a name is among those that may stand there.

    Parameters
    ----------
    entry : str
        Path of the entry, for the message.
    name : str or None
        What stands there.
    known : collection of str
        The names that may.
    rule : str
        What is wrong with any other, such as ``"is not a moving link"``.
    remedy : str, optional
        What may be done besides choosing one of them.

    Raises
    ------
    CaseError
        With the entry, the name, the rule and the names that are known.
    """
    if name not in known:
        choice = f"choose one of {', '.join(known) or 'none'}"
        raise CaseError(f"{entry}: '{printable(str(name))}' {rule}; {choice}{' ' if remedy else ''}{remedy}")


def sentence(error: ValidationError, model: type[BaseModel], whole: str = "case") -> str:
    """Put the first problem of a validation into one sentence: entry, value, rule, remedy.

    What is wrong comes before what is missing: a mistyped key leaves an entry missing. Where one is missing, all that
    are missing are told.

    Parameters
    ----------
    error : ValidationError
        What pydantic found.
    model : type of BaseModel
        What was validated.
    whole : str, optional
        What all of it is called.

    Returns
    -------
    str
        The sentence.
    """
    try:
        problems = error.errors(include_url=False)
    except UnicodeEncodeError:  # pydantic itself cannot quote it
        return "case: a text in it holds half of a surrogate pair, which is no character; remove it"
    # A default that needs another entry is no problem of its own: that entry's is told.
    problems = [problem for problem in problems if problem["type"] != "default_factory_not_called"] or problems
    first = next((one for one in problems if one["type"] not in ("missing", "too_short")), problems[0])
    kind, place, value = first["type"], _place(first["loc"]), first["input"]
    context: dict[str, Any] = dict(first.get("ctx", {}))
    meant = other = ""
    if kind == "extra_forbidden":
        above = first["loc"][:-1]
        other = of_another_kind(model, above, str(place[-1])) if above else ""
        meant = alike(str(place[-1]), known_keys(model, above) or known_keys(model, _place(above)))
    if kind.startswith("union_tag"):
        # A part, check or the like whose kind decides what else belongs to it.
        place = (*place, context["discriminator"].strip("'"))
        if kind == "union_tag_not_found":
            kind = "missing"
            for key in value if isinstance(value, dict) else ():
                if meant := alike(str(key), (str(place[-1]),)):
                    kind, place = "extra_forbidden", (*place[:-1], str(key))
                    break
        else:
            kind, value = "literal_error", context["tag"]
            context["expected"] = context["expected_tags"]
    if kind == "missing" and isinstance(place[-1], int):
        kind, place = "too_few_values", place[:-1]
    entry = printable(".".join(map(str, place))) or whole
    if kind in _ENDS and str(value).strip().lower().endswith("nan"):
        kind = "float_type"
    if kind == "extra_forbidden":
        rule = f"{other}; remove it" if other else "this key is unknown" + (meant or "; correct its name or remove it")
    elif kind == "missing":
        lacking = [p["loc"] for p in problems if p["type"] == "missing" and not isinstance(p["loc"][-1], int)]
        listed = list(dict.fromkeys((entry, *(printable(".".join(map(str, _place(loc)))) for loc in lacking))))
        problems = problems[max(len(listed[:_LISTED]) - 1, 0) :]
        entry = ", ".join(listed[:_LISTED])
        rule = "this entry is missing; add it" if len(listed) == 1 else "these entries are missing; add them"
        lines = [_WRITTEN[name] for name in _WRITTEN if any(one.endswith(f".{name}") for one in listed)]
        rule += f": write {'; and '.join(lines)}" if lines else ""
    elif kind == "too_few_values":
        rule = "the list has too few values; add what is missing"
    elif kind in _RULES:
        example = f'["{printable(value)}", ...]' if isinstance(value, str) else f"[{value!r}, ...]"
        example = example if isinstance(value, str | int | float) else '["A", "B"]'
        rule = _RULES[kind].format(**context, entry=entry, example=example)
    else:
        rule = first["msg"]
    more = len(problems) - 1
    also = f" ({more} more problems follow)" if more > 3 else ""
    shown = "" if first["loc"][-1:] == ("[key]",) else _shown(kind, value)
    return _clean(f"{entry}{shown}: {rule}{also}")


def _place(location: tuple[int | str, ...]) -> tuple[int | str, ...]:
    """Where the problem is, as a user would write it.

    Leaves out what pydantic adds: the kind behind the name of a part, check, carried mass or spring,
    and the mark of a key.
    """
    if location and location[0] in ("parts", "checks", "carried", "springs"):
        location = (*location[:2], *location[3:])
    return tuple(part for part in location if part != "[key]")


def _shown(kind: str, value: object) -> str:
    if kind in ("missing", "extra_forbidden") or isinstance(value, dict) or not isinstance(value, _PLAIN):
        return ""
    return f" (it is {printable(repr(value))})"


_PLAIN = (str, int, float, bool, list)


def _clean(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)
