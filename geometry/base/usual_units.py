"""Factors of the units that cases use, as pint gives them: a process that meets no other one does not load pint.

A table of factors alone is no second reading of units: whatever is not in it, mistakes among them, goes to pint.
``tests/unit/geometry/test_units.py`` holds every factor against pint's, to the last digit.
"""

USUAL: dict[str, dict[str, tuple[float, float]]] = {
    "length": {"mm": (1.0, 0.001), "cm": (10.0, 0.01), "m": (1e3, 1.0), "µm": (1e-3, 1e-6), "in": (25.4, 0.0254)},
    "area": {"mm^2": (1.0, 1e-6), "cm^2": (100.0, 1e-4), "m^2": (1e6, 1.0)},
    "volume": {"mm^3": (1.0, 1e-9), "cm^3": (1e3, 1.0000000000000002e-6)},
    "angle": {
        "deg": (0.017453292519943295, 0.017453292519943295),
        "°": (0.017453292519943295, 0.017453292519943295),
        "rad": (1.0, 1.0),
    },
    "force": {"N": (1.0, 1e3), "kN": (1e3, 1e6), "mN": (1e-3, 1.0)},
    "moment": {"N*mm": (1.0, 1.0), "N*m": (1e3, 1e3), "kN*m": (1e6, 1e6)},
    "line load": {"N/mm": (1.0, 1e6), "N/m": (1e-3, 1e3)},
    "stiffness": {"N/mm": (1.0, 1e6), "N/m": (1e-3, 1e3)},
    "torsional stiffness": {"N*mm/rad": (1.0, 1.0), "N*m/rad": (1e3, 1e3)},
    "stress": {
        "MPa": (1.0, 1e9),
        "GPa": (1e3, 1e12),
        "kPa": (1e-3, 1e6),
        "Pa": (1e-6, 1e3),
        "N/mm^2": (1.0, 1e9),
    },
    "fracture toughness": {
        "MPa*m^0.5": (31.622776601683793, 1e9),
        "MPa*mm^0.5": (1.0, 31622776.60168379),
    },
    "mass": {"g": (1e-6, 1.0), "kg": (1e-3, 1e3), "mg": (1e-9, 1e-3), "tonne": (1.0, 1e6)},
    "density": {
        "kg/m^3": (1.0000000000000002e-12, 1e3),
        "g/cm^3": (1e-9, 999999.9999999999),
        "tonne/mm^3": (1.0, 999999999999999.9),
    },
    "time": {"s": (1.0, 1.0), "min": (60.0, 60.0), "h": (3600.0, 3600.0), "year": (31557600.0, 31557600.0)},
    "speed": {"m/s": (1e3, 1.0), "mm/s": (1.0, 1e-3)},
    "acceleration": {"m/s^2": (1e3, 1.0), "mm/s^2": (1.0, 1e-3)},
    "angular speed": {
        "rpm": (0.10471975511965977, 0.10471975511965977),
        "rad/s": (1.0, 1.0),
        "deg/s": (0.017453292519943295, 0.017453292519943295),
    },
    "angular acceleration": {"rad/s^2": (1.0, 1.0), "deg/s^2": (0.017453292519943295, 0.017453292519943295)},
    "power": {"W": (1e3, 1e3), "kW": (1e6, 1e6)},
    "voltage": {"V": (1.0, 1e3)},
    "current": {"A": (1.0, 1.0), "mA": (1e-3, 1e-3)},
    "memory": {"MB": (1e6, 8e6), "GB": (1e9, 8e9), "GiB": (1073741824.0, 8589934592.0)},
}
"""Dimension -> unit -> so many of alula's units, and so many of pint's root units."""
CELSIUS = ("degC", "°C")
"""The one usual unit that has a zero of its own, which is alula's."""
ROOTS: dict[str, dict[str, float]] = {
    "length": {"meter": 1},
    "area": {"meter": 2},
    "volume": {"meter": 3},
    "angle": {"radian": 1},
    "force": {"gram": 1, "meter": 1, "second": -2},
    "moment": {"gram": 1, "meter": 2, "second": -2},
    "line load": {"gram": 1, "second": -2},
    "stiffness": {"gram": 1, "second": -2},
    "torsional stiffness": {"gram": 1, "meter": 2, "radian": -1, "second": -2},
    "stress": {"gram": 1, "meter": -1, "second": -2},
    "fracture toughness": {"gram": 1, "meter": -0.5, "second": -2},
    "mass": {"gram": 1},
    "density": {"gram": 1, "meter": -3},
    "time": {"second": 1},
    "speed": {"meter": 1, "second": -1},
    "acceleration": {"meter": 1, "second": -2},
    "angular speed": {"radian": 1, "second": -1},
    "angular acceleration": {"radian": 1, "second": -2},
    "power": {"gram": 1, "meter": 2, "second": -3},
    "voltage": {"ampere": -1, "gram": 1, "meter": 2, "second": -3},
    "current": {"ampere": 1},
    "memory": {"bit": 1},
}
"""Dimension -> pint's root units, in alphabetical order, and their powers."""
