"""What is to be solved of a link, and the limits that its numbers must clear."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

from alula.fea.buckling.solid_holding import SolidHolding
from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.mouth import Mouth
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.link_series import STRESS, Measure
from alula.fea.solid.layers import Layers
from alula.geometry.parts.part import Body


@dataclass(frozen=True, kw_only=True)
class LinkTask:
    """A link to be solved.

    Attributes
    ----------
    body : Body
        Geometry of the link.
    loads : tuple of LinkLoads
        One per load case.
    E : float
        Young's modulus [MPa].
    nu : float
        Poisson's ratio.
    density : float
        Of the material [tonne/mm³].
    line : tuple of 2 str or Mouth
        Surfaces that displacements refer to (``solve_solid``).
    brittle : bool
        True where the principal stress decides, False where von Mises does.
    stress_limits : tuple of tuple of 2 float
        On the deciding stress [MPa]: from the least to the largest that stated scatter makes of each, within which
        nothing is decided.
    displacement_limits : tuple of tuple of 2 float
        The same on the displacement [mm].
    layers : Layers or None
        Of a printed part whose layers are checked.
    layer_limits : tuple of tuple of 2 float
        As ``stress_limits``, on the stress on the layers.
    displacement_error : float
        Largest relative error of the displacement, which a check of the linkage needs.
    holding : SolidHolding or None
        How joints hold it against buckling as a solid; None where beams stand for it.
    open_ranges : mapping of str to OpenRanges
        Name of loads -> within what numbers their checks are open however fine the mesh; of loads that are left out
        meshes are made finer all the same.
    """

    body: Body
    loads: tuple[LinkLoads, ...]
    E: float
    nu: float
    density: float
    line: tuple[str, str] | Mouth
    brittle: bool
    stress_limits: tuple[tuple[float, float], ...]
    displacement_limits: tuple[tuple[float, float], ...]
    layers: Layers | None = None
    layer_limits: tuple[tuple[float, float], ...] = ()
    displacement_error: float = math.inf
    holding: SolidHolding | None = None
    open_ranges: Mapping[str, OpenRanges] = field(default_factory=dict)

    def without(self, names: Collection[str]) -> "LinkTask":
        """Return the task without some of its loads.

        Parameters
        ----------
        names : collection of str
            Of the loads that are left out.

        Returns
        -------
        LinkTask
        """
        return replace(self, loads=tuple(loads for loads in self.loads if loads.name not in names))

    @property
    def measures(self) -> tuple[Measure, ...]:
        """The stresses that decide, the one that decides all links first."""
        return (STRESS[self.brittle],) if self.layers is None else (STRESS[self.brittle], "layers")

    @property
    def section(self) -> float:
        """Smaller dimension of the section [mm]."""
        return self.body.part.size

    @property
    def may_be_sharp(self) -> bool:
        """True where the shape has re-entrant edges, such as at eyes without fillets."""
        return self.body.may_be_sharp
