"""Coulomb friction at the joints of a moving linkage: forces that balance with it, and where it locks the linkage.

The size of friction follows from the joint forces x, and its sense from the motion. With the equations of equilibrium
A x = b and a unit of friction at every contact, C,

    A x - t sum_k mu_k sgn(v_k) p_k(x) C_k = b

at t = 1. v is the speed at the contact, and p what presses it: the size of the force in a bore (the friction circle has
the radius mu r), times what a couple presses beside it (``alula.loads.statics.pressing``), and the normal force in a
slot and on a guide. Every p is homogeneous of degree one. So x = y / s with

    A y - t sum_k mu_k sgn(v_k) p_k(y) C_k = s b,        |y|^2 + s^2 fixed,

and this system stays regular where the forces grow without bound, at s = 0. It is followed by Newton's method from
t = 0, without friction, to t = 1. Where s vanishes on the way, or no solution goes on, a share t of the friction has
locked the linkage: no drive moves it. Other solutions of the equations are not connected to the frictionless one.

References
----------
Uicker, Pennock and Shigley, Theory of Machines and Mechanisms, static force analysis with friction (friction circle).
Norton, Design of Machinery, 5th ed., chapter 11.
Qi and Sun (1993), A nonsmooth version of Newton's method, Mathematical Programming 58.
Allgower and Georg, Introduction to Numerical Continuation Methods, chapter 2.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.geometry.joints.joint import Joint
from alula.geometry.joints.joint_kinds import Surface
from alula.geometry.linkage.placement import Complex, Placement
from alula.loads.acting.acting import Acting
from alula.loads.records.applied import FrictionLoad, Load, shifted
from alula.loads.statics.joint_reaction import travelled
from alula.loads.statics.statics import NEARLY_SINGULAR, Drive, assemble, joint_column, unknowns_of
from alula.loads.statics.system import System

Real = NDArray[np.float64]
Presses = Mapping[str, Real]
NOTHING_MORE: Presses = {}
"""Bores that no couple presses: each by its force alone."""

STANDS_STILL = 1e-9
"""Share of the links' speeds below which a joint does not move, and has no friction."""
_FIRST_STEP = 0.5
_LEAST_STEP = 1e-9
_SETTLED = 1e-13
_UNBOUNDED = 1e-6
"""Least s over |y| of a solution: forces beyond a million times the frictionless ones count as unbounded."""
_SAME_BRANCH = 0.9
"""Least cosine between two solutions of one step, so that none jumps to another branch."""
_ITERATIONS = 12


@dataclass(frozen=True, kw_only=True, eq=False)
class Friction(Acting):
    """Friction at all joints at n poses, for one direction of the motion.

    It acts, but follows from the joint forces, which all else that acts brings about: it is found after that, for the
    poses at which it was solved. It is none at rest and turns with the sense of the motion, so that where the
    linkage stands does not depend on it.

    Attributes
    ----------
    place : Placement
        The poses, with the derivatives by the coordinate for rates.
    wrenches : mapping of str to array (n, 6)
        Joint with friction -> what its first link exerts on its second by friction, about the second's point, global
        axes [N, N mm]; NaN where the linkage is locked, and zero at dead points of the drive.
    lock : array (n,)
        Share of all coefficients at which the linkage locks itself, at most the one asked for; infinite elsewhere.
    unknowns : array (n, columns)
        Of ``assemble``, with friction [N, N mm]; NaN where it is locked, and at dead points.
    residual : array (n,)
        Largest of the scaled equations, as a share of the load.
    """

    place: Placement
    wrenches: Mapping[str, Real]
    lock: Real
    unknowns: Real
    residual: Real

    @property
    def locked(self) -> NDArray[np.bool_]:
        """True (n,) where no drive moves the linkage."""
        return np.asarray(np.isfinite(self.lock))

    def loads(self, place: Placement) -> tuple[FrictionLoad, ...]:
        """As ``Acting.loads``: at the poses for which it was solved alone."""
        return friction_loads(place, self.wrenches)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Contact:
    """A place that rubs: friction against the motion is the coefficient times what presses it.

    ``force`` and ``moment`` are those of a unit of friction, of the joint's first link on its second. What presses is
    the norm of the ``forms`` of the unknowns where it is ``round``, else the largest of them.
    """

    joint: str
    force: Complex
    moment: Real
    forms: Real
    round: bool
    against: Real

    def pressed(self, scaled: Real) -> tuple[Real, Real]:
        """What presses (n,), and its derivative (n, columns) by the unknowns."""
        values = scaled @ self.forms.T
        if self.round:
            size = np.linalg.norm(values, axis=1)
            whole = np.linalg.norm(scaled, axis=1)
            unit = values / np.where(size > 1e-14 * whole, size, np.inf)[:, None]
            return size, unit @ self.forms
        chosen = values.argmax(axis=1)
        return values.max(axis=1), self.forms[chosen]


