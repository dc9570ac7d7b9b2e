"""A link by itself as a solid that vibrates: how its joints hold it, what it carries, and its modes on two meshes.

The wall of a bore moves as a rigid cylinder, which the pin holds: pins are stiffer than what they stand in, and one
that vibrates under a load keeps in touch with its wall. A body that a link carries moves with the bore through which
its weight enters, or with the mean motion of a patch or face; this is dual to how loads enter there, and stiffens
nothing. A pin in a slot bears on one flank, that at y > 0, as in the frame of the linkage. It holds it on average,
weighted as its pressure is (``alula.fea.tractions.slot_traction``): the mean displacement across the slot is zero, and
so is the mean tilt. What is spread along the link is mass without stiffness in its volume. Of a pair each plate bears
half.

The stress of loads, which stiffens what it pulls, is left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import reason
from alula.fea.common.source import Source, SourceKind
from alula.fea.elements.mass import consistent_mass
from alula.fea.elements.quadrature import Quadrature, surface_quadrature, volume_quadrature
from alula.fea.elements.space import DisplacementSpace, displacement_space
from alula.fea.refine.convergence import ALONE, SAFETY
from alula.fea.refine.error_estimate import estimate_error
from alula.fea.refine.link_series import CHORD
from alula.fea.refine.refinement import START
from alula.fea.solid.solution import require_compressible
from alula.fea.solid.stress import stress_field
from alula.fea.tractions.slot_traction import DEGREE, flank_pressure
from alula.fea.tractions.traction import line_density, wrench_density
from alula.fea.vibration.link_holding import LinkHolding
from alula.fea.vibration.mass_matrix import body_mass
from alula.fea.vibration.rigid_regions import RigidRegion
from alula.fea.vibration.solid_modes import CarriedOn, SolidModes, solid_modes
from alula.geometry.base.errors import CannotRunError
from alula.geometry.materials.material import Material
from alula.geometry.meshing.mesh import MeshSettings, mass_properties, mesh_body
from alula.geometry.parts.part import Body
from alula.loads.case.case import Case
from alula.loads.records.applied import LineLoad
from alula.loads.records.bearing import WIDE
from alula.loads.records.carried import Carried, CarriedSpread, mass_of

Real = NDArray[np.float64]
FINER = 1.6
"""Element size of the first mesh over that of the second."""
ORDER = 1.0
"""Of convergence that the band assumes. Stress at the rim of a rigid bore grows as r^(a-1) with a above 0.5, and what a
frequency misses falls with the size to the power of 2 a (Strang & Fix, 1973, section 8.1)."""
RIGID = 1e-5
"""Share of the first elastic ω² below which an ω² is that of a rigid motion: rounding leaves some 1e-9."""


ABOVE = 0.1
"""Share of what a frequency may miss by which it may also be too low: round walls of a mesh are parabolas, not arcs."""


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkSolid:
    """A link that is to vibrate as a solid.

    Attributes
    ----------
    body : Body
        Of one plate, where it is a pair.
    material : Material
        Its material.
    holding : LinkHolding
        How its joints hold it.
    points : dict of str to tuple of 2 float
        The link's points [mm].
    carried : tuple of Carried
        What it carries.
    share : float
        Of what it carries: half, where it is one plate of a pair.
    """

    body: Body
    material: Material
    holding: LinkHolding
    points: dict[str, tuple[float, float]]
    carried: tuple[Carried, ...] = ()
    share: float = 1.0

    @classmethod
    def of(cls, case: Case, link: str, holding: LinkHolding, carried: Sequence[Carried]) -> "LinkSolid":
        """Return the solid of a link of a case.

        Parameters
        ----------
        case : Case
        link : str
        holding : LinkHolding
        carried : sequence of Carried
            What it carries.

        Returns
        -------
        LinkSolid
        """
        return cls(
            body=case.body(link),
            material=case.material_of(link),
            holding=holding,
            points=dict(case.links[link].points),
            carried=tuple(carried),
            share=1.0 / case.links[link].count,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class RefinedModes:
    """The lowest modes of a link by its finest mesh, and how precise they are.

    Attributes
    ----------
    space : DisplacementSpace
        Of the finest mesh.
    modes : SolidModes
        On it.
    frequencies : tuple of Band
        With what the meshes leave open [Hz].
    """

    space: DisplacementSpace
    modes: SolidModes
    frequencies: tuple[Band, ...]


def refined_modes(solid: LinkSolid, start: MeshSettings, count: int, threads: int | None = None) -> RefinedModes:
    """Return the lowest modes of a link on two meshes.

    Frequencies of a mesh are too high, so that the finer one's is about the band's upper end, and what it fell by since
    the coarser one tells how far the lower end lies below. The mesh of a part's file has no finer one: the recovered
    stress of each mode tells (``alula.fea.refine.error_estimate``), taken fourfold.

    Parameters
    ----------
    solid : LinkSolid
    start : MeshSettings
        Of the first mesh.
    count : int
        How many modes.
    threads : int or None, optional
        Upper bound on the threads of the solver.

    Returns
    -------
    RefinedModes

    Raises
    ------
    CaseError
        Where the body cannot be built, or its material is nearly incompressible.
    CannotRunError
        Where meshes or solver fail.
    """
    require_compressible(solid.material.poissons_ratio)
    meshes = [mesh_body(solid.body, start)]
    if not solid.body.part.is_fixed:
        meshes.append(mesh_body(solid.body, start.scaled(1.0 / FINER)))
    spaces = [displacement_space(mesh) for mesh in meshes]
    found = [modes_on(solid, space, count, threads) for space in spaces]
    values = [np.sqrt(modes.squares) / (2.0 * np.pi) for modes in found]
    if len(found) == 1:
        missed = values[0] * np.array([_estimated(solid, spaces[0], shape) for shape in found[0].shapes])
        detail = reason("estimated_on_mesh_of_file")
    else:
        ratio = (len(spaces[1].cells) / len(spaces[0].cells)) ** (1.0 / 3.0)
        missed = SAFETY * np.abs(values[1] - values[0]) / (ratio**ORDER - 1.0)
        detail = reason("on_two_meshes", elements=[len(space.cells) for space in spaces])
    volume = mass_properties(solid.body).volume
    chord = 0.5 * CHORD * abs(float(meshes[-1].volume) / volume - 1.0)
    frequencies = []
    for value, less in zip(values[-1], missed, strict=True):
        low, high = max(value - less, 0.0) * (1.0 - chord), (value + ABOVE * less) * (1.0 + chord)
        width = float(high / low) if low > 0.0 else np.inf
        source = Source(kind=SourceKind.DISCRETISATION, detail=detail, width=width)
        frequencies.append(Band(value=float(value), low=float(low), high=float(high), sources=(source,)))
    return RefinedModes(space=spaces[-1], modes=found[-1], frequencies=tuple(frequencies))


def first_mesh(case: Case) -> MeshSettings:
    """Return the settings of the first mesh of a case's links, as a check takes them.

    Parameters
    ----------
    case : Case

    Returns
    -------
    MeshSettings
    """
    return replace(START, curved=case.solid.curved).scaled(case.solid.mesh_size)


def _estimated(solid: LinkSolid, space: DisplacementSpace, shape: Real) -> float:
    """Share of its frequency that a mode may be too high: half of that of ω², the square of its error, fourfold."""
    material = {"E": solid.material.youngs_modulus, "nu": solid.material.poissons_ratio}
    return ALONE / 2.0 * estimate_error(stress_field(space, shape, **material), shape, **material).relative ** 2


def modes_on(solid: LinkSolid, space: DisplacementSpace, count: int, threads: int | None = None) -> SolidModes:
    """Return the lowest modes of a link on a mesh, rigid motions left out.

    Parameters
    ----------
    solid : LinkSolid
    space : DisplacementSpace
        Of the mesh.
    count : int
        How many.
    threads : int or None, optional
        Upper bound on the threads of the solver.

    Returns
    -------
    SolidModes

    Raises
    ------
    CannotRunError
        Where the iteration fails, or finds other rigid motions than joints leave.
    """
    volume, free, material = volume_quadrature(space), solid.holding.free, solid.material
    density = np.full(volume.w.shape, material.density)
    for one in solid.carried:
        if isinstance(one, CarriedSpread):
            density += _spread(solid, volume, one)
    found = solid_modes(
        space,
        consistent_mass(volume, density, len(space.nodes)),
        E=material.youngs_modulus,
        nu=material.poissons_ratio,
        density=material.density,
        count=count + free,
        regions=regions(solid, space),
        conditions=conditions(solid, space),
        bodies=bodies_on_patches(solid, space),
        threads=threads,
    )
    rigid = int(np.count_nonzero(found.squares < RIGID * found.squares[free]))
    if rigid != free:
        raise CannotRunError(f"its solid has {rigid} rigid motions, where its joints leave {free}; refine the mesh")
    return SolidModes(squares=found.squares[free:], shapes=found.shapes[free:], in_plane=found.in_plane[free:])


def _spread(solid: LinkSolid, volume: Quadrature, one: CarriedSpread) -> Real:
    """Density (k, q) of a mass that is spread along the link [tonne/mm³]."""
    start, end = sorted((solid.points[one.start][0], solid.points[one.end][0]))
    per_length = np.array([0.0, 0.0, solid.share * one.mass / (end - start)])
    line = LineLoad(link=one.link, start=start, end=end, at_start=per_length, at_end=per_length)
    return np.asarray(line_density(volume, line)[..., 2])


def regions(solid: LinkSolid, space: DisplacementSpace) -> list[RigidRegion]:
    """Return the surfaces that move as rigid bodies: bores on pins with the bodies there, and what a support holds.

    Parameters
    ----------
    solid : LinkSolid
    space : DisplacementSpace
        Of its mesh.

    Returns
    -------
    list of RigidRegion
    """
    found = []
    for point in _rigid(solid):
        name, at = _surface(space, point), np.array([*solid.points[point], 0.0])
        held = [place for place in solid.holding.places if place.point == point and not place.flank]
        found.append(
            RigidRegion(
                name=name,
                nodes=np.unique(space.faces(name)),
                place=at,
                held=np.vstack([replace(place, place=place.place - at).conditions for place in held]),
                inertia=sum((matrix for where, matrix in _bodies(solid) if where == point), np.zeros((6, 6))),
            )
        )
    return found


def _rigid(solid: LinkSolid) -> list[str]:
    """Points whose surfaces are rigid, since pins or supports hold them."""
    return list(dict.fromkeys(place.point for place in solid.holding.places if not place.flank))


def bodies_on_patches(solid: LinkSolid, space: DisplacementSpace) -> list[CarriedOn]:
    """Return the bodies that a link carries elsewhere: on patches, faces and walls of slots.

    Parameters
    ----------
    solid : LinkSolid
    space : DisplacementSpace
        Of its mesh.

    Returns
    -------
    list of CarriedOn
    """
    rigid, found = _rigid(solid), []
    for point, inertia in _bodies(solid):
        if point not in rigid:
            surface, at = surface_quadrature(space, _surface(space, point)), np.array([*solid.points[point], 0.0])
            rows = [surface.load_vector(wrench_density(surface, at, unit), len(space.nodes)) for unit in np.eye(6)]
            found.append(CarriedOn(motion=np.array(rows), inertia=inertia))
    return found


def _surface(space: DisplacementSpace, point: str) -> str:
    """Name of the surface about a point."""
    return f"bore:{point}" if f"bore:{point}" in space.surfaces else f"end:{point}"


def _bodies(solid: LinkSolid) -> list[tuple[str, Real]]:
    """Points at which a link carries bodies, with their mass matrices (6, 6) about them."""
    found = []
    for one in solid.carried:
        if not isinstance(one, CarriedSpread):
            known = mass_of(one, solid.points)
            arm = np.array([*(known.centroid - np.array(solid.points[one.at])), 0.0])
            found.append((one.at, solid.share * body_mass(known.mass, arm, known.inertia)))
    return found


def conditions(solid: LinkSolid, space: DisplacementSpace) -> Real:
    """Return the conditions of pins in the link's slots on mean displacements of a flank.

    Parameters
    ----------
    solid : LinkSolid
    space : DisplacementSpace
        Of its mesh.

    Returns
    -------
    ndarray, shape (c, 3 n)
        Each sum is zero; two for each pin, across the slot and about it.
    """
    rows = []
    for place in (place for place in solid.holding.places if place.flank):
        [pin] = [pin for pin in solid.body.pins if pin.name == place.point]
        wall = surface_quadrature(space, f"bore:{place.point}", degree=DEGREE)
        length = WIDE.patch(pin.pin_diameter)
        pressure = flank_pressure(wall, place.place, length, 1.0)[..., 1]
        if not np.any(pressure):
            raise CannotRunError(f"the slot at {place.point} has no wall beside its pin; refine the mesh")
        arm = wall.x - place.place
        ways = [*place.moves, *(np.cross(axis, arm) for axis in place.turns)]
        if len(place.turns) == 1:  # a tilt about the slot: the pin bears across it, and slides along itself
            [across] = place.moves
            ways[-1] = (ways[-1] @ across)[..., None] * across
        rows += [wall.load_vector(pressure[..., None] * way, len(space.nodes)) for way in ways]
    found = np.array(rows).reshape(-1, space.unknowns)
    return np.asarray(found / np.linalg.norm(found, axis=1, keepdims=True))
