"""The net section of a tube with a hole through both walls, against sums over a fine grid of the section."""

import numpy as np
import pytest

from alula.fea.beam.holed_tube import holed_tube_stress
from alula.geometry.bodies.section import ring


def on_grid(outer, inner, diameter, offset, forces, n=2001):
    """Direct stress at the worst point of what is left, from the points of a grid: N/A - M_z y/I_z + M_y z/I_y."""
    y, z = np.meshgrid(*(np.linspace(-outer, outer, n),) * 2)
    r = np.hypot(y, z)
    left = (r <= outer) & (r >= inner) & (abs(y - offset) >= diameter / 2.0)
    y, z, cell = y[left], z[left], (2.0 * outer / (n - 1)) ** 2
    centre = y.mean()
    i_y, i_z = (z**2).sum() * cell, ((y - centre) ** 2).sum() * cell
    bent = (forces[5] + forces[0] * centre) * (y - centre) / i_z
    return forces[0] / (len(y) * cell), float((abs(bent) + abs(forces[4] * z / i_y)).max())


@pytest.mark.parametrize(
    ("inner", "diameter", "offset"),
    [(2.5, 3.0, 0.0), (0.0, 2.0, 0.0), (3.0, 1.6, 1.5), (2.5, 3.0, 1.8), (1.0, 4.0, 0.0)],
)
@pytest.mark.parametrize("forces", [(100, 0, 0, 0, 0, 0), (0, 0, 0, 0, 50, 0), (-80, 0, 0, 0, 20, 60)])
def test_it_is_the_stress_of_the_net_section(inner, diameter, offset, forces):
    forces = np.array(forces, dtype=float)
    axial, bending = on_grid(4.0, inner, diameter, offset, forces)
    found = holed_tube_stress(ring(8.0, 2.0 * inner), diameter, offset, forces)
    assert found.axial == pytest.approx(axial, rel=4e-3)
    assert found.bending == pytest.approx(bending, rel=8e-3, abs=1e-4)
    assert found.equivalent == pytest.approx(abs(found.axial) + found.bending)


def test_shear_grows_as_the_area_falls():
    tube, forces = ring(8.0, 5.0), np.array([0.0, 10.0, 0.0, 30.0, 0.0, 0.0])
    small, large = (holed_tube_stress(tube, d, 0.0, forces) for d in (1e-6, 3.0))
    left = holed_tube_stress(tube, 3.0, 0.0, np.array([1.0, 0, 0, 0, 0, 0])).axial * tube.area
    assert large.torsion / small.torsion == pytest.approx(left, rel=1e-5)
    assert large.shear / small.shear == pytest.approx(left, rel=1e-5)
