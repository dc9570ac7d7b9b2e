"""Consistent nodal loads of all that acts on one link as a solid."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.quadrature import Quadrature, SurfaceQuadrature, surface_quadrature, volume_quadrature
from alula.fea.elements.space import DisplacementSpace
from alula.fea.tractions.slot_traction import DEGREE, slot_traction
from alula.fea.tractions.traction import (
    Transfer,
    body_density,
    couple_traction,
    line_density_between,
    pin_traction,
    thrust_traction,
    wrench_density,
)
from alula.geometry.base.errors import CannotRunError
from alula.loads.records.applied import LineLoad
from alula.loads.records.bearing import PressureLaw, Span


@dataclass(frozen=True, kw_only=True, eq=False)
class Variant:
    """One load case under one model of pin pressure and one of torque transfer.

    Attributes
    ----------
    name : str
        Of the load case.
    span : Span
        Loaded angle of the pin holes [degrees].
    transfer : Transfer or None
        How the drive torque enters; None where the link carries no torque, or only where no flat face is.
    load : ndarray, shape (3n,)
        Consistent nodal forces [N].
    scale : float
        Sum of all forces, and of all moments over the link's size [N].
    """

    name: str
    span: Span
    transfer: Transfer | None
    load: NDArray[np.float64]
    scale: float


class LoadVectors:
    """Consistent load vectors of the loads on one link; surfaces, and what acts spread, are integrated once."""

    def __init__(self, space: DisplacementSpace, density: float) -> None:
        self._space = space
        self._density = density
        self._surfaces: dict[tuple[str, ...], SurfaceQuadrature] = {}
        self._units: dict[tuple[float, float, int], tuple[NDArray[np.int64], NDArray[np.float64]]] = {}
        self._inertia: tuple[bytes, float, NDArray[np.float64]] | None = None
        self._size = float(np.linalg.norm(np.ptp(space.nodes, axis=0)))

    def variants(self, case: LinkLoads, laws: Sequence[PressureLaw], transfers: Sequence[Transfer]) -> list[Variant]:
        """Return every variant of a load case.

        Parameters
        ----------
        case : LinkLoads
            Loads of the link.
        laws : sequence of PressureLaw
            Of pin pressure.
        transfers : sequence of Transfer
            Of the drive torque; they count only where the link carries a torque at a pin with flat faces about its
            hole, since else it can enter through the bore alone.

        Returns
        -------
        list of Variant
            One per law and transfer.
        """
        torque = any(torque != 0.0 and self._space.flat_faces(name) for name, torque in self._torques(case))
        scale, rest = self._scale(case), self._ends(case) + self.spread(case)
        turned = {transfer: self._couples(case, transfer) for transfer in (transfers if torque else (None,))}
        found = []
        for law in laws:
            pushed = rest + self._pins(case, law)
            for transfer, couples in turned.items():
                load = pushed + couples
                found.append(Variant(name=case.name, span=law.span, transfer=transfer, load=load, scale=scale))
        return found

    def _torques(self, case: LinkLoads) -> list[tuple[str, float]]:
        """Pins and the torques about them: of the drive, and of pins that turn the link otherwise than by friction."""
        turning = [(pin.name, float(pin.torque)) for pin in case.pins if not pin.slotted]
        return [(couple.pin, couple.torque) for couple in case.couples] + turning

    def _surface(self, *names: str, degree: int | None = None) -> SurfaceQuadrature:
        if names not in self._surfaces:
            options = {} if degree is None else {"degree": degree}
            self._surfaces[names] = surface_quadrature(self._space, *names, **options)
        return self._surfaces[names]

    @cached_property
    def _volume(self) -> Quadrature:
        return volume_quadrature(self._space)

    def _scale(self, case: LinkLoads) -> float:
        """Sum of all forces, and of all moments over the link's size [N]: what a resultant is compared with."""
        wrenches = [p.wrench for p in case.pins] + [e.wrench for e in case.ends]
        total = sum(float(np.linalg.norm(w[:3]) + np.linalg.norm(w[3:]) / self._size) for w in wrenches)
        total += sum(abs(c.torque) / self._size for c in case.couples)
        for line in case.lines:
            total += float(np.linalg.norm([line.at_start, line.at_end], axis=1).mean()) * (line.end - line.start)
        if case.inertia is not None:
            total += self._inert(case)[0]
        if total == 0.0:
            raise CannotRunError(f"load case '{case.name}' puts no load on the link; leave it out")
        return float(total)

    def _pins(self, case: LinkLoads, law: PressureLaw) -> NDArray[np.float64]:
        """Load vector (3n,) of the pins' pressures and thrusts."""
        count = len(self._space.nodes)
        load = np.zeros(3 * count)
        for pin in case.pins:
            bore = self._surface(f"bore:{pin.name}", degree=DEGREE if pin.slotted else None)
            push = slot_traction if pin.slotted else pin_traction
            load += bore.load_vector(push(bore, pin, law), count)
            if pin.wrench[2] != 0.0:
                load += self._thrust(pin, bore)
        return load

    def _thrust(self, pin: PinLoad, bore: SurfaceQuadrature) -> NDArray[np.float64]:
        """Load vector (3n,) of a pin's force along z: on a flat face, or where there is none evenly in the bore."""
        count = len(self._space.nodes)
        if not self._space.flat_faces(pin.name):
            target = np.array([0.0, 0.0, pin.wrench[2], 0.0, 0.0, 0.0])
            return np.asarray(bore.load_vector(wrench_density(bore, pin.centre, target), count))
        face = self._surface(f"{'bottom' if pin.wrench[2] > 0.0 else 'top'}:{pin.name}")
        return np.asarray(face.load_vector(thrust_traction(face, pin), count))

    def _couples(self, case: LinkLoads, transfer: Transfer | None) -> NDArray[np.float64]:
        """Load vector (3n,) of the torques about the pins; friction enters as shear in the bore."""
        count = len(self._space.nodes)
        load = np.zeros(3 * count)
        centres = {pin.name: pin.centre for pin in case.pins}
        for name, torque in self._torques(case):
            if torque != 0.0:
                bore = self._surface(f"bore:{name}")
                faces = self._space.flat_faces(name) if transfer != "bore-shear" else ()
                surface = self._surface(*faces) if faces else bore
                load += surface.load_vector(couple_traction(surface, centres.get(name, bore.centroid), torque), count)
        for pin in case.pins:
            if pin.friction != 0.0 and not pin.slotted:
                bore = self._surface(f"bore:{pin.name}")
                load += bore.load_vector(couple_traction(bore, pin.centre, float(pin.friction)), count)
        return load

    def _ends(self, case: LinkLoads) -> NDArray[np.float64]:
        """Load vector (3n,) of the wrenches on plain ends."""
        count = len(self._space.nodes)
        load = np.zeros(3 * count)
        for end in case.ends:
            patch = self._surface(f"end:{end.name}")
            load += patch.load_vector(wrench_density(patch, end.point, end.wrench), count)
        return load

    def spread(self, case: LinkLoads) -> NDArray[np.float64]:
        """Return the load vector of weight and inertia and of loads spread along the axis.

        Parameters
        ----------
        case : LinkLoads
            Loads of the link.

        Returns
        -------
        ndarray, shape (3n,)
            Nodal forces [N].
        """
        load = np.zeros(3 * len(self._space.nodes))
        if case.inertia is not None:
            load += self._inert(case)[1]
        for line in case.lines:
            for component in np.flatnonzero(np.concatenate([line.at_start, line.at_end])):
                nodal, unit = self._unit(line.start, line.end, int(component))
                load[nodal] += float((line.at_start, line.at_end)[component // 3][component % 3]) * unit
        return load

    def _unit(self, start: float, end: float, component: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Where a line load of unit intensity loads nodes, and how; along x, y, z at its start, then at its end.

        Loads of many ways act between the same stations; each is a sum of these.
        """
        if (start, end, component) not in self._units:
            at = np.eye(6)[component]
            line = LineLoad(link="", start=start, end=end, at_start=at[:3], at_end=at[3:], axes="link")
            own, density = line_density_between(self._volume, line)
            found = self._volume.only(own).load_vector(density, len(self._space.nodes))
            nodal = np.flatnonzero(found)
            self._units[start, end, component] = nodal, found[nodal]
        return self._units[start, end, component]

    def _inert(self, case: LinkLoads) -> tuple[float, NDArray[np.float64]]:
        """Sum of the sizes of weight and inertia [N], and their load vector (3n,).

        Their resultant is that on the link's own mass, which a coarse mesh, with chords in place of arcs, misses.
        """
        assert case.inertia is not None
        affine = case.inertia.per_mass(np.vstack([np.zeros(3), np.eye(3)]))  # in place: these four tell all
        told = affine.tobytes() + case.on_mass.tobytes()
        if self._inertia is None or self._inertia[0] != told:
            density = body_density(self._volume, case.inertia, self._density)
            missing = case.on_mass - self._volume.wrench(density, np.zeros(3))
            density = density + wrench_density(self._volume, np.zeros(3), missing)
            size = float((self._volume.w * np.linalg.norm(density, axis=2)).sum())
            self._inertia = told, size, self._volume.load_vector(density, len(self._space.nodes))
        return self._inertia[1:]