def solve_friction(
    place: Placement,
    drive: Drive | None,
    loads: Sequence[Load],
    sense: Real | float,
    *,
    most: float = 1.0,
    presses: Presses = NOTHING_MORE,
) -> Friction:
    """Return the friction that balances with the joint forces that it depends on.

    Parameters
    ----------
    place : Placement
        The n poses, with the derivatives of the unknowns by the coordinate for rates.
    drive : Drive or None
    loads : sequence of Load
        All else that acts on the links, at these poses.
    sense : float or array (n,)
        1 where the coordinate grows, -1 where it falls.
    most : float, optional
        Share of the stated coefficients.
    presses : mapping of str to array (n,), optional
        Joint -> what presses on the wall of its bore over its force; 1 where left out.

    Returns
    -------
    Friction
    """
    system = assemble(place, drive, loads)
    sound = system.regular(NEARLY_SINGULAR)
    matrix = np.where(sound[..., None, None], system.scaled, np.eye(len(system.columns)))
    right = np.where(sound[..., None], system.rhs / system.row_scale, 0.0)  # no load has no friction
    contacts = _contacts(place, system, sense, presses)
    rubbed = [
        contact.against[:, None] * joint_column(place, contact.joint, contact.force, contact.moment) / system.row_scale
        for contact in contacts
    ]
    scaled, lock = _followed(matrix, right, contacts, rubbed, most)
    left = _balance(matrix, contacts, rubbed, most, scaled)[0] - right
    load = np.maximum(np.abs(right).max(axis=1, initial=0.0), 1e-300)
    return Friction(
        place=place,
        wrenches=_wrenches(contacts, most * scaled),
        lock=lock,
        unknowns=np.where(sound[..., None], scaled * system.column_scale, np.nan),
        residual=np.abs(left).max(axis=1) / load,
    )


def friction_under(
    place: Placement, drive: Drive | None, sense: float, joints: Mapping[str, Real], presses: Presses = NOTHING_MORE
) -> tuple[FrictionLoad, ...]:
    """Return the friction that given joint forces make, for models in which it does not follow from equilibrium.

    Parameters
    ----------
    place : Placement
        As for ``solve_friction``.
    drive : Drive or None
    sense : float
        1 where the coordinate grows, -1 where it falls.
    joints : mapping of str to array (n, 6)
        What each joint's first link exerts on its second about the second's point, global axes [N, N mm].
    presses : mapping of str to array (n,), optional
        As for ``solve_friction``.

    Returns
    -------
    tuple of FrictionLoad
    """
    system = assemble(place, drive, ())
    values = np.stack(list(unknowns_of(place, drive, joints).values()), axis=-1)
    return friction_loads(place, _wrenches(_contacts(place, system, sense, presses), values / system.column_scale))


def friction_loads(place: Placement, wrenches: Mapping[str, Real]) -> tuple[FrictionLoad, ...]:
    """Return friction as loads on the links, in pairs that balance.

    It acts at the height of the joint's first link, which has the slot or guide.

    Parameters
    ----------
    place : Placement
        Where the links stand.
    wrenches : mapping of str to array (..., 6)
        Joint -> what its first link exerts on its second, about the second's point, global axes [N, N mm].

    Returns
    -------
    tuple of FrictionLoad
    """
    found = []
    for name, wrench in wrenches.items():
        points = zip(place.linkage.joints[name].links, place.linkage.joint_points(name), strict=True)
        rise = np.array([0.0, 0.0, place.linkage.rise(name)])
        on_first, on_second = shifted(-wrench, travelled(place, name) - rise), shifted(wrench, -rise)
        for (link, point), own in zip(points, (on_first, on_second), strict=True):
            found.append(FrictionLoad(link=link, point=point, wrench=own, joint=name))
    return tuple(found)


