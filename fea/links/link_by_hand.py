"""What acts on one link cut free, with the growth of its bending, and its hand calculation, in one state or in many."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from alula.fea.beam.calibration import calibration_of, uncalibrated
from alula.fea.beam.critical_locations import critical_locations, displacement_estimate
from alula.fea.beam.cut_free import link_loads
from alula.fea.beam.deflection import Deflection, deflection
from alula.fea.beam.details import Detail, details, has_details, remarks
from alula.fea.beam.flanks import flanks_of
from alula.fea.beam.loads import BeamLoads, PointLoad
from alula.fea.beam.piecewise import Piecewise, divided
from alula.fea.beam.section_stress import SectionStress
from alula.fea.beam.theory import BeamCheck, check_beam, internal_forces, largest_stress
from alula.fea.buckling.buckling import least_factor, least_factors
from alula.fea.common.link_loads import LinkLoads, Plates, stacked
from alula.fea.common.plates import plates
from alula.fea.common.reason import Reason
from alula.fea.links.on_axis import on_axis
from alula.fea.links.second_order import second_order_loads
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.outcomes.unloaded import without_rounding
from alula.geometry.base.errors import CannotRunError
from alula.geometry.bodies.body import Body, hand_section, no_beam, reference_line
from alula.geometry.materials.material import Material
from alula.loads.case.case import Case
from alula.loads.case.forks import apart
from alula.loads.records.applied import Load, load_size
from alula.loads.statics.statics import Reactions

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class LinkByHand:
    """The hand calculation of one link under one load case.

    Attributes
    ----------
    check : BeamCheck
        Stresses of the plain sections.
    displacement : float
        The largest [mm].
    details : tuple of Detail
        Places that have a stress formula of their own.
    remarks : tuple of Reason or str
        What the reader must know about these numbers.
    """

    check: BeamCheck
    displacement: float
    details: tuple[Detail, ...]
    remarks: tuple[Reason | str, ...]

    @property
    def worst(self) -> tuple[float, SectionStress]:
        """Station and stresses of the plain section or the detail that bears most."""
        found = [(self.check.worst_x, self.check.worst), *((d.x, d.stress) for d in self.details)]
        return max(found, key=lambda place: place[1].equivalent)


def cut_link(
    case: Case,
    link: str,
    load_case: str,
    moved: LargeDisplacement,
    reactions: Reactions,
    loads: Sequence[Load],
) -> tuple[LinkLoads, ...]:
    """Return what acts on a link, with the second-order bending that the frame does not contain.

    A frame on its deformed shape lacks the bending between loaded places. Where no frame tells, all second-order
    bending is added, as it is to the ground's part, which is rigid in the frame. Nothing is added where a frame found
    it small, or found no stable shape.

    Parameters
    ----------
    case : Case
    link, load_case : str
    moved : LargeDisplacement
        The frame's answer.
    reactions : Reactions
        What the joints carry.
    loads : sequence of Load
        All else that acts.

    Returns
    -------
    tuple of LinkLoads
        One; of a pair whose plates bear differently, that of each plate (``alula.fea.common.plates``).
    """
    deformed, longest = moved.links.get(link), case.linkage.longest
    if deformed is None:
        found = acting_on(case, load_case, link, moved.reactions or reactions, loads)
    else:
        found = without_rounding(deformed, load_size(loads, longest), longest)
    borne = on_plates(case, link, found)
    if deformed is None and moved.state not in ("off", "unknown") and link != case.linkage.ground:
        return borne
    return tuple(second_order_loads(case, link, plate, stays=deformed is not None) for plate in borne)


def acting_on(case: Case, load_case: str, link: str, reactions: Reactions, loads: Sequence[Load]) -> LinkLoads:
    """Return what acts on a link on the linkage's own shape; nothing where that is but rounding.

    Parameters
    ----------
    case : Case
    load_case, link : str
    reactions : Reactions
        What the joints carry.
    loads : sequence of Load
        All else that acts.

    Returns
    -------
    LinkLoads
    """
    longest = case.linkage.longest
    found = link_loads(load_case, link, case.body(link), reactions, loads)
    return without_rounding(found, load_size(loads, longest), longest)


def on_plates(case: Case, link: str, loads: LinkLoads) -> Plates:
    """Return what acts on a link, or on each plate of a pair whose plates bear differently.

    Parameters
    ----------
    case : Case
    link : str
    loads : LinkLoads

    Returns
    -------
    tuple of LinkLoads
    """
    return tuple(plates(loads, apart(case, link)))


def plates_by_hand(case: Case, link: str, borne: Sequence[LinkLoads]) -> tuple[tuple[LinkLoads, LinkByHand], ...]:
    """Return what acts on a link, or on each of its plates, with its hand calculation.

    Parameters
    ----------
    case : Case
    link : str
    borne : sequence of LinkLoads
        Of the link, or of each of its plates.

    Returns
    -------
    tuple of tuple of (LinkLoads, LinkByHand)
        First of the plate that bears more by hand; the loads of the other have a name of their own.
    """
    found = [(loads, link_by_hand(case, link, loads)) for loads in borne]
    worse, *others = sorted(found, key=lambda plate: -plate[1].worst[1].equivalent)
    return (worse, *((replace(loads, name=f"{loads.name}, other plate"), hand) for loads, hand in others))


def every_plate_by_hand(
    case: Case, load_case: str, moved: LargeDisplacement, reactions: Reactions, loads: Sequence[Load]
) -> dict[str, tuple[tuple[LinkLoads, LinkByHand], ...]]:
    """Return what acts on every link that is checked, cut free, with its hand calculation.

    Parameters
    ----------
    case, load_case, moved, reactions, loads
        As of ``cut_link``.

    Returns
    -------
    dict of str to tuple of tuple of (LinkLoads, LinkByHand)
        By link, as of ``plates_by_hand``.
    """
    return {
        link: plates_by_hand(case, link, cut_link(case, link, load_case, moved, reactions, loads))
        for link in case.checked_links
    }


def slenderest(case: Case, link: str, plates_of: Sequence[tuple[LinkLoads, LinkByHand]]) -> BeamCheck:
    """Return the hand calculation of a link, or of the plate of it that buckles first as a column.

    Parameters
    ----------
    case : Case
    link : str
    plates_of : sequence of (LinkLoads, LinkByHand)
        As of ``plates_by_hand``.

    Returns
    -------
    BeamCheck
    """
    checks = [hand.check for _, hand in plates_of]
    if len(checks) == 1:
        return checks[0]  # its factor, which takes as long as its stresses, is not needed
    return min(checks, key=lambda check: least_factor(case, link, check))


def link_by_hand(case: Case, link: str, loads: LinkLoads) -> LinkByHand:
    """Return the hand calculation of a link under what acts on it.

    Parameters
    ----------
    case : Case
    link : str
    loads : LinkLoads
        At one pose.

    Returns
    -------
    LinkByHand
    """
    material, body = case.material_of(link), case.body(link)
    section = hand_section(body)
    if without := no_beam(body):
        ends = [PointLoad(point=np.array([x, 0.0, 0.0]), wrench=np.zeros(6)) for x in (0.0, 1.0)]
        nothing = check_beam(BeamLoads(points=tuple(ends)), section, material.allowable, material.poissons_ratio)
        return LinkByHand(check=replace(nothing, without=without), displacement=0.0, details=(), remarks=(without,))
    acting = on_axis(loads, body, material.density)
    check = check_beam(acting, section, material.allowable, material.poissons_ratio, body.cuts)
    bent = _bent(body, material, check.forces)
    found = details(body, loads, check.forces, material.poissons_ratio)
    return LinkByHand(check=check, displacement=bent.largest, details=found, remarks=remarks(body, found))


def _bent(body: Body, material: Material, forces: Piecewise) -> Deflection:
    return deflection(
        forces,
        hand_section(body),
        young=material.youngs_modulus,
        poisson=material.poissons_ratio,
        line=reference_line(body),
        flanks=flanks_of(body),
        cuts=body.cuts,
    )


@dataclass(frozen=True, eq=False)
class HandStates:
    """The hand calculation of a link in n states; each number is that of its worse plate.

    Attributes
    ----------
    case : Case
    link : str
    answers : sequence of tuple of LinkLoads
        What acts on the link in each state, or on each plate of a pair.
    """

    case: Case
    link: str
    answers: Sequence[Plates]

    @cached_property
    def stress(self) -> Real:
        """Largest stress (n,) of plain sections and details [MPa]; the largest pin force [N] where no beam stands."""
        body, poisson = self._body, self._material.poissons_ratio

        def of(loads: LinkLoads, forces: Piecewise) -> Real:
            plain = largest_stress(forces, hand_section(body), poisson, body.cuts)
            for k in range(len(plain) if has_details(body) else 0):
                places = details(body, loads.chosen(k), forces.state(k), poisson)
                plain[k] = max(plain[k], *(one.stress.equivalent for one in places))
            return plain

        return self._worse(self._each(of))

    @cached_property
    def peaks(self) -> Real:
        """Least and largest peak (2, n) of the calibrated band [MPa]; twice ``stress`` where there is none.

        Plain sections alone do not tell it: couples of a pin and forces on a single eye are borne beside them.
        """
        material, body = self._material, self._body
        if no_beam(body) or uncalibrated(body, material.poissons_ratio):
            return np.tile(self.stress, (2, 1))
        calibration, found = calibration_of(body.part), np.zeros((2, len(self._every)))
        try:
            for alike, acting, forces in self._forces:
                for place in critical_locations(body, acting, forces, material.poissons_ratio):
                    factors = calibration.factors(place.kind, brittle=material.brittle)
                    ends = np.outer([factors.low, factors.high], place.each)
                    found[:, alike] = np.maximum(found[:, alike], ends)
        except CannotRunError:  # a cross hole outside of the handbook's range, in all states alike
            return np.tile(self.stress, (2, 1))
        return self._worse(found)

    @cached_property
    def displacement(self) -> Real:
        """That of any point (n,), as it is banded [mm]; the largest pin force [N] where no beam stands.

        The bending of the axis alone does not tell it: a link between two pins has none.
        """
        body, material = self._body, self._material

        def of(loads: LinkLoads, forces: Piecewise) -> Real:
            return displacement_estimate(
                body,
                loads,
                forces,
                hand_section(body),
                young=material.youngs_modulus,
                poisson=material.poissons_ratio,
                line=reference_line(body),
            )

        return self._worse(self._each(of))

    @cached_property
    def inverse_buckling(self) -> Real:
        """Inverse (n,) of the buckling factor; the largest pin force [N] where no beam stands."""
        return self._worse(self._each(lambda _, forces: 1.0 / least_factors(self.case, self.link, forces)))

    @property
    def _material(self) -> Material:
        return self.case.material_of(self.link)

    @property
    def _body(self) -> Body:
        return self.case.body(self.link)

    @cached_property
    def _every(self) -> list[LinkLoads]:
        return [loads for plates in self.answers for loads in plates]

    def _worse(self, every: Real) -> Real:
        first = np.cumsum([0, *(len(plates) for plates in self.answers[:-1])])
        return np.asarray(np.maximum.reduceat(every, first, axis=-1))

    @cached_property
    def _forces(self) -> list[tuple[list[int], LinkLoads, Piecewise]]:
        """Numbers of the states whose stations are alike, what acts in these, and their internal forces."""
        body, density, found = self._body, self._material.density, list[tuple[list[int], LinkLoads, Piecewise]]()
        for alike, loads in stacked(self._every):
            forces = internal_forces(on_axis(loads, body, density))
            found.append((alike, loads, divided(forces, [cut.x for cut in body.cuts])))
        return found

    def _each(self, number: Callable[[LinkLoads, Piecewise], Real]) -> Real:
        """A number (n,) of internal forces in every state."""
        if no_beam(self._body):
            return np.array([max(float(np.linalg.norm(pin.wrench[:3])) for pin in one.pins) for one in self._every])
        found = np.zeros(len(self._every))
        for alike, loads, forces in self._forces:
            found[alike] = number(loads, forces)
        return found
