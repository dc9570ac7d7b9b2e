"""A case with tables of its own added, which ``--set`` does not do."""

import tomllib
from collections.abc import Sequence
from typing import Any

from geometry.mechanisms.ornithopter import OrnithopterRules
from loads.case.case import Case
from loads.case.case_file import read_text, validate
from loads.case.ornithopter_case import ornithopter_settings


def edited(name: str, entries: Sequence[str]) -> Case:
    """Return a case with entries ``path=value`` as if its file had been edited: missing tables are added."""
    data = tomllib.loads(read_text(name)[0])
    rules = OrnithopterRules.model_validate(data["ornithopter"]) if "ornithopter" in data else None
    for entry in (*(ornithopter_settings(rules) if rules else ()), *entries):
        path, _, text = entry.partition("=")
        try:
            value = tomllib.loads(f"value = {text}")["value"]
        except tomllib.TOMLDecodeError:
            value = text
        here: Any = data
        *above, last = path.strip().split(".")
        for key in above:
            here = here[int(key)] if isinstance(here, list) else here.setdefault(key, {})
        here[int(last) if isinstance(here, list) else last] = value
    return validate(data)