def friction_wrenches(loads: Sequence[Load]) -> dict[str, Real]:
    """Return what friction exerts at each joint, from the loads on the links.

    Parameters
    ----------
    loads : sequence of Load
        With those of ``friction_loads`` among them.

    Returns
    -------
    dict of str to array (..., 6)
        Joint -> wrench of its first link on its second about the second's point [N, N mm].
    """
    return {load.joint: load.wrench for load in loads if isinstance(load, FrictionLoad)}  # the second link's comes last


def _wrenches(contacts: Sequence[_Contact], scaled: Real) -> dict[str, Real]:
    """Return what each joint's first link exerts on its second by friction (n, 6), under scaled unknowns."""
    found = {contact.joint: np.zeros((len(scaled), 6)) for contact in contacts}
    for contact in contacts:
        size = -contact.against * contact.pressed(scaled)[0]
        force = size * contact.force
        for i, part in ((0, force.real), (1, force.imag), (5, size * contact.moment)):
            found[contact.joint][:, i] += part
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class _Rubbing:
    """A joint that rubs, for the laws of surfaces."""

    name: str
    place: Placement
    system: System

    @property
    def joint(self) -> Joint:
        return self.place.linkage.joints[self.name]

    @property
    def radius(self) -> float:
        """Of its pin [mm]."""
        return (self.joint.pin_diameter or 0.0) / 2.0

    @cached_property
    def turn(self) -> Real:
        """Speed (n,) of its second link's angle to the first."""
        first, second = self.joint.links
        return np.asarray(self.place.spin(second) - self.place.spin(first))

    @cached_property
    def slid(self) -> Real:
        """Speed (n,) of its second link's point along its slot or guide [mm]."""
        assert self.place.qdot is not None
        column = len(self.place.linkage.moving) + self.place.closure.slots.index(self.name)
        return np.asarray(self.place.qdot[..., column])

    def form(self, unknown: str, factor: float = 1.0) -> Real:
        """Return a multiple of one of its unknowns, as a row for the scaled ones."""
        row, column = np.zeros(len(self.system.columns)), self.system.columns.index(unknown)
        row[column] = factor * self.system.column_scale[column]
        return row


_Law = Iterator[tuple[Complex, float, list[Real], Real]]
"""What each contact of a joint has: its unit of friction, force (n,) and moment; what presses it; its speed (n,)."""


def _in_bore(own: _Rubbing) -> _Law:
    forms = [own.form(f"R{own.name}{axis}") for axis in "xy"]
    yield np.zeros(own.place.shape, dtype=complex), own.radius, forms, own.place.linkage.longest * own.turn


def _on_flanks(own: _Rubbing) -> _Law:
    for side in (1.0, -1.0):  # on the flank below the pin, which a positive force lifts, and on that above it
        forms = [own.form(f"N{own.name}", side), np.zeros(len(own.system.columns))]
        arm = side * own.radius
        yield own.place.along(own.name), arm, forms, own.slid + arm * own.turn


def _on_guide(own: _Rubbing) -> _Law:
    forms, length = [own.form(f"N{own.name}", sign) for sign in (1.0, -1.0)], own.joint.guide_length
    if length is not None:
        forms += [own.form(f"M:{own.name}", sign * 2.0 / length) for sign in (1.0, -1.0)]
    yield own.place.along(own.name), 0.0, forms, own.slid


LAWS: Mapping[Surface, Callable[[_Rubbing], _Law]] = {
    Surface.BORE: _in_bore,
    Surface.FLANKS: _on_flanks,
    Surface.GUIDE: _on_guide,
}


