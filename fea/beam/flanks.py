"""The stiffness of a bar along its slots: two flanks side by side, joined at the slot's ends, without diagonals.

The flanks are beams of their own that share the turning of the sections at both ends (Vierendeel). The round ends give
a little, so the flanks count a quarter of the slot's width longer at either end (``alula.fea.beam.details`` measured
their stress so). A section's moment over the slot splits into the flanks' own bending and one pair of forces along
them, the same all along the slot, since nothing joins the flanks in between. Lengths in mm, areas in mm², second
moments in mm⁴.
"""

from dataclasses import dataclass

from alula.geometry.parts.part import Body, Pin, Section, rectangle


@dataclass(frozen=True, kw_only=True)
class Flanks:
    """The two flanks of one slot.

    Attributes
    ----------
    first : float
        x from which they count as beams [mm].
    last : float
        x up to which they do [mm].
    height : float
        Of one flank across the slot [mm].
    apart : float
        Distance of their axes [mm].
    one : Section
        Section of one flank.
    """

    first: float
    last: float
    height: float
    apart: float
    one: Section

    @property
    def length(self) -> float:
        """Length of the flanks [mm]."""
        return self.last - self.first

    @property
    def together(self) -> Section:
        """Both flanks with what each resists by itself: i_z is that of two beams which are not joined."""
        return Section(
            area=2.0 * self.one.area,
            i_y=2.0 * self.one.i_y,
            i_z=2.0 * self.one.i_z,
            torsion=2.0 * self.one.torsion,
            half_y=(self.apart + self.height) / 2.0,
            half_z=self.one.half_z,
            round=False,
        )

    @property
    def pair(self) -> float:
        """Second moment A c²/2 of the flanks' areas about the link's axis, which their pair of forces has [mm⁴]."""
        return self.one.area * self.apart**2 / 2.0


def flanks_of(body: Body) -> tuple[Flanks, ...]:
    """Return the flanks of every slot of a link, by rising x.

    Parameters
    ----------
    body : Body
        Geometry of the link.

    Returns
    -------
    tuple of Flanks
        One per slot; none of a part that is no beam.
    """
    if not body.part.is_beam:
        return ()
    return tuple(sorted((_flanks(body, pin) for pin in body.pins if pin.slot > 0.0), key=lambda found: found.first))


def _flanks(body: Body, pin: Pin) -> Flanks:
    height, longer = (body.ring(pin).diameter - pin.diameter) / 2.0, pin.diameter / 4.0
    low, high = pin.span
    return Flanks(
        first=low - longer,
        last=high + longer,
        height=height,
        apart=height + pin.diameter,
        one=rectangle(height, body.ring(pin).thickness),
    )
