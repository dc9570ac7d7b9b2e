"""What all records of the case file have in common."""

import math
import tomllib
import unicodedata
from collections.abc import Iterable
from functools import cache
from importlib.resources import files
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, WithJsonSchema
from pydantic_core import PydanticCustomError, PydanticKnownError, core_schema

from alula.geometry.base.errors import CaseError

Record = TypeVar("Record", bound="CaseModel")


class CaseModel(BaseModel):
    """A frozen record of the case file: unknown keys, NaN and infinity are refused."""

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        allow_inf_nan=False,
        validate_default=False,
        defer_build=True,  # a case is read by one validator of all its records: most need none of their own
    )

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        """Take for a number or a truth no text that reads like one, and for a truth no number."""
        schema = handler(source)
        _make_strict(schema.get("schema", schema))
        return schema

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: Any, handler: Any) -> dict[str, Any]:
        """Describe each entry by the text that stands below it in the source, as ``entry_texts.toml`` holds it."""
        schema: dict[str, Any] = handler(core_schema)
        entries = handler.resolve_ref_schema(schema).get("properties", {})
        for record in reversed(cls.__mro__):
            for name, text in _entry_texts().get(f"{record.__module__}.{record.__name__}", {}).items():
                field = cls.model_fields.get(name)  # None for what no case file states
                entry = entries.get(field.alias or name) if field is not None and field.description is None else None
                if entry is not None:  # the schema leaves out what no file states
                    entry["description"] = text
        return schema


def _make_strict(schema: Any) -> None:
    """Make numbers and truths of a core schema strict."""
    if isinstance(schema, dict):
        if schema.get("type") in ("bool", "float"):
            schema["strict"] = True
        elif schema.get("type") == "int":  # strict, it would not take 5.0, which is whole
            inner = dict(schema)
            schema.clear()
            schema.update(core_schema.no_info_before_validator_function(_no_text, inner))
            return
        for key, inner in schema.items():
            if key != "metadata":
                _make_strict(inner)
    elif isinstance(schema, list | tuple):
        for inner in schema:
            _make_strict(inner)


def _no_text(value: object) -> object:
    if isinstance(value, str | bool):
        raise PydanticKnownError("int_type")
    return value


@cache
def _entry_texts() -> dict[str, dict[str, str]]:
    """Return the texts below the entries of all records, by the records' full names."""
    return tomllib.loads(files("alula.geometry.base").joinpath("entry_texts.toml").read_text(encoding="utf-8"))


def refusal(rule: str) -> PydanticCustomError:
    """Return the error by which a validator of a record refuses its input; a message puts the entry before it.

    Parameters
    ----------
    rule : str
        What is wrong, and the remedy.

    Returns
    -------
    PydanticCustomError
        To be raised.
    """
    return PydanticCustomError("rule", "{rule}", {"rule": rule})


def one_of(record: Record, one: str, other: str) -> Record:
    """Require that exactly one of two entries is stated.

    Parameters
    ----------
    record : CaseModel
    one, other : str
        The entries.

    Returns
    -------
    CaseModel
        The record.
    """
    if (getattr(record, one) is None) == (getattr(record, other) is None):
        raise refusal(f"it needs either {one} or {other}; state one of the two, and not both")
    return record


def _name(text: str) -> str:
    letters = all(c.isalnum() or c in "-_+ " for c in text)
    short = len(text) <= 64 and len(text.encode(errors="replace")) <= 200  # files are named after it
    if not (text and short and text[0].isalnum() and letters and text[-1] != " "):
        raise PydanticCustomError(
            "bad_name",
            "a name is made of letters, digits, '-', '_', '+' and spaces, begins with a letter or a digit, "
            "ends without a space and has at most 64 characters (200 bytes in UTF-8); rename it",
        )
    return text


def _text(text: str) -> str:
    # Control characters would reach the terminal, where they can move the cursor or clear the screen; halves of
    # a pair of surrogates cannot be written to any file.
    if any(unicodedata.category(c) in ("Cc", "Cs") and c not in "\n\t" for c in text):
        raise PydanticCustomError("control_character", "text must not hold control characters; remove them")
    return text


def _stated(text: str) -> str:
    if not text.strip():
        raise refusal("it must not be empty; write what it is, in a few words")
    return text


def _direction(value: tuple[float, float, float]) -> tuple[float, float, float]:
    if not any(value):
        raise PydanticCustomError("no_direction", "a direction has three numbers, not all zero; write [0, 0, 1]")
    largest = max(map(abs, value))
    x, y, z = (component / largest for component in value)
    length = math.hypot(x, y, z)
    return x / length, y / length, z / length


Direction = Annotated[tuple[float, float, float], AfterValidator(_direction)]
"""A vector of any length, without unit; kept with unit length."""
Name = Annotated[str, AfterValidator(_name), WithJsonSchema({"type": "string", "format": "name"})]
Text = Annotated[str, AfterValidator(_text)]
Stated = Annotated[Text, AfterValidator(_stated), WithJsonSchema({"type": "string", "pattern": r"\S"})]
"""Text that is not empty."""


def check_file_names(entry: str, names: Iterable[str]) -> None:
    """Refuse two names whose files some disks take for one: alike but for case or composition.

    Parameters
    ----------
    entry : str
        Entry of the case file that holds the names, for the message.
    names : iterable of str
        The names.

    Raises
    ------
    CaseError
        With the first two such names.
    """
    seen: dict[str, str] = {}
    for name in names:
        other = seen.setdefault(unicodedata.normalize("NFC", unicodedata.normalize("NFC", name).casefold()), name)
        if other != name:
            raise CaseError(
                f"{entry}: '{other}' and '{name}' differ in case alone, and some disks take the files named after them "
                "for one; rename one of them"
            )