def _contacts(place: Placement, system: System, sense: Real | float, presses: Presses) -> list[_Contact]:
    """Return every contact that rubs, with the signed coefficient (n,) that opposes the motion."""
    linkage, found = place.linkage, []
    speeds = [np.abs(place.velocity(n)) ** 2 + (linkage.longest * place.spin(n)) ** 2 for n in linkage.moving]
    least = STANDS_STILL * np.sqrt(np.sum(speeds, axis=0))
    for name, joint in linkage.joints.items():
        if joint.friction == 0.0:
            continue
        coefficient, surface = joint.friction * presses.get(name, 1.0), joint.kind.rubs
        for force, moment, forms, speed in LAWS[surface](_Rubbing(name=name, place=place, system=system)):
            way = np.where(np.abs(speed) > least, np.sign(speed), 0.0)
            contact = _Contact(
                joint=name,
                force=force,
                moment=np.full(place.shape, moment),
                forms=np.array(forms),
                round=surface is Surface.BORE,
                against=sense * coefficient * way,
            )
            found.append(contact)
    return found


def _balance(
    matrix: Real, contacts: Sequence[_Contact], rubbed: Sequence[Real], share: Real | float, scaled: Real
) -> tuple[Real, Real]:
    """Left side (n, rows) of the equations of equilibrium with a share of the friction, and its derivative."""
    left, slope = (matrix @ scaled[..., None])[..., 0], matrix.copy()
    for contact, column in zip(contacts, rubbed, strict=True):
        size, by = contact.pressed(scaled)
        acting = np.reshape(share, (-1, 1)) * column
        left -= acting * size[:, None]
        slope -= acting[:, :, None] * by[:, None, :]
    return left, slope


def _followed(
    matrix: Real, right: Real, contacts: Sequence[_Contact], rubbed: Sequence[Real], most: float
) -> tuple[Real, Real]:
    """Return the solutions (n, columns) with all friction, and the share (n,) at which the linkage locks itself."""
    free = np.linalg.solve(matrix, right[..., None])[..., 0]
    size = np.linalg.norm(free, axis=1)
    open_at = size > 0.0
    unit = np.where(open_at, size, 1.0)[:, None]
    z = np.concatenate([free / unit, np.ones((len(free), 1))], axis=1) / np.sqrt(2.0)
    share, step = np.zeros(len(z)), np.full(len(z), _FIRST_STEP * most)
    lock = np.full(len(z), np.inf)
    while open_at.any():
        i = np.flatnonzero(open_at)
        step[i] = np.minimum(step[i], most - share[i])
        here = [column[i] for column in rubbed]
        found, good = _corrected(matrix[i], right[i] / unit[i], contacts, here, share[i] + step[i], z[i])
        good &= found[:, -1] > _UNBOUNDED * np.linalg.norm(found[:, :-1], axis=1)
        z[i[good]], share[i[good]] = found[good], share[i[good]] + step[i[good]]
        step[i] *= np.where(good, 2.0, 0.5)
        ended = ~good & (step[i] < _LEAST_STEP * most)
        lock[i[ended]] = share[i[ended]]
        open_at[i] = ~ended & (share[i] < most)
    solved = np.where(np.isfinite(lock)[:, None], np.nan, z[:, :-1] / z[:, -1:] * unit)
    return np.where(size[:, None] > 0.0, solved, 0.0), lock


def _corrected(
    matrix: Real, right: Real, contacts: Sequence[_Contact], rubbed: Sequence[Real], share: Real, start: Real
) -> tuple[Real, NDArray[np.bool_]]:
    """Newton's method in (y, s) on the plane through ``start``; also tell where it settled nearby."""
    z, last = start.copy(), np.full(len(start), np.inf)
    for _ in range(_ITERATIONS):
        left, slope = _balance(matrix, contacts, rubbed, share, z[:, :-1])
        gap = np.concatenate([left - z[:, -1:] * right, (np.sum(start * z, axis=1) - 1.0)[:, None]], axis=1)
        bordered = np.concatenate([np.concatenate([slope, -right[..., None]], axis=2), start[:, None, :]], axis=1)
        try:
            move = np.linalg.solve(bordered, gap[..., None])[..., 0]
        except np.linalg.LinAlgError:
            move = (np.linalg.pinv(bordered) @ gap[..., None])[..., 0]
        z = z - move
        last = np.linalg.norm(move, axis=1) / np.linalg.norm(z, axis=1)
        if np.all(last <= _SETTLED):
            break
    z = z / np.linalg.norm(z, axis=1, keepdims=True)
    return z, (last <= 10.0 * _SETTLED) & (np.sum(start * z, axis=1) >= _SAME_BRANCH)
