"""Inputs by hypothesis: what a grammar of the language, or of TOML, allows and a little more.

python -m fuzz.properties TARGET INPUTS SEED FOLDER
"""

import random
import sys
import tomllib
from pathlib import Path
from typing import Any

from fuzz import grammar, guard, mutate, targets
from fuzz.findings import Findings
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

CHUNK = 5_000
"""Inputs per run of hypothesis: it keeps what it has tried in memory."""

_numbers = st.one_of(
    st.sampled_from(
        ("0", "1", "2.", ".5", "1e-9", "1e308", "1e400", "1e-320", "9" * 40, "00", "1e", "1.2.3", "٣", "1e+5", "-1")
    ),
    st.integers(-(10**9), 10**9).map(str),
    st.floats(allow_nan=True, allow_infinity=True).map(repr),
)
_units = st.one_of(
    st.sampled_from(
        (*mutate.UNITS, "", "%", "°", "µm", "N/mm^2", "N·mm", "kg/m^3", "m**2", "m^9", "m/", "/m", "mm mm")
    ),
    st.lists(st.sampled_from(mutate.UNITS), min_size=1, max_size=4).map("*".join),
    st.text("abcmNPkg°µΩ%^*/-123 ()", max_size=20),
)
_quantities = st.one_of(
    st.builds("{}{}{}".format, _numbers, st.sampled_from((" ", "", "  ", "\u00a0", "\t")), _units),
    st.sampled_from(mutate.HOSTILE_TEXT),
    st.text(max_size=80),
)
_names = st.sampled_from(("given.x", "word", "pi", "nothing.here", 'given."a b".0', "__class__.__bases__", "sin", "e"))
_functions = st.sampled_from(
    ("sqrt", "abs", "min", "max", "hypot", "mod", "below", "sin", "acos", "atan2", "eval", "pow")
)
_operators = st.sampled_from((" + ", " - ", "*", "/", "**", "^", " ** ", "·", "²", "//", "%", ", ", " "))
_terms = st.recursive(
    st.one_of(st.builds("{} {}".format, _numbers, _units), _numbers, _names),
    lambda inner: st.one_of(
        st.builds("{}{}{}".format, inner, _operators, inner),
        st.builds("({})".format, inner),
        st.builds("-{}".format, inner),
        st.builds("{}({})".format, _functions, inner),
        st.builds("{}({}, {})".format, _functions, inner, inner),
    ),
    max_leaves=12,
)
_expressions = st.one_of(
    _terms,
    _terms,
    _quantities,
    st.text('0123456789.eE+-*/^()aNm, "·²', max_size=60),
    st.builds(str.__mul__, st.sampled_from(("(", "-", "sqrt(", "1+", "2**", "1 m*")), st.integers(1, 300)),
)
_scalars = st.one_of(
    st.booleans(),
    st.integers(),
    st.floats(),
    st.dates(),
    st.times(),
    st.datetimes(),
    _quantities,
    st.sampled_from(mutate.HOSTILE_TEXT),
)
_ENTRIES = (
    "schema_version title links joints pose drive motion materials parts load_cases checks claims solid points "
    "ground part holes type coordinate angle near link joint forces at force moments spread air own_weight speed "
    "poses range turn shape count A AB 0 x"
)
_KEYS = tuple(_ENTRIES.split(" "))
_keys = st.one_of(st.sampled_from(_KEYS), st.sampled_from(mutate.HOSTILE_TEXT), st.text(max_size=10))
_values: st.SearchStrategy[Any] = st.recursive(
    _scalars,
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(_keys, inner, max_size=4)),
    max_leaves=10,
)
_PATHS = tuple(
    f"{top}.{rest}"
    for top in _KEYS[:13]
    for rest in ("x", "0", "AB.points.A", "link", "angle", "type", "G.pin_diameter", "a.b.c.d")
)
_literals = st.one_of(
    _scalars.map(str),
    _quantities.map('"{}"'.format),
    st.text(max_size=30),
    st.sampled_from(("[]", "{}", "[[[[", "{a=1}", "1\nb=2", "[1,2]", '"""', "[" * 2000)),
)

_CASES = tuple(tomllib.loads(text) for text in targets.seeds().values())
_random = st.integers(0, 2**32).map(random.Random)

STRATEGIES: dict[str, st.SearchStrategy[Any]] = {
    "expression": _expressions,
    "quantity": _quantities,
    "claim": st.one_of(_expressions, _quantities),
    "override": st.one_of(
        st.builds(
            "{}={}".format, st.one_of(st.sampled_from(_PATHS), st.lists(_keys, max_size=4).map(".".join)), _literals
        ),
        st.text(max_size=60),
        st.builds(grammar.override, _random, st.builds(targets.starter_tables)),
    ),
    "case_tables": st.one_of(
        st.builds(grammar.tables, _random, st.sampled_from(_CASES)),
        st.dictionaries(_keys, _values, max_size=6).map(lambda tables: {"schema_version": 1} | tables),
        st.builds(lambda key, value: targets.starter_tables() | {key: value}, st.sampled_from(_KEYS[:13]), _values),
    ),
    "varied": st.one_of(
        st.builds("{}..{}{}{}".format, _quantities, _quantities, st.sampled_from(("/", " by ", "")), _quantities),
        st.lists(_quantities, max_size=5).map(",".join),
        _expressions,
    ),
    "companion": st.one_of(
        st.sampled_from(mutate.HOSTILE_TEXT), st.text(max_size=300), st.builds("../{}".format, st.text(max_size=20))
    ),
}


def try_many(name: str, inputs: int, start: int, findings: Findings) -> None:
    """Try so many inputs of a target; faults go to ``findings``, shrunk."""
    target = targets.TARGETS[name]
    chunk = start
    while findings.tried < inputs and not findings.full:
        chunk += 1

        @seed(chunk)
        @settings(
            max_examples=min(CHUNK, inputs - findings.tried),
            deadline=None,
            database=None,
            phases=(Phase.generate, Phase.shrink),
            suppress_health_check=list(HealthCheck),
        )
        @given(STRATEGIES[name])
        def one(data: Any) -> None:
            findings.last = data
            findings.tried += 1
            findings.accepted += target(data)

        try:
            one()
        except KeyboardInterrupt:
            raise
        except BaseException as fault:
            findings.keep(findings.last, fault)


def main(name: str, inputs: str, start: str, folder: str) -> None:
    """Try, and write what was found."""
    targets.warm()
    guard.install()
    findings = Findings(engine="hypothesis", target=name, folder=Path(folder))
    try_many(name, int(inputs), int(start), findings)
    findings.write()
    targets.clean()


if __name__ == "__main__":
    main(*sys.argv[1:])
