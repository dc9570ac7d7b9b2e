"""How far eyes may lie from the formulas of their modes: what limit analysis of drawn eyes gave.

``benchmarks/eye_limits.py`` writes ``eye_scatter.toml``; ``docs/theory/eyes.md`` says what it holds.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from alula.fea.common.reason import Reason, reason
from alula.fea.modes.eye_modes import EyeMode, RoundEye

Interval = tuple[float, float]
ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True)
class EyeScatter:
    """What drawn eyes bear over the formulas of ASME BTH-1, for a material that does not harden.

    Attributes
    ----------
    modes : mapping of EyeMode to (float, float)
        Least, of thin eyes, and largest, of thick ones; none of dishing, which is no matter of limit analysis.
    across : float
        Largest share that a force across the shank takes off, as so much times the sine of its angle.
    ratio, pin, shank : (float, float)
        Drawn radii of eyes over those of their holes, pins over holes, and shanks over eyes.
    """

    modes: Mapping[EyeMode, Interval]
    across: float
    ratio: Interval
    pin: Interval
    shank: Interval

    def outside(self, eye: RoundEye, shank: float) -> Reason | None:
        """Return which proportion of an eye was not drawn.

        An eye with more material about it bears no less (lower bound theorem of limit analysis): for larger ones the
        low end still holds.

        Parameters
        ----------
        eye : RoundEye
        shank : float
            Width of what holds it [mm].

        Returns
        -------
        Reason or None
            None where all were.
        """
        for name, value, (low, high) in (
            ("eye over hole", 2.0 * eye.radius / eye.hole, self.ratio),
            ("pin over hole", eye.pin / eye.hole, self.pin),
            ("shank over eye", min(shank / (2.0 * eye.radius), 1.0), self.shank),
        ):
            if value < low * (1.0 - ROUNDING):
                return reason("outside_drawn_eyes", proportion=name, value=value, low=low, high=high)
        return None


@cache
def eye_scatter() -> EyeScatter:
    """Return what was measured.

    Returns
    -------
    EyeScatter
    """
    data = tomllib.loads((files("alula.fea") / "eye_scatter.toml").read_text(encoding="utf-8"))
    return EyeScatter(
        modes={EyeMode[name]: (low, high) for name, (low, high) in data["modes"].items()},
        across=data["across"],
        **{name: (low, high) for name, (low, high) in data["ranges"].items()},
    )
