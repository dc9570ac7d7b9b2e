"""Straight frames with mass, whose natural frequencies have closed forms."""

import numpy as np

from alula.fea.frame.linear import solve_frame
from alula.fea.frame.model import FrameElement, FrameModel, NodeLoad, Support
from alula.fea.nonlinear.corotational import subdivide
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.stability import stiffness_parts
from alula.fea.vibration.linkage_modes import frame_modes
from alula.fea.vibration.mass_matrix import MassMatrix, beam_mass
from alula.fea.vibration.modes import frequency
from alula.geometry.bodies.section import Section

YOUNG, POISSON, DENSITY, LENGTH = 3000.0, 0.3, 1.2e-9, 100.0


def rectangle(width, height):
    """Section with its width in the linkage's plane."""
    i_z, i_y = height * width**3 / 12.0, width * height**3 / 12.0
    return Section(
        area=width * height,
        i_y=i_y,
        i_z=i_z,
        torsion=0.2 * (i_y + i_z),
        half_y=width / 2.0,
        half_z=height / 2.0,
        round=False,
    )


def straight(section, first, last, loads=(), springs=()):
    """A beam along x with what holds its two ends."""
    return FrameModel(
        nodes=np.array([[0.0, 0, 0], [LENGTH, 0, 0]]),
        elements=(FrameElement(nodes=(0, 1), section=section, young=YOUNG, poisson=POISSON),),
        supports=tuple(Support(node=i, dofs=frozenset(d)) for i, d in enumerate((first, last)) if d),
        loads=tuple(NodeLoad(node=node, wrench=np.array(wrench)) for node, wrench in loads),
        springs=tuple(springs),
    )


def eigenvalues(model, count, parts=8, bodies=(), density=DENSITY):
    """λ [rad²/s²] of the lowest modes, under the model's own loads."""
    divided = subdivide(model, parts)
    linear = solve_frame(divided)
    path = EquilibriumPath(divided)
    K, G = stiffness_parts(path, linear.end_forces, linear.guide_forces)
    beams = np.array(
        [beam_mass(divided, i, np.full(4, density * e.section.area)) for i, e in enumerate(divided.elements)]
    )
    return frame_modes(path, K + G, MassMatrix(model=divided, beams=beams, bodies=tuple(bodies)), count).values


def frequencies(*args, **options):
    """The same in Hz."""
    return np.array([frequency(value) for value in eigenvalues(*args, **options)])
