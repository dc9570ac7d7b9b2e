"""What the edge of a clamp adds to the stress of the part that it holds.

No model here has the contact of part and clamp: the solid bears the reaction as a smooth traction, and beam theory
none. In truth the edge presses into the part, the more the sharper it is. Photoelastic shafts under a plain
press-fitted collar bore 1.95 times the nominal bending stress at its edge, and 1.34 times with a groove beside it. The
larger of the two is taken for all clamps, as the upper end of a band; a hard edge without any rounding may be worse.

References
----------
Peterson & Wahl, Fatigue of shafts at fitted members, with a related photoelastic analysis, J. Appl. Mech. 57 (1935)
A1-A11; in Pilkey & Pilkey, Peterson's Stress Concentration Factors, 3rd ed., section 5.5.
"""

from alula.fea.beam.critical_locations import forces_at
from alula.fea.beam.section_stress import equivalent_stress
from alula.fea.beam.theory import BeamCheck
from alula.fea.common.reason import reason
from alula.fea.common.scatter import Scatter
from alula.fea.common.source import Source, SourceKind
from alula.geometry.bodies.body import clamped_end, mouth
from alula.geometry.parts.part import Body

EDGE = 1.95
"""Most that the edge of a clamp makes of the nominal stress at its mouth."""
CLAMP = Source(kind=SourceKind.CLAMP, detail=reason("times_stress_at_mouth", factor=EDGE), width=EDGE)
CLAMP_SCATTER = Scatter(low=1.0, high=EDGE, sources=(CLAMP,))
"""The same for the largest stress of a link, where it is not told from that at the mouth."""


def edge_stress(body: Body, beam: BeamCheck, largest: float) -> float:
    """Return the most that the edges of a link's clamps may make of its stress there.

    Parameters
    ----------
    body : Body
        Geometry of the link.
    beam : BeamCheck
        The link by beam theory.
    largest : float
        Its largest stress [MPa], which stands for the nominal one where its part is no beam.

    Returns
    -------
    float
        [MPa]; 0 where nothing is clamped.
    """
    if clamped_end(body) is None:
        return 0.0
    if not body.part.is_beam:
        return EDGE * largest
    mouths = [mouth(body, end) for end in body.ends if end.clamped]
    nominal = [
        float(equivalent_stress(body.section_at(x), forces_at(beam.forces, x, side)[None], beam.poisson)[0])
        for x in mouths
        for side in ("before", "after")
    ]
    return EDGE * max(nominal)
