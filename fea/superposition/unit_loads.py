"""Unit loads of a link, of which the loads of every pose and load case are sums.

Pins in holes and pins in slots have several unit loads each (``pin_units``, ``slot_units``). Plain ends, spread loads,
weight, inertia and couples are linear as they stand.

A single unit load does not balance, while the loads of a pose do. So the link is held by six isostatic supports, whose
reactions cancel in the sum. Displacements and stresses superpose all the same.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.elements.quadrature import Quadrature, SurfaceQuadrature, surface_quadrature, volume_quadrature
from alula.fea.elements.space import DisplacementSpace
from alula.fea.elements.supports import rigid_motions
from alula.fea.superposition.couple_units import HEIGHTS, CoupleUnits, hats
from alula.fea.superposition.pin_units import HIGHEST_ORDER, PinUnits
from alula.fea.superposition.slot_units import SlotUnits, places_for, unit_pushes
from alula.fea.tractions.slot_traction import DEGREE
from alula.fea.tractions.traction import (
    Transfer,
    body_density,
    bore_middle,
    couple_traction,
    line_density_between,
    wrench_density,
)
from alula.geometry.base.errors import CannotRunError
from alula.geometry.parts.part import Body, Pin
from alula.loads.records.applied import BodyForce, LineLoad, PartMass, shifted
from alula.loads.records.bearing import NARROW, WIDE, PressureLaw

Real = NDArray[np.float64]

TRANSFERS: tuple[Transfer, ...] = ("eye-faces", "bore-shear")
IN_PLANE = [0, 1, 5]
"""Components of a wrench that act in the linkage's plane."""


@dataclass(frozen=True, kw_only=True, eq=False)
class UnitLoads:
    """The unit loads of one link.

    Attributes
    ----------
    space : DisplacementSpace
        Of the link's mesh.
    vectors : sparse matrix, shape (3 nodes, units)
        Consistent load vectors [N].
    wrenches : ndarray, shape (6, units)
        Their resultants about the frame's origin [N, N mm].
    local : ndarray of bool, shape (units,)
        True for the pressure fields, which have no resultant.
    pins : mapping of str to PinUnits
    couple_pins : mapping of str to CoupleUnits
        The pins that bear couples about x and y as well.
    slots : mapping of str to SlotUnits
    slot_tilts : mapping of str to int
        Slot whose pin tilts -> number of its unit moment about x.
    couples : mapping of (str, Transfer) to int
        Pin and transfer -> number of its unit torque.
    ends : mapping of str to slice
        End -> numbers of its unit Fx, Fy and Mz.
    lines : mapping of (float, float) to slice
        First and last station [mm] -> numbers of the unit intensities between them.
    inertia : slice or None
        Numbers of what ``unit_forces`` returns; None where no load moves mass.
    """

    space: DisplacementSpace
    vectors: Any
    wrenches: Real
    local: NDArray[np.bool_]
    pins: Mapping[str, PinUnits]
    couple_pins: Mapping[str, CoupleUnits]
    slots: Mapping[str, SlotUnits]
    slot_tilts: Mapping[str, int]
    couples: Mapping[tuple[str, Transfer], int]
    ends: Mapping[str, slice]
    lines: Mapping[tuple[float, float], slice]
    inertia: slice | None

    @property
    def count(self) -> int:
        """Number of unit loads."""
        return len(self.local)

    def transfers(self, loads: LinkLoads) -> tuple[Transfer | None, ...]:
        """Return the ways in which a link's torques may enter.

        Parameters
        ----------
        loads : LinkLoads
            On the link at the n poses.

        Returns
        -------
        tuple of Transfer or None
            None alone where no torque acts at a pin with flat faces about its hole.
        """
        names = [name for name, torque in _torques(loads).items() if np.any(torque != 0.0)]
        return TRANSFERS if any(self.space.flat_faces(name) for name in names) else (None,)

    def coefficients(self, loads: LinkLoads, law: PressureLaw, transfer: Transfer | None) -> Real:
        """Return what multiplies each unit load at n poses.

        Parameters
        ----------
        loads : LinkLoads
            On the link at the n poses.
        law : PressureLaw
            How a pin presses in its hole.
        transfer : Transfer or None
            Of the torques; None where there is no choice (``transfers``).

        Returns
        -------
        ndarray, shape (units, n)
        """
        found = np.zeros((self.count, loads.poses))
        for pin in loads.pins:
            if pin.name in self.pins:
                units = self.pins[pin.name]
                pressure, force = units.coefficients(pin.wrench[:, :2], law)
                orders = units.cosine.stop - units.cosine.start
                found[units.cosine], found[units.sine] = pressure[:orders], pressure[orders:]
                found[units.force] = force
            elif pin.name in self.couple_pins:
                both = self.couple_pins[pin.name]
                found[both.fields] = both.coefficients(pin.wrench, law)
                found[both.wrench][:5] = pin.wrench[:, :5].T
            elif pin.name in self.slots:
                for numbers, sizes in self.slots[pin.name].coefficients(pin, law):
                    found[numbers] = sizes
                if pin.name in self.slot_tilts:
                    found[self.slot_tilts[pin.name]] = pin.wrench[:, 3]
        for name, torque in _torques(loads).items():
            if np.any(torque != 0.0):
                found[self.couples[name, transfer or TRANSFERS[0]]] += torque
        for name, torque in _friction(loads).items():
            found[self.couples[name, "bore-shear"]] += torque
        for end in loads.ends:
            found[self.ends[end.name]] += end.wrench[:, IN_PLANE].T
        for line in loads.lines:
            found[self.lines[line.start, line.end]] += np.hstack([line.at_start[:, :2], line.at_end[:, :2]]).T
        if self.inertia is not None and loads.inertia is not None:
            own = loads.inertia
            found[self.inertia] += np.vstack(
                [own.specific_force[:, :2].T, own.angular_acceleration, own.angular_speed_squared]
            )
        return found


