"""The records of an envelope: curves over the motion, the worst of them, fatigue, verdict."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.fea.common.band import Band
from alula.fea.common.reason import Reason
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.motion.linkage_history import LinkageOverMotion
from alula.fea.outcomes.fatigue import Lasting, LinkFatigue
from alula.fea.refine.discretisation import Discretisation
from alula.fea.solid.stress import StressField
from alula.fea.tractions.traction import Transfer
from alula.loads.case.case import Case
from alula.loads.records.bearing import Span
from alula.loads.states.case_motion import CaseMotion
from alula.loads.states.clearance import Clearance
from alula.loads.states.drive_work import DriveWork
from alula.loads.statics.statics import Drive

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class VariantCurve:
    """The decisive stress over the motion under one model of pin pressure and one of torque transfer.

    Attributes
    ----------
    span : Span
        Loaded angle of the pin holes [degrees].
    transfer : Transfer or None
        None on a link without drive torque.
    stress : ndarray, shape (n,)
        Largest of all nodes at each pose [MPa]; NaN where the pose was left out.
    node : ndarray of int, shape (n,)
        Where; -1 where the pose was left out.
    first : int
        Number of its first load in the link's ``UnitSolutions``.
    """

    span: Span
    transfer: Transfer | None
    stress: Real
    node: NDArray[np.int64]
    first: int

    @property
    def peak(self) -> float:
        """Largest stress of the motion [MPa]."""
        return float(np.nanmax(self.stress))


@dataclass(frozen=True, kw_only=True, eq=False)
class StressAlong:
    """The decisive stress along a link under one load case, of the variant that governs.

    Attributes
    ----------
    first, last : float
        x between which the stretches lie, all of one length, in the link's frame [mm].
    poses : ndarray of int, shape (k,)
        Numbers of the poses, rising.
    stress : ndarray, shape (k, stretches)
        Largest of all nodes of a stretch at each pose [MPa].
    """

    first: float
    last: float
    poses: NDArray[np.int64]
    stress: Real


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadCaseEnvelope:
    """A link over the motion under one load case.

    Attributes
    ----------
    name : str
    variants : tuple of VariantCurve
    governing : VariantCurve
        The one that the values come from.
    value, low, high : ndarray, shape (n,)
        Decisive stress at each pose and its band [MPa]; NaN where the pose was left out.
    stress, safety_factor : Band
        Of the worst pose, over the whole motion.
    pose : int
        Its number.
    location : ndarray, shape (3,)
        Where, in the link's frame [mm].
    fatigue : LinkFatigue or None
    discretisation : Discretisation or None
        What the meshes leave open, judged at the worst pose of the first mesh; None for one mesh alone.
    along : StressAlong or None
        Where the stress is; None where the peak has no limit.
    """

    name: str
    variants: tuple[VariantCurve, ...]
    governing: VariantCurve
    value: Real
    low: Real
    high: Real
    stress: Band
    safety_factor: Band
    pose: int
    location: Real
    fatigue: LinkFatigue | None
    discretisation: Discretisation | None
    along: StressAlong | None = None

    @property
    def known(self) -> bool:
        """False where the peak has no limit, so that no safety factor stands for it."""
        return self.discretisation is None or self.discretisation.known

    @property
    def severity(self) -> tuple[bool, float, float]:
        """By which the worst load case is found: the least of these."""
        return self.known, self.safety_factor.low, self.safety_factor.value


@dataclass(frozen=True, kw_only=True, eq=False)
class LayerFatigue(Lasting):
    """Fatigue of the layers of a printed link; its stress is that of tension across them.

    Attributes
    ----------
    tension : tuple of (float, float)
        Mean and amplitude of the stress normal to the layers there [MPa].
    shear : tuple of (float, float)
        Of the shear stress along them [MPa]; zero where the card has no strength against it.
    """

    tension: tuple[float, float]
    shear: tuple[float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class LayerEnvelope:
    """The layers of a printed link over the motion under one load case.

    Attributes
    ----------
    safety_factor : Band
        The least of the motion.
    pose : int
        Its number.
    location : ndarray, shape (3,)
        Where, in the link's frame [mm].
    fatigue : LayerFatigue or None
    no_fatigue : Reason or None
        Why there is no fatigue of layers although it is asked for; None where there is one, or none is asked for.
    """

    safety_factor: Band
    pose: int
    location: Real
    fatigue: LayerFatigue | None
    no_fatigue: Reason | None


@dataclass(frozen=True, kw_only=True, eq=False)
class LinkEnvelope:
    """A link over the motion under every load case that loads it.

    Attributes
    ----------
    link : str
    measure : str
        The decisive stress: "von Mises" or "largest principal".
    strength : float
        What it is set against [MPa].
    load_cases : mapping of str to LoadCaseEnvelope
    elements, unknowns : int
        Size of the finest mesh.
    units, modes : int
        Unit loads, and solutions that span the motion's loads.
    solver : str
    solver_reason : Reason
        Its name, and why it was chosen.
    solver_error : float
        Largest relative error of a solution (energy norm).
    reaction, imbalance : float
        Largest reaction of the free body's supports and resultant of its loads, as shares of the load.
    field : StressField
        Of the worst pose under the worst load case.
    displacement : ndarray, shape (nodes, 3)
        In that pose [mm].
    no_fatigue : Reason or None
        Why there is no fatigue calculation; None where there is one.
    notes : tuple of Reason or str
    layers : mapping of str to LayerEnvelope
        Load case -> its layers; empty where none are checked.
    """

    link: str
    measure: str
    strength: float
    load_cases: Mapping[str, LoadCaseEnvelope]
    elements: int
    unknowns: int
    units: int
    modes: int
    solver: str
    solver_reason: Reason | str
    solver_error: float
    reaction: float
    imbalance: float
    field: StressField
    displacement: Real
    no_fatigue: Reason | None
    notes: tuple[Reason | str, ...]
    layers: Mapping[str, LayerEnvelope]

    @property
    def worst(self) -> LoadCaseEnvelope:
        """The load case with the least safety factor, by the low end of its band; one without any comes first."""
        return min(self.load_cases.values(), key=lambda found: found.severity)


@dataclass(frozen=True, kw_only=True, eq=False)
class EnvelopeResult:
    """The envelope of a case.

    Attributes
    ----------
    name : str
        What the case was called on the command line.
    case : Case
    moved : CaseMotion
    drive : Drive or None
        None for a structure under a cycle of loads.
    angles, drive_angles : ndarray, shape (n,)
        Of the motion's coordinate, and of the driven link [rad].
    evaluated : ndarray of bool, shape (n,)
        False where a pose was left out.
    links : mapping of str to LinkEnvelope
    idle : tuple of str
        Links on which nothing acts.
    linkage : mapping of str to LinkageOverMotion
        Load case -> numbers of the linkage as a whole.
    work : mapping of str to DriveWork
        Load case -> what the drive does, with the ends of what friction may be; empty where no joint rubs.
    clearance : Clearance or None
        The gaps between links; None where no layers are stated.
    checks : tuple of CheckOutcome
        For every link and load case.
    verdict : Verdict
        Over all checks.
    warnings : tuple of Reason or str
        One sentence each.
    timings : mapping of str to float
        Stage -> seconds.
    """

    name: str
    case: Case
    moved: CaseMotion
    drive: Drive | None
    angles: Real
    drive_angles: Real
    evaluated: NDArray[np.bool_]
    links: Mapping[str, LinkEnvelope]
    idle: tuple[str, ...]
    linkage: Mapping[str, LinkageOverMotion]
    work: Mapping[str, DriveWork]
    clearance: Clearance | None
    checks: tuple[CheckOutcome, ...]
    verdict: Verdict
    warnings: tuple[Reason | str, ...]
    timings: Mapping[str, float]
