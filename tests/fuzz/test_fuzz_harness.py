"""The fuzzing harness sees what it is there to see, and a few inputs of every kind pass it on every run of the tests.

In children, since the audit hook stays for the life of a process. ``make fuzz`` tries a million.
"""

import json
import subprocess
import sys
from pathlib import Path

import programs

# What a target could do that none may.
SINS = {
    "writes a file": "open(FOLDER + '/x', 'w')",
    "reads a file of the system": "open('/etc/passwd')",
    "evaluates code": "eval('1 + 1')",
    "imports a module": "import colorsys",
    "starts a program": "import subprocess; subprocess.run(['true'])",
    "removes a file": "os.remove(FOLDER + '/none')",
    "hangs": "while True: pass",
    "swallows it": "try:\n    open('/etc/passwd')\nexcept BaseException:\n    pass",
    "complains": "import warnings; warnings.warn('x')",
    "has a fault": "raise ValueError('x')",
    "says nothing": "targets._told(targets.CaseError(''))",
    "says control characters": "targets._told(targets.CaseError('\\x1b[2J'))",
}
SINNER = """
import json, os, sys, warnings
FOLDER = sys.argv[1]
from fuzz import guard, targets
def virtue():
    pass
sins = {"virtue": virtue}
exec(sys.argv[2])
guard.install()
seen = {}
for name, sin in sins.items():
    try:
        with guard.watched():
            sin()
    except BaseException as error:
        seen[name] = f"{type(error).__name__} {error}"
print(json.dumps(seen))
"""
FEW = """
import sys
from pathlib import Path
from fuzz import guard, mutations, properties, targets
from fuzz.findings import Findings
targets.warm()
guard.install()
for engine, name, inputs in (
    (mutations, "case_tables", 150), (mutations, "case_bytes", 100), (properties, "override", 50),
    (mutations, "pylinkage", 100), (mutations, "pmks", 100),
    (properties, "expression", 100), (properties, "claim", 50), (properties, "quantity", 50),
    (properties, "companion", 25), (properties, "varied", 50), (properties, "case_tables", 25),
):
    findings = Findings(engine=engine.__name__, target=name, folder=Path(sys.argv[1]))
    engine.try_many(name, inputs, 7, findings)
    assert findings.tried >= inputs
    findings.write()
targets.clean()
"""


def child(*arguments: str) -> subprocess.CompletedProcess[str]:
    paths = f"{programs.ROOT}:{programs.ROOT / 'tests'}"
    return subprocess.run(
        [sys.executable, "-c", *arguments],
        env=programs.environment(PYTHONPATH=paths),
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_the_guard_sees_every_sin_and_no_virtue(tmp_path: Path) -> None:
    written = []
    for i, (name, body) in enumerate(SINS.items()):
        lines = "\n".join(f"    {line}" for line in body.splitlines())
        written.append(f"def sin{i}():\n{lines}\nsins[{name!r}] = sin{i}\n")
    done = child(SINNER, str(tmp_path), "".join(written))
    assert done.returncode == 0, done.stderr
    assert set(json.loads(done.stdout)) == set(SINS)


def test_a_few_inputs_of_every_kind(tmp_path: Path) -> None:
    done = child(FEW, str(tmp_path))
    assert done.returncode == 0, done.stderr
    records = [json.loads(path.read_text()) for path in tmp_path.iterdir()]
    assert len(records) == 11
    assert [record["faults"] for record in records if record["faults"]] == []


UNKNOWN = """
import tomllib
from fuzz import guard
from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import read_text, validate
from alula.loads.plans.plan import StudyPlan
from alula.loads.text.entries import known_keys
tables = tomllib.loads(read_text("ornithopter")[0])
known_keys(StudyPlan, ())  # pydantic imports what it needs for schemas with the first of them
guard.install()
with guard.watched():
    try:
        validate(tables | {"ornithopter": tables["ornithopter"] | {"gera": 1}})
    except CaseError as error:
        print(error)
"""


def test_an_unknown_entry_is_told_without_a_look_into_the_sources() -> None:
    """The schema behind the message parsed the program's own source, which compiled modules do not have."""
    done = child(UNKNOWN)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("ornithopter.gera: "), done.stdout
