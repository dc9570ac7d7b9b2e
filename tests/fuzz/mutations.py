"""Inputs by mutation of every case that ships, without guidance: fast, and repeatable by its seed.

Every second one keeps to the grammar (``fuzz.grammar``), the others do not (``fuzz.mutate``).

python -m fuzz.mutations TARGET INPUTS SEED FOLDER
"""

import random
import sys
import tomllib
from pathlib import Path
from typing import Any

from fuzz import grammar, guard, mutate, targets
from fuzz.findings import Findings


def try_many(name: str, inputs: int, start: int, findings: Findings) -> None:
    """Try so many mutations of the shipped cases' tables or text."""
    rng = random.Random(start)
    texts = [text.encode() for text in targets.seeds().values()]
    tables = [tomllib.loads(text.decode()) for text in texts]
    while findings.tried < inputs and not findings.full:
        findings.tried += 1
        i, keeping = rng.randrange(len(tables)), rng.random() < 0.5
        if name == "case_tables":
            data: Any = (grammar if keeping else mutate).tables(rng, tables[i])
        else:
            data = grammar.case(rng, tables[i]) if keeping else mutate.text(rng, texts[i])
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
