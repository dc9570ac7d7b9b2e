"""Inputs by atheris (libFuzzer): what reaches new branches of the reading and validating code is kept and mutated on.

python -m fuzz.guided TARGET INPUTS SEED FOLDER
"""

import os
import random
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import atheris

with atheris.instrument_imports(include=["alula.geometry", "alula.loads", "tomllib"]):
    from fuzz import targets

from fuzz import grammar, guard, mutate
from fuzz.findings import Findings

_WORDS = {
    "expression": (
        "1 N/mm^2",
        "sqrt(4 m^2)",
        "given.x",
        "below(1, 2)",
        "atan2(1 N, 2 N)",
        "2**0.5",
        "word",
        "pi",
        "-(1 + 2)*3",
    ),
    "quantity": ("1 mm", "-2.5e3 kg/m^3", "30 deg", "23 degC", "1 N·mm", "10 year", "9.81 m/s^2", "3500 rpm"),
    "claim": ("0.9520 N", "5.027e-5 N", "1 %", "0.1 mm", "open", "12.0", "sqrt(4 m^2)"),
    "override": (
        'pose.angle="30 deg"',
        'joints.A.pin_diameter="2 mm"',
        "joints.A.friction=0.3",
        'load_cases.weight.forces.0.at="B"',
        "motion={turn=true}",
        "solid.mesh_size=2",
    ),
}
LONGEST = {"expression": 520, "quantity": 80, "claim": 520, "override": 200, "case_bytes": 16_384}


def _seeded(name: str) -> list[bytes]:
    if name == "case_bytes":
        return [text.encode() for text in targets.seeds().values()]
    return [word.encode() for word in _WORDS[name]]


def _kept(rng: random.Random, data: bytes) -> bytes:
    """Return a case changed within its grammar; one that is none no longer gives way to a whole one."""
    try:
        tables = tomllib.loads(data.decode())
        return grammar.case(rng, tables) if tables else data
    except (ValueError, RecursionError):
        return rng.choice(list(targets.seeds().values())).encode()


def main(name: str, inputs: str, start: str, folder: str) -> None:
    """Try, and write what was found."""
    targets.warm()
    guard.install()
    target, most = targets.TARGETS[name], int(inputs)
    Path(folder).mkdir(parents=True, exist_ok=True)
    corpus = tempfile.mkdtemp(prefix="alula-corpus-")
    findings = Findings(engine="atheris", target=name, folder=Path(folder))

    def one(data: bytes) -> None:
        found: Any = data if name == "case_bytes" else data.decode("utf-8", "surrogateescape")
        findings.tried += 1
        try:
            findings.accepted += target(found)
        except KeyboardInterrupt:
            raise
        except BaseException as fault:
            findings.keep(found, fault)
        # libFuzzer ends the process itself, so the record is written before it can.
        if findings.tried >= most or findings.full:
            findings.write()
            targets.clean()
            shutil.rmtree(corpus, ignore_errors=True)
            sys.stdout.flush()
            os._exit(0)

    def mutated(data: bytes, max_size: int, number: int) -> bytes:
        rng = random.Random(number)
        kind = rng.random()
        if kind < 0.2:
            return bytes(atheris.Mutate(data, max_size))
        if name == "case_bytes":
            return (mutate.text(rng, data) if kind < 0.4 else _kept(rng, data))[:max_size]
        if name == "override" and kind < 0.6:
            return grammar.override(rng, targets.starter_tables()).encode("utf-8", "surrogateescape")[:max_size]
        text = data.decode("utf-8", "surrogateescape")
        return grammar.text(rng, text).encode("utf-8", "surrogateescape")[:max_size]

    for i, seed in enumerate(_seeded(name)):
        (Path(corpus) / str(i)).write_bytes(seed)
    # Its own time limit is wall time on a busy machine; the guard's is processor time.
    options = [
        f"-max_len={LONGEST[name]}",
        f"-seed={start}",
        "-timeout=120",
        "-rss_limit_mb=4096",
        "-verbosity=0",
        "-print_final_stats=0",
        "-len_control=0",
        f"-artifact_prefix={folder}/",
    ]
    arguments = [sys.argv[0], *options, corpus]
    atheris.Setup(arguments, one, custom_mutator=mutated)
    atheris.Fuzz()


if __name__ == "__main__":
    main(*sys.argv[1:])
