"""Inputs by mutation of every case that ships and of linkages of other programs, fast, and repeatable by their seed.

Every second one keeps to the grammar (``fuzz.grammar``), the others do not (``fuzz.mutate``).

python -m fuzz.mutations TARGET INPUTS SEED FOLDER
"""

import random
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fuzz import grammar, guard, mutate, targets
from fuzz.findings import Findings


def inputs_of(name: str, rng: random.Random) -> Callable[[], Any]:
    """Return what makes an input of a target anew at every call."""
    if name in ("pylinkage", "pmks"):
        texts = targets.linkages(name)
        changed = mutate.json_text if name == "pylinkage" else mutate.code
        return lambda: changed(rng, rng.choice(texts))
    cases = [(text.encode(), tomllib.loads(text)) for text in targets.seeds().values()]

    def one() -> Any:
        (text, tables), keeping = rng.choice(cases), rng.random() < 0.5
        if name == "case_tables":
            return (grammar if keeping else mutate).tables(rng, tables)
        return grammar.case(rng, tables) if keeping else mutate.text(rng, text)

    return one


def try_many(name: str, inputs: int, start: int, findings: Findings) -> None:
    """Try so many mutations of what ships."""
    make = inputs_of(name, random.Random(start))
    while findings.tried < inputs and not findings.full:
        findings.tried += 1
        data = make()
        try:
            findings.accepted += targets.TARGETS[name](data)
        except KeyboardInterrupt:
            raise
        except BaseException as fault:
            findings.keep(data, fault)


def main(name: str, inputs: str, start: str, folder: str) -> None:
    """Try, and write what was found."""
    targets.warm()
    guard.install()
    findings = Findings(engine="mutation", target=name, folder=Path(folder))
    try_many(name, int(inputs), int(start), findings)
    findings.write()
    targets.clean()


if __name__ == "__main__":
    main(*sys.argv[1:])
