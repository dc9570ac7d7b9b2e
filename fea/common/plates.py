"""How the two plates of a pair share what acts on their link.

A pin that is put through both plates exerts on the link the force F and the couple (M_x, M_y) about its mid-plane. Each
plate bears half of F, and half of all else. The couple is borne in two ways, both of them by equilibrium. Forces p on
the upper plate and −p on the lower one, ``apart`` between them, make the couple of

    p = (M_y, −M_x)/apart,

the lever law where it is all of it. The forces p of all pins must balance on a plate in its plane,

    Σ p = 0,    Σ r × p = 0,

which the p of the whole couples do wherever no force acts along the pins and no couple twists the link. What does not
balance so, each plate bears by bending and twist of its own, half of it in either: of all ways that with the least
squares of these couples, which is exact for two pins with an even plate between them (a portal frame of two columns).
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.loads.records.applied import PartMass

Real = NDArray[np.float64]

ALIKE = 1e-9
"""Share of the loads below which the difference of both plates' is rounding."""


def plates(loads: LinkLoads, apart: float | None) -> tuple[LinkLoads, ...]:
    """Return what acts on each plate of a link, about its own mid-plane.

    Parameters
    ----------
    loads : LinkLoads
        That act on the link, about its mid-plane, at one pose or at n.
    apart : float or None
        Distance of the plates' mid-planes [mm]; None for a link of one plate.

    Returns
    -------
    tuple of LinkLoads
        The loads as they are for a single plate. Of a pair once where both plates bear the same, else of both, first of
        the one that bears more at its worst pose.
    """
    if apart is None:
        return (loads,)
    half = _halved(loads)
    forces = pair_forces(loads.pins, apart)
    size = [max(_largest(pin.wrench[..., :3]), _largest(pin.wrench[..., 3:5]) / apart) for pin in loads.pins]
    if not _largest(forces) > ALIKE * max(size, default=0.0):
        return (half,)
    found = [_with(half, forces, side, apart) for side in (1.0, -1.0)]
    return tuple(sorted(found, key=lambda plate: -_largest(plate.size(apart))))


def pair_forces(pins: tuple[PinLoad, ...], apart: float) -> Real:
    """Return the forces on the upper plate, beside half of all, by which a pair bears the couples of its pins.

    Parameters
    ----------
    pins : tuple of PinLoad
        On the link.
    apart : float
        Distance of the plates' mid-planes [mm].

    Returns
    -------
    ndarray, shape (..., pins, 2)
        Along x and y [N]; the lower plate has the opposite ones.
    """
    if not pins:
        return np.zeros((0, 2))
    couples = np.stack([pin.wrench[..., 3:5] for pin in pins], axis=-2)
    taken = np.array([[0.0 if pin.slotted else 1.0, 1.0] for pin in pins])  # a slot holds nothing along it
    wanted = np.stack([couples[..., 1], -couples[..., 0]], axis=-1) / apart * taken
    places = np.stack([np.broadcast_to(pin.centre[..., :2], (*couples.shape[:-2], 2)) for pin in pins], axis=-2)
    places = places - places.mean(axis=-2, keepdims=True)
    places = places / (np.abs(places).max() or 1.0)
    one, nothing = np.ones(places.shape[:-1]), np.zeros(places.shape[:-1])
    rows = np.stack(
        [np.stack(row, axis=-1) * taken for row in ((one, nothing), (nothing, one), (-places[..., 1], places[..., 0]))],
        axis=-3,
    )
    flat = (*rows.shape[:-2], -1)
    balance = rows.reshape(flat)
    every = wanted.reshape(*wanted.shape[:-2], -1, 1)
    borne = every - np.linalg.pinv(balance) @ (balance @ every)
    return np.asarray(borne.reshape(wanted.shape))


def _halved(loads: LinkLoads) -> LinkLoads:
    """Return half of all loads, with half of the mass."""

    def half(record: Any, *fields: str) -> Any:
        return replace(record, **{name: getattr(record, name) / 2.0 for name in fields})

    inertia = loads.inertia
    if inertia is not None:
        own = inertia.mass
        mass = PartMass(mass=own.mass / 2.0, centroid=own.centroid, inertia=own.inertia / 2.0)
        inertia = replace(inertia, mass=mass)
    return replace(
        loads,
        pins=tuple(half(pin, "wrench", "friction") for pin in loads.pins),
        couples=tuple(half(couple, "torque") for couple in loads.couples),
        ends=tuple(half(end, "wrench") for end in loads.ends),
        lines=tuple(half(line, "at_start", "at_end") for line in loads.lines),
        inertia=inertia,
    )


def _largest(values: Real) -> float:
    """Return the largest size of all; poses without an answer do not count."""
    return float(np.abs(np.nan_to_num(values, posinf=0.0, neginf=0.0)).max(initial=0.0))


def _with(half: LinkLoads, forces: Real, side: float, apart: float) -> LinkLoads:
    """Return the loads of a plate with its forces (..., pins, 2) in place of the half couples that they make."""
    pins = []
    for number, pin in enumerate(half.pins):
        force, wrench = forces[..., number, :], pin.wrench.copy()
        wrench[..., :2] += side * force
        wrench[..., 3] += force[..., 1] * apart / 2.0
        wrench[..., 4] -= force[..., 0] * apart / 2.0
        pins.append(replace(pin, wrench=wrench))
    return replace(half, pins=tuple(pins))
