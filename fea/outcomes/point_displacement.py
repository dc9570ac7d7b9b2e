"""How far a point of the linkage moves: by the links' solids where these are solved, else by the frame."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fea.beam.cut_free import beam_loads, link_loads
from fea.beam.deflection import virtual_work as plain_work
from fea.beam.theory import internal_forces
from fea.common.band import Band
from fea.common.link_loads import LinkLoads
from fea.common.scatter import compliance_scatter, load_scatter
from fea.common.source import CONTACT, Source, SourceKind, distinct, pin_sources
from fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from fea.frame.displacement_band import point_bounds
from fea.nonlinear.large_displacement import LARGE, LargeDisplacement, displaced
from fea.nonlinear.stability import SNAP, growth
from fea.outcomes.result import LinkResult, SolidResult
from fea.solid.virtual_work import virtual_work
from loads.case.case import Case
from loads.records.applied import PointLoad
from loads.records.check_spec import DisplacementCheck
from loads.statics.statics import solve_statics

NOTHING = 1e-9
"""Share of the unit load that is rounding: in what a link bears of it, and in what is left over of its balance."""
SINKING = Source(kind=SourceKind.SINKING, detail="pins move as the mean of their bores, or follow the side they press")
MESHES = Source(kind=SourceKind.DISCRETISATION, detail="of every link's solid, as that of its largest displacement")


@dataclass(frozen=True, kw_only=True)
class Shares:
    """Which model tells what every link adds to the displacement of a point.

    Attributes
    ----------
    solids : dict of str to tuple of Band
        Link, and what its solid adds along x and y [mm].
    carried : dict of str to tuple of float
        The same of its plain beam, where the solid bears the loads of the deformed shape [mm].
    beams : tuple of str
        Links that add something by their beams in the frame.
    driven : bool
        Whether a drive torque acts on one of the solids.
    """

    solids: Mapping[str, tuple[Band, ...]]
    carried: Mapping[str, tuple[float, ...]]
    beams: tuple[str, ...] = ()
    driven: bool = False

    @property
    def model(self) -> str:
        """Which model gives the displacement, for people."""
        if not self.solids:
            return "the frame of the linkage"
        found = f"virtual work of the solid model{'s' if len(self.solids) > 1 else ''} of {', '.join(self.solids)}"
        return found + (f" and of the frame's beams of {', '.join(self.beams)}" if self.beams else "")

    @property
    def sources(self) -> tuple[Source, ...]:
        """What makes it uncertain."""
        eyes = (Source(kind=SourceKind.EYES),) if self.beams or not self.solids else ()
        if not self.solids:
            return eyes
        pins = (source for source in pin_sources(driven=self.driven) if source != CONTACT)
        return (MESHES, *pins, SINKING, *eyes)


def point_outcome(
    case: Case,
    name: str,
    check: DisplacementCheck,
    load_case: str,
    moved: LargeDisplacement,
    links: Mapping[str, LinkResult],
    free: Mapping[str, LinkLoads],
) -> CheckOutcome:
    """Return the outcome of how far a point of the linkage moves: linear, or on the deformed shape where that rules.

    Parameters
    ----------
    case : Case
    name : str
        Of the check.
    check : DisplacementCheck
        One that names a point.
    load_case : str
        Its name.
    moved : LargeDisplacement
        The frame's answer.
    links : mapping of str to LinkResult
    free : mapping of str to LinkLoads
        Loads of every link cut free; empty where equilibrium alone does not give the joint forces.

    Returns
    -------
    CheckOutcome
    """
    link, point = case.displaced_point(name, check)
    displacement, factor, value, shares = (
        moved.points.get((link, point)),
        moved.factor,
        Band.unknown(),
        Shares(solids={}, carried={}),
    )
    why = f"the frame gives no displacement: {moved.sentence}"
    if displacement is not None and moved.state in ("small", "deformed", "off"):
        size = float(np.linalg.norm(displacement))
        near = factor is not None and factor < SNAP
        shares = _shares(case, moved, links, free, link, point)
        blind = [other for other in shares.beams if not _has_centre_line(case, other)]
        if blind:
            taken = "rigid" if blind[0] == case.linkage.ground else "a beam along its axis"
            why = f"the frame takes link {blind[0]} for {taken}, which does not tell how far it gives"
            if free and moved.state == "small" and not isinstance(links[blind[0]], SolidResult):
                why += "; its solid model does: run --fidelity solid"
        elif moved.followed or not (near or size > LARGE * moved.span):
            value, why = _band(case, load_case, moved, link, point, size, shares), ""
        else:
            far = f"moves it by {size:.3g} mm, above {100.0 * LARGE:g} % of the span"
            what = f"may give way at {factor:.3g} times the load or less, below {SNAP:.3g}" if near else far
            why = f"the linear frame {what}, so it is not valid; remove large_displacement = off from the case"
    subject = Subject.point(point, link)
    found = CheckOutcome.of(name, subject, load_case, Quantity.DISPLACEMENT, value, check.maximum, why)
    if why:
        return found
    shape = "on its deformed shape" if moved.followed else "by linear theory"
    notes = list(() if moved.frame is None else moved.frame.notes)
    by_hand = free and any(not isinstance(links[other], SolidResult) for other in shares.beams)
    if by_hand and found.verdict is Verdict.UNDECIDED:
        notes.append("solid models of all links, --fidelity solid, have a narrower band")
    return found.because("; ".join([f"by {shares.model}, {shape}: {found.reason}", *notes]))


def _shares(
    case: Case,
    moved: LargeDisplacement,
    links: Mapping[str, LinkResult],
    free: Mapping[str, LinkLoads],
    link: str,
    point: str,
) -> Shares:
    """Work that unit loads at a point do on every link, by its solid where one was solved under the load case."""
    assert moved.frame is not None
    if not free:
        return Shares(solids={}, carried={}, beams=case.checked_links)
    pose, held = moved.frame.pose, moved.frame.held
    longest = pose.linkage.longest
    units = [PointLoad(link=link, point=point, wrench=unit) for unit in np.eye(6)[:2]]
    reactions = [solve_statics(pose, held, (unit,)) for unit in units]
    solids, carried, beams, driven = {}, {}, [], False
    for name, real in free.items():
        every = zip(reactions, units, strict=True)
        virtual = [link_loads("unit", name, case.body(name), forces, (unit,)) for forces, unit in every]
        if real.size(longest) == 0.0 or max(loads.size(longest) for loads in virtual) <= NOTHING:
            continue
        # A load along a slot, at the pin in it, balances on no solid.
        left = max(np.abs(loads.resultant() / np.repeat([1.0, longest], 3)).max() for loads in virtual)
        result, body = links[name], case.body(name)
        plain = all(pin.foot is None and pin.slot == 0.0 for pin in body.pins) and _has_centre_line(case, name)
        known = moved.state == "small" or plain
        if isinstance(result, SolidResult) and not result.displacement_max.unknowable and left <= NOTHING and known:
            if moved.state != "small":
                carried[name] = tuple(_beam_work(case, name, real, loads) for loads in virtual)
            solids[name] = virtual_work(
                result.solution,
                real,
                virtual,
                transfer=case.torque_transfer,
                error=result.discretisation.displacement.index,
            )
            driven = driven or any(loads.couples for loads in (real, *virtual))
        else:
            beams.append(name)
    return Shares(solids=solids, carried=carried, beams=tuple(beams), driven=driven)


def _has_centre_line(case: Case, link: str) -> bool:
    """Whether a frame bounds how far a link gives; it does not know the ground's part."""
    return link != case.linkage.ground and case.part_of(link).has_centre_line(case.body(link))