def unit_loads(
    space: DisplacementSpace,
    body: Body,
    histories: Sequence[LinkLoads],
    *,
    density: float,
    highest: int = HIGHEST_ORDER,
) -> UnitLoads:
    """Build the unit loads of which the loads of one link over a motion are made up.

    Parameters
    ----------
    space : DisplacementSpace
        Of the link's mesh.
    body : Body
        The link's body.
    histories : sequence of LinkLoads
        At the poses of the motion, one record per load case.
    density : float
        Of the material [tonne/mm³]. It spreads weight and inertia over the volume; their resultants are then brought
        to those of the link's mass.
    highest : int, optional
        Order of the pressure's Fourier series.

    Returns
    -------
    UnitLoads

    Raises
    ------
    CannotRunError
        For a surface that the mesh lacks or meshes too coarsely.
    """
    build = _Builder(space)
    pins, couple_pins, slots, slot_tilts = {}, {}, {}, {}
    for pin in body.pins:
        own = [load for history in histories for load in history.pins if load.name == pin.name]
        if any(np.any(load.wrench[:, :5] != 0.0) for load in own):
            tilts = any(np.any(load.wrench[:, 2:5] != 0.0) for load in own)
            if pin.slot > 0.0:
                slots[pin.name] = build.slot(pin, own)
                if tilts:
                    slot_tilts[pin.name] = build.slot_tilt(pin)
            elif tilts:
                couple_pins[pin.name] = build.couple_pin(pin)
            else:
                pins[pin.name] = build.pin(pin, highest)
    centres = {pin.name: np.array([pin.x, pin.y, 0.0]) for pin in body.pins}
    couples = {}
    for name in dict.fromkeys(pin for h in histories for pin, torque in _torques(h).items() if np.any(torque != 0.0)):
        for transfer in TRANSFERS:
            couples[name, transfer] = build.couple(name, centres[name], transfer)
    for name in dict.fromkeys(pin for h in histories for pin in _friction(h)):
        if (name, "bore-shear") not in couples:
            couples[name, "bore-shear"] = build.couple(name, centres[name], "bore-shear")
    points = {end.name: end.point for history in histories for end in history.ends}
    ends = {name: build.end(name, point) for name, point in points.items()}
    stations = dict.fromkeys((line.start, line.end) for h in histories for line in h.lines)
    lines = {between: build.line(*between) for between in stations}
    mass = next((history.inertia.mass for history in histories if history.inertia is not None), None)
    inertia = None if mass is None else build.inertia(mass, density)
    vectors = build.matrix()
    motions = rigid_motions(space.nodes, np.zeros(3)).reshape(6, -1)
    return UnitLoads(
        space=space,
        vectors=vectors,
        wrenches=np.asarray((vectors.T @ motions.T).T),
        local=np.array(build.local),
        pins=pins,
        couple_pins=couple_pins,
        slots=slots,
        slot_tilts=slot_tilts,
        couples=couples,
        ends=ends,
        lines=lines,
        inertia=inertia,
    )


def _torques(loads: LinkLoads) -> dict[str, Real]:
    """All torques about pins (n,) but for friction: of the drive, and of joints and loads that turn."""
    found = {pin.name: np.zeros(loads.poses) if pin.slotted else pin.torque for pin in loads.pins}
    for couple in loads.couples:
        found[couple.pin] = found[couple.pin] + couple.torque
    return found


