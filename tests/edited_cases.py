"""A case with tables of its own added, which ``--set`` does not do."""

import tomllib
from collections.abc import Sequence
from typing import Any

from alula.loads.case.case import Case
from alula.loads.case.case_file import read_text, validate

PLANAR = 'layer_spacing="0 mm"'
"""Entry that puts all layers of a case in one plane: for tests of what has nothing to do with layers."""


NYLON = (
    'materials.nylon={title="nylon, printed", density="1100 kg/m^3", youngs_modulus="1.7 GPa", poissons_ratio=0.39, '
    'yield_strength="40 MPa", ultimate_strength="48 MPa", strength="yield", minimum_safety_factor=2, '
    "sources={}, status={}}"
)
"""Entry of a card that yields before it breaks and is printed: in layers where its part states how it is built."""


def edited(name: str, entries: Sequence[str], *, bare: bool = False, fits: bool = True) -> Case:
    """Return a case with entries ``path=value`` as if its file had been edited: missing tables are added.

    A bare case has lost what its file says about layers, and about pins in their holes; one without fits the latter.
    """
    data = tomllib.loads(read_text(name)[0])
    if bare:
        data = {key: value for key, value in data.items() if key not in ("layer_spacing", "washer")}
        for link in data["links"].values():
            for key in ("layer", "thickness"):
                link.pop(key, None)
    for joint in data["joints"].values() if bare or not fits else ():
        for key in ("fit", "clearance", "tight_in"):
            joint.pop(key, None)
    changes = [change for derived in Case.derived(data).values() for change in derived.items()]
    for entry in entries:
        path, _, text = entry.partition("=")
        try:
            changes.append((path, tomllib.loads(f"value = {text}")["value"]))
        except tomllib.TOMLDecodeError:
            changes.append((path, text))
    for path, value in changes:
        here: Any = data
        *above, last = path.strip().split(".")
        for key in above:
            here = here[int(key)] if isinstance(here, list) else here.setdefault(key, {})
        here[int(last) if isinstance(here, list) else last] = value
    return validate(data)


def tight_pins(case: Case) -> Case:
    """Return a case whose pins tilt in none of their holes, so that they share couples between layers in one way."""
    stated = {"fit": None, "clearance": None}
    turning = {n: joint for n, joint in case.joints.items() if joint.type == "revolute" and not joint.clamped}
    tight = {n: {"tight_in": joint.links, **stated} for n, joint in turning.items()}
    joints = {n: j.model_copy(update=tight.get(n, {"tight_in": ()})) for n, j in case.joints.items()}
    return case.model_copy(update={"joints": joints})
