"""Pins in shear and bending under their joint force.

Two eyes lie side by side on the pin, so that it is in single shear: the joint force acts at the middle of each eye,
and the two forces are a = t1/2 + gap + t2/2 apart. Their couple F a is taken by the eyes. How they share it depends
on how tightly the pin sits: one eye takes it all (the pin is built in there; largest moment F a) or both take half
(largest moment F a/2, at mid-gap). The first is the value, both are the band. Bending stress 32 M/(π d³), largest
shear stress of a solid circle 4 F/(3 A) (Budynas & Nisbett, Shigley's Mechanical Engineering Design, 10th ed.,
chapter 3, for beams in bending and shear; eyes as point loads, or a pin built in at one eye).
Moments about x and y that the joint carries besides (loads out of the plane) add to the bending moment.
"""

import math
from dataclasses import dataclass

import numpy as np

from fea.band import Band
from geometry.errors import CaseError
from loads.case import Case
from loads.statics import JointReaction

HOLDS = ("one eye takes the couple of the joint force, or both take half",)


@dataclass(frozen=True, kw_only=True)
class PinStress:
    """Stresses of a pin [MPa].

    lever    distance between the middles of the two eyes [mm]
    moment   largest bending moment, both ways to share the couple [N mm]
    bending  extreme-fibre stress of that moment
    shear    largest shear stress, at the neutral axis, where nothing bends
    """

    lever: float
    moment: Band
    bending: Band
    shear: float

    @property
    def equivalent(self) -> Band:
        """Von Mises stress: the bending at the extreme fibre or √3 times the shear at the neutral axis."""
        floor = math.sqrt(3.0) * self.shear
        value, low, high = (max(b, floor) for b in (self.bending.value, self.bending.low, self.bending.high))
        return Band(value=value, low=low, high=high, holds=HOLDS)


def pin_stress(force: float, diameter: float, lever: float, moment: float = 0.0) -> PinStress:
    """Return the stresses of a pin under a joint force [N] across it and a moment about x or y [N mm]; mm."""
    if not diameter > 0.0:
        raise CaseError(f"a pin needs a diameter above zero, not {diameter:g} mm; state its pin_diameter")
    most, least = force * lever + moment, force * lever / 2.0 + moment
    section_modulus = math.pi * diameter**3 / 32.0
    bending = Band(value=most, low=least, high=most, holds=HOLDS)
    return PinStress(
        lever=lever,
        moment=bending,
        bending=Band(
            value=most / section_modulus, low=least / section_modulus, high=most / section_modulus, holds=HOLDS
        ),
        shear=4.0 * force / (3.0 * math.pi * diameter**2 / 4.0),
    )


def lever(case: Case, joint: str) -> float:
    """Distance between the middles of a joint's two eyes [mm].

    An eye of a link without part is taken as thick as the other link's. Raises ``CaseError`` where neither has a part.
    """
    links = [link for link in case.joints[joint].links if case.links[link].part is not None]
    thicknesses = [case.part_of(link).eye_thickness for link in links]
    if not thicknesses:
        raise CaseError(f"joints.{joint}: neither link has a part, so the pin's length is unknown; give one a part")
    return (thicknesses[0] + thicknesses[-1]) / 2.0 + case.joints[joint].pin_gap


def stress_at(case: Case, joint: str, reaction: JointReaction) -> PinStress:
    """Return the stresses of a joint's pin under its reaction; raises ``CaseError`` for a pin without diameter."""
    wrench = reaction.wrench
    return stress_of(case, joint, float(np.hypot(*wrench[:2])), float(np.hypot(*wrench[3:5])))


def stress_of(case: Case, joint: str, force: float, moment: float = 0.0) -> PinStress:
    """Return the stresses of a joint's pin under a force [N] across it and a moment about x or y [N mm].

    Raises ``CaseError`` for a pin without diameter.
    """
    record = case.joints[joint]
    if record.pin_diameter is None:
        raise CaseError(f'joints.{joint}.pin_diameter: the check of its pin needs it; state it, for example "1.5 mm"')
    return pin_stress(force, record.pin_diameter, lever(case, joint), moment)
