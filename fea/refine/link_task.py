"""What is to be solved of a link, and the limits that its numbers must clear."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields, replace

from alula.fea.buckling.solid_holding import SolidHolding
from alula.fea.common.link_loads import LinkLoads
from alula.fea.elements.mouth import Mouth, reference_surfaces
from alula.fea.refine.beyond_meshes import OpenRanges
from alula.fea.refine.link_series import STRESS, Measure
from alula.fea.solid.layers import Layers
from alula.geometry.materials.material import Material
from alula.geometry.parts.part import Body


@dataclass(frozen=True, kw_only=True)
class ElasticLink:
    """A link as an elastic solid.

    Attributes
    ----------
    body : Body
        Geometry of the link.
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
    layers : Layers or None
        Of a printed part whose layers are checked.
    """

    body: Body
    E: float
    nu: float
    density: float
    line: tuple[str, str] | Mouth
    brittle: bool
    layers: Layers | None = None

    @classmethod
    def of(cls, body: Body, material: Material, layers: Layers | None = None) -> "ElasticLink":
        """Return a link of a material.

        Parameters
        ----------
        body : Body
        material : Material
        layers : Layers, optional

        Returns
        -------
        ElasticLink
        """
        return cls(
            body=body,
            E=material.youngs_modulus,
            nu=material.poissons_ratio,
            density=material.density,
            line=reference_surfaces(body),
            brittle=material.brittle,
            layers=layers,
        )


@dataclass(frozen=True, kw_only=True)
class LinkTask(ElasticLink):
    """A link to be solved.

    Attributes
    ----------
    loads : tuple of LinkLoads
        One per load case.
    stress_limits : tuple of tuple of 2 float
        On the deciding stress [MPa]: from the least to the largest that stated scatter makes of each, within which
        nothing is decided.
    displacement_limits : tuple of tuple of 2 float
        The same on the displacement [mm].
    layer_limits : tuple of tuple of 2 float
        As ``stress_limits``, on the stress on the layers.
    displacement_error : float
        Largest relative error of the displacement, which a check of the linkage needs.
    holding : SolidHolding or None
        How joints hold it against buckling as a solid; None where beams stand for it.
    beyond_peak : bool
        True where a check looks at more than the peaks, so that meshes are made as fine as the accuracy asks.
    open_ranges : mapping of str to OpenRanges
        Name of loads -> within what numbers their checks are open however fine the mesh; of loads that are left out
        meshes are made finer all the same.
    """

    loads: tuple[LinkLoads, ...]
    stress_limits: tuple[tuple[float, float], ...]
    displacement_limits: tuple[tuple[float, float], ...]
    layer_limits: tuple[tuple[float, float], ...] = ()
    displacement_error: float = math.inf
    holding: SolidHolding | None = None
    beyond_peak: bool = False
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
    def link(self) -> ElasticLink:
        """The link alone, which its solution depends on besides its loads."""
        return ElasticLink(**{one.name: getattr(self, one.name) for one in fields(ElasticLink)})

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
