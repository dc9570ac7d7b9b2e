"""How far solid models of links lie from the estimates of hand calculation: measured factors, and where they hold.

``calibration.toml`` is written by ``benchmarks/calibration.py`` from solid models of parametrised tubes and bars.
"""

import itertools
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files

from alula.fea.beam.critical_locations import LocationKind
from alula.fea.common.reason import Reason, reason, together
from alula.geometry.bodies.body import Body, PartKind, clamped_end, patch_span
from alula.geometry.bodies.eyes import eye_reach
from alula.loads.records.bearing import CONTACT_SHORTFALL

Interval = tuple[float, float]
_GAPS = {
    "gap between eyes over width": "eyes_too_close",
    "gap at holes over width": "holes_too_close",
    "gap at a loaded end over width": "loaded_end_too_close",
}
"""Proportions that are distances between neighbours, with the reason where these are too near."""


@dataclass(frozen=True, kw_only=True)
class Factors:
    """Solid over estimate: the least and the largest measured, widened by the margin, and the median.

    Attributes
    ----------
    low : float
        The least measured, less the margin.
    typical : float
        The median.
    high : float
        The largest measured, with the margin.
    """

    low: float
    typical: float
    high: float


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """What was measured on one shape.

    Attributes
    ----------
    measured : str
        Date.
    parts : int
        Number of parts measured.
    cases : int
        Number of load cases, of all parts together.
    margin : float
        The factor by which the largest and least measured ones were widened.
    ranges : dict of str to Interval
        Proportion -> least and largest of the measured parts.
    von_mises : dict of Kind to Factors
        Kind of critical location and the factors of the largest stress there.
    principal : dict of Kind to Factors
        The same for the largest principal stress.
    displacement : Factors
        Factors of the largest displacement.
    """

    measured: str
    parts: int
    cases: int
    margin: float
    ranges: Mapping[str, Interval]
    von_mises: Mapping[LocationKind, Factors]
    principal: Mapping[LocationKind, Factors]
    displacement: Factors

    def factors(self, kind: LocationKind, *, brittle: bool) -> Factors:
        """Return the factors of the stress that decides at a kind of place.

        Parameters
        ----------
        kind : Kind
        brittle : bool
            True for the largest principal stress, else von Mises.

        Returns
        -------
        Factors
            In an eye they reach higher, by what pin contact adds.
        """
        found = (self.principal if brittle else self.von_mises)[kind]
        return replace(found, high=found.high / (1.0 - CONTACT_SHORTFALL)) if kind == "eye" else found

    def outside(self, body: Body, nu: float) -> Reason | str | None:
        """Return which proportions of a link lie outside of what was measured, all of them.

        Parameters
        ----------
        body : Body
            Geometry of the link.
        nu : float
            Poisson's ratio.

        Returns
        -------
        Reason, str or None
            None where all proportions lie within.
        """
        if body.part.fillet_radius == 0.0:
            return reason("sharp_junctions")
        if any(pin.y != 0.0 for pin in body.pins):
            return reason("pin_off_axis")
        found = []
        for name, value in proportions(body, nu).items():
            low, high = self.ranges.get(name, (1.0, 0.0))
            if not low * (1.0 - 1e-6) <= value <= high * (1.0 + 1e-6):
                if name in _GAPS:
                    found.append(reason(_GAPS[name], gap=value, needed=low))
                else:
                    found.append(reason("outside_calibration", proportion=name, value=value, low=low, high=high))
        return together(*found) or None


def proportions(body: Body, nu: float) -> dict[str, float]:
    """Return the ratios on which the factors may depend, by name; distances in section widths.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    nu : float
        Poisson's ratio.

    Returns
    -------
    dict of str to float
        Name of each ratio and its value.
    """
    part, width = body.part, body.part.section.width
    found = {
        "Poisson's ratio": nu,
        "eye diameter over width": part.eye_diameter / width,
        "fillet over width": part.fillet_radius / width,
    }
    if part.section.round:
        found["inner over outer diameter"] = part.section.radius_ratio
        found["eye thickness over width"] = part.eye_thickness / width
    else:
        found["thickness over width"] = part.section.height / width
        found["eye thickness over thickness"] = part.eye_thickness / part.section.height
    pins = [pin.diameter / body.ring(pin).diameter for pin in body.pins]
    found |= {"largest pin over eye": max(pins), "smallest pin over eye": min(pins)}
    for row in body.holes:
        across = part.section.across(row.along)
        name = f"hole over size across ({row.along})"
        found[name] = max(found.get(name, 0.0), row.diameter / across)
    for end in body.ends:
        found["patch over width"] = end.patch / width
    eyes = sorted((p.x - eye_reach(body, p), p.x + eye_reach(body, p)) for p in body.pins)
    holes = [(x - r.diameter / 2.0, x + r.diameter / 2.0) for r in body.holes for x in r.positions]
    ends = [patch_span(body, end) for end in body.ends]
    for name, features, others in (
        ("gap between eyes over width", eyes, []),
        ("gap at holes over width", holes, eyes),
        ("gap at a loaded end over width", ends, eyes + holes),
    ):
        every = sorted(features + others)
        gaps = [(after[0] - before[1]) / width for before, after in itertools.pairwise(every)
                if before in features or after in features]  # fmt: skip
        if gaps:
            found[name] = min(gaps)
    return found


@cache
def calibrations() -> Mapping[str, Calibration]:
    """Read the calibration of every shape ("tube", "bar")."""
    data = tomllib.loads((files("alula.fea") / "calibration.toml").read_text(encoding="utf-8"))
    return {shape: _parsed(entry) for shape, entry in data.items()}


def uncalibrated(body: Body, nu: float) -> Reason | str | None:
    """Return why hand calculation is not calibrated for a link.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    nu : float
        Poisson's ratio.

    Returns
    -------
    Reason, str or None
        The part's own text where it has one; None where it is calibrated.
    """
    if body.part.shape == "disc":
        return reason("disc_is_no_beam")
    if not body.part.is_beam:
        return reason("shape_not_measured", shape=body.part.shape)
    if any(pin.slot > 0.0 for pin in body.pins):
        return reason("has_slot")
    if any(pin.fork is not None for pin in body.pins):
        return reason("has_fork")
    if any(pin.ring is not None for pin in body.pins):
        return reason("has_eye_of_own_sizes")
    if clamped_end(body) is not None:
        return reason("clamp_not_measured")
    if body.part.unmeasured:
        return body.part.unmeasured
    if body.part.shape not in calibrations():
        return reason("shape_not_measured", shape=body.part.shape)
    return calibration_of(body.part).outside(body, nu)


def calibration_of(part: PartKind) -> Calibration:
    """Return the calibration of a part's shape; a disc has none.

    Parameters
    ----------
    part : PartKind
        Tube or bar.

    Returns
    -------
    Calibration
        What was measured on such parts.
    """
    return calibrations()[part.shape]


def _parsed(entry: Mapping[str, object]) -> Calibration:
    def factors(values: list[float]) -> Factors:
        low, typical, high = values
        return Factors(low=low, typical=typical, high=high)

    data: dict[str, object] = dict(entry)
    for quantity in ("von_mises", "principal"):
        table = data[quantity]
        assert isinstance(table, dict)
        data[quantity] = {kind: factors(values) for kind, values in table.items()}
    displacement, ranges = data["displacement"], data["ranges"]
    assert isinstance(displacement, list)
    assert isinstance(ranges, dict)
    data["displacement"] = factors(displacement)
    data["ranges"] = {name: (low, high) for name, (low, high) in ranges.items()}
    return Calibration(**data)  # type: ignore[arg-type]
