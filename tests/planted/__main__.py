"""Plant the kept mistakes one at a time and tell which tests notice: ``python -m planted [--all] [WORD ...]``.

With words, only mistakes whose kind, file or sentence has one of them. Each is planted in a copy of the checkout in a
temporary folder and taken out again. Exit status 1 if one goes unnoticed, or if a test that a table names does not
notice it. With ``--all`` the whole suite runs instead of the named tests: some ten minutes for each mistake.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from planted.mistakes import ROOT, Mistake, kept

LEFT_OUT = (".git", ".venv*", "out", "build", "__pycache__", ".*_cache", ".hypothesis", "*.egg-info")
WHOLE = ("-m", "not converged", "--numprocesses", "auto", "--dist", "worksteal")
NOTICED = ("FAILED ", "ERROR ")
"""What pytest says of a test, and of one whose fixture fails."""
PASSED, SOME_FAILED = 0, 1


def failing(copy: Path, tests: Sequence[str]) -> list[str]:
    """Run tests on a copy of the checkout, and return the names of those that fail."""
    command = [sys.executable, "-m", "pytest", "--no-header", "--tb=no", "-rfE", "-p", "no:cacheprovider", *tests]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(copy), str(copy / "tests")])}
    environment |= {"OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": ""}
    done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    if done.returncode not in (PASSED, SOME_FAILED):
        raise SystemExit(f"the tests did not run:\n{done.stdout}{done.stderr}")
    lines = [line for line in done.stdout.splitlines() if line.startswith(NOTICED)]
    return [line.partition(" ")[2].split(" - ")[0] for line in lines]


def noticing(copy: Path, mistake: Mistake, tests: Sequence[str]) -> list[str]:
    """Plant a mistake in a copy of the checkout, return the tests that fail with it, and take it out again."""
    module = copy / mistake.file
    right = module.read_text(encoding="utf-8")
    _write(module, mistake.planted(right))
    try:
        return failing(copy, tests)
    finally:
        _write(module, right)


def _write(module: Path, text: str) -> None:
    """Write a module, and forget what was compiled of it, which may look fresh."""
    module.write_text(text, encoding="utf-8")
    for compiled in (module.parent / "__pycache__").glob(f"{module.stem}.*.pyc"):
        compiled.unlink()


def is_one_of(test: str, names: Sequence[str]) -> bool:
    """True for a named test, with any parameters."""
    return any(test == name or test.startswith(f"{name}[") for name in names)


def main() -> int:
    """Plant what was asked for, print a line for each mistake and the tests that notice it."""
    parser = argparse.ArgumentParser(prog="python -m planted", description=__doc__)
    parser.add_argument("words", nargs="*", metavar="WORD", help="of the mistakes' kinds, files and sentences")
    parser.add_argument("--all", action="store_true", help="run the whole suite on each")
    options = parser.parse_args()
    asked = [one for one in kept() if not options.words or any(word in f"{one.kind} {one}" for word in options.words)]
    if not asked:
        parser.error("no kept mistake has any of these words")
    missed = 0
    with tempfile.TemporaryDirectory(prefix="planted-") as folder:
        copy = Path(folder, "checkout")
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(*LEFT_OUT))
        broken = failing(copy, WHOLE if options.all else sorted({test for one in asked for test in one.tests}))
        for test in broken:
            print(f"fails without any mistake, so that it notices none: {test}")
        for mistake in asked:
            every = noticing(copy, mistake, WHOLE if options.all else mistake.tests)
            found = [test for test in every if test not in broken]
            blind = [name for name in mistake.tests if not any(is_one_of(test, [name]) for test in found)]
            missed += bool(blind or not found)
            print(f"{'noticed' if found else 'UNNOTICED'}: {mistake}", flush=True)
            for test in found:
                print(f"    by {test}{'' if is_one_of(test, mistake.tests) else ' (not in the table)'}", flush=True)
            for name in blind:
                print(f"    NOT by {name}", flush=True)
    print(f"{len(asked)} mistakes, {missed} of them not noticed as the tables say")
    return 1 if missed or broken else 0


if __name__ == "__main__":
    sys.exit(main())