def _beam_work(case: Case, link: str, real: LinkLoads, virtual: LinkLoads) -> float:
    """Work of virtual loads on a link's plain beam [N mm]."""
    body, material = case.body(link), case.material_of(link)
    first, second = (internal_forces(beam_loads(loads, body, material.density)) for loads in (real, virtual))
    section, young, poisson = case.part_of(link).section, material.youngs_modulus, material.poissons_ratio
    return plain_work(first, second, section, young=young, poisson=poisson)


def _band(
    case: Case, load_case: str, moved: LargeDisplacement, link: str, point: str, size: float, shares: Shares
) -> Band:
    """Band of how far a point moves: what solids or beams leave open, the moduli, and the load.

    The linear answer may grow as a toggle does (``fea.nonlinear.stability``); on the deformed shape equilibrium is
    sought again with the ends of load over stiffness, and with solids for the value: in a frame that is softer by the
    solids' linear displacement over the frame's own.
    """
    assert moved.frame is not None
    assert moved.solution is not None
    load, frame = load_scatter(case, load_case), moved.frame
    materials = [case.material_of(other) for other in case.checked_links]
    ratios = [m.youngs_modulus / e for m in materials for e in (m.youngs_modulus_range or ())]
    linear = float(np.linalg.norm(moved.solution.displacements[frame.points[link, point], :3]))
    found = point_bounds(case, frame, moved.solution, link, point, shares.solids, shares.carried)
    # The ground's part is in no frame: it adds to the displacement, but does not make the frame softer.
    bending = {other: bands for other, bands in shares.solids.items() if other != case.linkage.ground}
    framed = found
    if len(bending) < len(shares.solids):
        framed = point_bounds(case, frame, moved.solution, link, point, bending, shares.carried)
    slack = min((*ratios, 1.0)) * load.low, max((*ratios, 1.0)) * load.high
    moduli = (compliance_scatter(material).sources for material in materials)
    sources = distinct(shares.sources, *moduli, load.sources)
    low, high = (framed.low / linear, framed.high / linear) if linear > 0.0 else (1.0, 1.0)
    low, high = low * slack[0], high * slack[1]
    if moved.followed:
        if shares.solids and linear > 0.0:
            softer = displaced(frame, link, point, found.value / linear)
            size = softer if math.isfinite(softer) else size
        ends = [displaced(frame, link, point, factor) for factor in (low, high) if factor > 0.0]
        return Band(value=size, low=min(size, *ends) if low > 0.0 else 0.0, high=max(size, *ends), sources=sources)
    near_by = 0.0 if moved.factor is None else high / moved.factor
    grown = growth(1.0 / near_by) if near_by > 0.0 else 1.0
    value = found.value if shares.solids else size
    grows = Source(kind=SourceKind.GROWTH, detail="towards buckling or a dead point")
    return Band(
        value=value,
        low=min(found.low * slack[0], value),
        high=max(found.high * slack[1] * grown, value),
        sources=(*sources, grows),
    )
