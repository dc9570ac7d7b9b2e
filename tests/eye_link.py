"""A tube with three eyes under bending, pull and torque, as a task for solid models."""

import numpy as np

from alula.fea.beam.cut_free import beam_loads
from alula.fea.beam.theory import BeamCheck, check_beam
from alula.fea.common.link_loads import LinkLoads, PinLoad
from alula.fea.refine.link_task import LinkTask
from alula.geometry.parts.part import Body, HoleRow, Pin, Tube

TUBE = Tube(
    shape="tube",
    material="any",
    outer_diameter="5 mm",
    inner_diameter="2.5 mm",
    eye_diameter="8 mm",
    eye_thickness="7 mm",
    fillet_radius="0.8 mm",
)
PLACES = {"A": 0.0, "B": 36.0, "C": 72.0}


def task(limit: float = 10.0, *, stretch: float = 1.0, holes: tuple[HoleRow, ...] = ()) -> LinkTask:
    """Three-point bending in the plane with a pull and a torque; ``limit`` on its stress [MPa].

    ``stretch``: factor on its length.
    """
    forces = {"A": [-6.0, -2.0], "B": [1.0, 4.0], "C": [5.0, -2.0]}
    torques = {"A": -5.0, "B": 0.0, "C": 5.0}
    pins = tuple(
        PinLoad(
            name=name,
            centre=np.array([stretch * x, 0.0, 0.0]),
            diameter=1.5,
            wrench=np.array([*forces[name], 0.0, torques[name], 0.0, 0.0]),
        )
        for name, x in PLACES.items()
    )
    return LinkTask(
        body=Body(
            part=TUBE,
            pins=tuple(Pin(name=name, x=stretch * x, y=0.0, diameter=1.5) for name, x in PLACES.items()),
            ends=(),
            holes=holes,
        ),
        loads=(LinkLoads(name="mixed", pins=pins),),
        E=2400.0,
        nu=0.38,
        density=1.4e-9,
        line=("bore:A", "bore:C"),
        brittle=False,
        stress_limits=((limit, limit),),
        displacement_limits=(),
    )


def beam(what: LinkTask) -> BeamCheck:
    """Hand calculation of its one load case."""
    return check_beam(beam_loads(what.loads[0], what.body, what.density), what.body.part.section, 1.0)