def _friction(loads: LinkLoads) -> dict[str, Real]:
    """Torques of friction (n,) about the pins in bores that have any."""
    return {pin.name: pin.friction for pin in loads.pins if not pin.slotted and np.any(pin.friction)}


class _Builder:
    """Collects load vectors column by column."""

    def __init__(self, space: DisplacementSpace) -> None:
        self._space = space
        self._columns: list[tuple[NDArray[np.int64], Real]] = []
        self._volume: Quadrature | None = None
        self.local: list[bool] = []

    def _add(self, *vectors: Real, local: bool = False) -> slice:
        start = len(self._columns)
        for vector in vectors:
            rows = np.flatnonzero(vector)
            self._columns.append((rows, vector[rows]))
            self.local.append(local)
        return slice(start, len(self._columns))

    def _vector(self, quadrature: Quadrature, density: Real) -> Real:
        return quadrature.load_vector(density, len(self._space.nodes))

    @property
    def volume(self) -> Quadrature:
        if self._volume is None:
            self._volume = volume_quadrature(self._space)
        return self._volume

    def matrix(self) -> Any:
        """All columns as a sparse matrix (3 nodes, units)."""
        from scipy.sparse import csc_array

        indptr = np.cumsum([0, *(len(rows) for rows, _ in self._columns)])
        rows = np.concatenate([rows for rows, _ in self._columns])
        data = np.concatenate([values for _, values in self._columns])
        return csc_array((data, rows, indptr), shape=(self._space.unknowns, len(self._columns)))

    def pin(self, pin: Pin, highest: int) -> PinUnits:
        """Pressure fields of a pin without their resultants, and the tractions of unit forces."""
        bore, centre, _, lift = self._bore(pin)
        angle = np.arctan2(bore.x[..., 1] - centre[1], bore.x[..., 0] - centre[0])
        rigid = np.array([self._vector(bore, wrench_density(bore, centre, unit)) for unit in np.eye(6)]).T
        fields = [np.cos(n * angle) for n in range(highest + 1)] + [np.sin(n * angle) for n in range(1, highest + 1)]
        densities = [-field[..., None] * bore.normals for field in fields]
        wrench = np.array([bore.wrench(density, centre) for density in densities]).T
        freed = [self._vector(bore, d) - rigid @ w for d, w in zip(densities, wrench.T, strict=True)]
        return PinUnits(
            pin=pin,
            cosine=self._add(*freed[: highest + 1], local=True),
            sine=self._add(*freed[highest + 1 :], local=True),
            force=self._add(*(rigid @ shifted(unit, np.array([0.0, 0.0, -lift])) for unit in np.eye(6)[:2])),
            wrench=wrench,
            wall=angle.ravel(),
        )

    def _bore(self, pin: Pin) -> tuple[SurfaceQuadrature, Real, float, float]:
        """Wall of a hole, the middle of its axis, its radius, and the middle's height above the plane of forces."""
        bore, axis = surface_quadrature(self._space, f"bore:{pin.name}"), np.array([pin.x, pin.y, 0.0])
        centre = bore_middle(bore, axis)
        arm = bore.x - centre
        radius = float((bore.w * np.hypot(arm[..., 0], arm[..., 1])).sum() / bore.w.sum())
        if not 0.9 < 2.0 * radius / pin.diameter < 1.1:
            raise CannotRunError(
                f"the hole at pin {pin.name} measures {2.0 * radius:.4g} mm on the mesh, not {pin.diameter:.4g} mm"
            )
        return bore, centre, radius, float(centre[2] - axis[2])

    def couple_pin(self, pin: Pin) -> CoupleUnits:
        """Pressure fields of a pin at several heights without their resultants, and the tractions of a unit wrench."""
        bore, centre, radius, lift = self._bore(pin)
        arm = bore.x - centre
        angle, z = np.arctan2(arm[..., 1], arm[..., 0]), arm[..., 2]
        heights = np.linspace(float(z.min()), float(z.max()), HEIGHTS)
        rigid = np.array([self._vector(bore, wrench_density(bore, centre, unit)) for unit in np.eye(6)]).T
        waves = [np.cos(n * angle) for n in range(HIGHEST_ORDER + 1)]
        waves += [np.sin(n * angle) for n in range(1, HIGHEST_ORDER + 1)]
        freed = []
        for hat in hats(heights, z):
            for wave in waves:
                density = -(hat * wave)[..., None] * bore.normals
                freed.append(self._vector(bore, density) - rigid @ bore.wrench(density, centre))
        around = 2.0 * np.pi * radius
        return CoupleUnits(
            pin=pin,
            heights=heights,
            length=float(bore.w.sum()) / around,
            second=float((bore.w * z**2).sum()) / around,
            lift=lift,
            fields=self._add(*freed, local=True),
            wrench=self._add(*(rigid @ shifted(unit, np.array([0.0, 0.0, -lift])) for unit in np.eye(6))),
            wall=angle.ravel(),
        )

    def slot_tilt(self, pin: Pin) -> int:
        """Unit moment about x of a pin that tilts between the flanks of its slot."""
        wall, middle = surface_quadrature(self._space, f"bore:{pin.name}", degree=DEGREE), np.array([pin.x, pin.y, 0.0])
        column: int = self._add(self._vector(wall, wrench_density(wall, middle, np.eye(6)[3]))).start
        return column

    def slot(self, pin: Pin, loads: Sequence[PinLoad]) -> SlotUnits:
        """Pushes of a pin on the flanks of its slot without their resultants, and the tractions that deliver these."""
        wall, middle = surface_quadrature(self._space, f"bore:{pin.name}", degree=DEGREE), np.array([pin.x, pin.y, 0.0])
        forces = np.concatenate([load.wrench[:, 1] for load in loads])
        travel = np.concatenate([load.centre[:, 0] for load in loads])[forces != 0.0]
        rigid = [self._vector(wall, wrench_density(wall, middle, np.eye(6)[i])) for i in (1, 5, 0)]
        pushes, places, rubs = {}, {}, {}
        for law in (WIDE, NARROW):
            places[law.span] = places_for(pin, law, float(travel.min()), float(travel.max()))
            for side in (float(s) for s in np.unique(np.sign(forces[forces != 0.0]))):
                at = places[law.span]
                plain = unit_pushes(wall, pin, law, side, at)
                freed = [
                    self._vector(wall, push) - side * (rigid[0] + (x - pin.x) * rigid[1])
                    for x, push in zip(at, plain, strict=True)
                ]
                pushes[law.span, side] = self._add(*freed, local=True)
                if any(np.any(load.friction) for load in loads):
                    turning = -side * pin.pin_diameter / 2.0
                    rubbed = unit_pushes(wall, pin, law, side, at, 1.0)
                    freed = [
                        self._vector(wall, push - other) - (rigid[2] + turning * rigid[1])
                        for push, other in zip(rubbed, plain, strict=True)
                    ]
                    rubs[law.span, side] = self._add(*freed, local=True)
        return SlotUnits(pin=pin, pushes=pushes, places=places, rigid=self._add(*rigid), rubs=rubs)

    def couple(self, name: str, centre: Real, transfer: Transfer) -> int:
        """Unit torque about a pin."""
        faces = self._space.flat_faces(name) if transfer == "eye-faces" else ()
        names = faces or (f"bore:{name}",)
        surface: SurfaceQuadrature = surface_quadrature(self._space, *names)
        column: int = self._add(self._vector(surface, couple_traction(surface, centre, 1.0))).start
        return column

    def end(self, name: str, point: Real) -> slice:
        """Fx, Fy and Mz on a plain end."""
        patch = surface_quadrature(self._space, f"end:{name}")
        units = np.eye(6)[IN_PLANE]
        return self._add(*(self._vector(patch, wrench_density(patch, point, unit)) for unit in units))

    def line(self, first: float, last: float) -> slice:
        """Unit intensity along x and y at the first station, then at the last."""
        found = []
        for unit in np.eye(6)[[0, 1, 3, 4]]:
            load = LineLoad(link="", start=first, end=last, at_start=unit[:3], at_end=unit[3:], axes="link")
            own, density = line_density_between(self.volume, load)
            found.append(self._vector(self.volume.only(own), density))
        return self._add(*found)

    def inertia(self, mass: PartMass, density: float) -> slice:
        """Unit specific forces along x and y, unit angular acceleration, unit squared angular speed."""
        origin, found = np.zeros(3), []
        for load in unit_forces(mass):
            spread = body_density(self.volume, load, density)
            missing = LinkLoads(name="", inertia=load).resultant() - self.volume.wrench(spread, origin)
            found.append(self._vector(self.volume, spread + wrench_density(self.volume, origin, missing)))
        return self._add(*found)


def unit_forces(mass: PartMass) -> tuple[BodyForce, ...]:
    """Return unit specific forces along x and y, unit angular acceleration and unit squared angular speed.

    Parameters
    ----------
    mass : PartMass
        Of the link.

    Returns
    -------
    tuple of BodyForce
        The four, in link axes [mm/s², rad/s², rad²/s²].
    """
    return tuple(
        BodyForce(
            link="",
            mass=mass,
            specific_force=np.array([*unit[:2], 0.0]),
            angular_acceleration=unit[2],
            angular_speed_squared=unit[3],
            axes="link",
        )
        for unit in np.eye(4)
    )
