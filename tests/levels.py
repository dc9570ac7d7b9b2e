"""A pylon and a file of invented tests, which tests of levels change."""

from copy import deepcopy

TOP = {"forward": "50 mm", "outward": "-20 mm", "up": "400 mm"}
BOTTOM = {"forward": "-40 mm", "outward": "10 mm", "up": "0 mm"}
PROOF = {
    "top": TOP,
    "bottom": BOTTOM,
    "steps": [{"force": "200 N", "duration": "30 s"}, {"force": "1000 N", "duration": "20 s"}],
    "elastic": True,
}
CYCLIC = {
    "top": {**TOP, "forward": "60 mm"},
    "bottom": BOTTOM,
    "steps": [{"least": "60 N", "force": "600 N", "cycles": 1e6}],
    "lasts": True,
}
LEVEL = {
    "standard": "In the manner of ISO 10328",
    "name": "example",
    "condition": "I",
    "source": "invented round numbers, of no standard",
    "tests": {"proof": PROOF, "cyclic": CYCLIC},
}
PLACED = {"enters": {"link": "pylon", "at": "T"}, "forward": "+x", "up": "+y"}
PYLON = {
    "schema_version": 1,
    "title": "A pylon clamped in a foot",
    "links": {
        "foot": {"ground": True, "points": {"O": ["0 mm", "80 mm"]}},
        "pylon": {"part": "tube", "points": {"O": ["0 mm", "0 mm"], "T": ["300 mm", "0 mm"]}},
    },
    "joints": {"O": {"links": ["foot", "pylon"], "clamped": True, "clamp_length": "30 mm", "angle": "90 deg"}},
    "parts": {
        "tube": {
            "shape": "tube",
            "material": "aluminium-6061-t6",
            "outer_diameter": "34 mm",
            "inner_diameter": "26 mm",
            "fillet_radius": "1 mm",
        }
    },
    "solid": {"mesh_size": 4.0},
}


def pylon(level=None, **changes):
    """Return the tables of the pylon with a level; entries of it that are None are left out."""
    stated = {**LEVEL, **PLACED, **(level or {})}
    return deepcopy({**PYLON, "level": {key: value for key, value in stated.items() if value is not None}, **changes})
