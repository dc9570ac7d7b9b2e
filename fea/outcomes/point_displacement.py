"""How far a point of the linkage moves: by the links' solids where these are solved, else by the frame.

Pins move as the mean of their bores. What they could sink into these beyond that is no part of the band; the reason of
the outcome states it.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from alula.fea.asked.asked import Asked, asked, place_of
from alula.fea.common.alternatives import Alternatives
from alula.fea.common.band import Band
from alula.fea.common.link_loads import LinkLoads
from alula.fea.common.reason import Reason, reason, together
from alula.fea.common.scatter import Scatter, compliance_scatter, load_over_modulus, load_scatter
from alula.fea.common.sought import LEFT, sought
from alula.fea.common.source import COUPLES, Source, SourceKind, distinct, play_source
from alula.fea.common.verdict import CheckOutcome, Quantity, Verdict
from alula.fea.frame.displacement_band import OneModulus, point_bounds
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.nonlinear.rim_growth import Farther, rim_growth
from alula.fea.nonlinear.softened import displaced
from alula.fea.nonlinear.stability import LARGE, SNAP, growth
from alula.fea.outcomes.free_motion import FreeMotion, free_motion, unknown_lengths
from alula.fea.outcomes.point_shares import LoadedLinkage, Shares, condensable, has_centre_line, shares_of
from alula.fea.outcomes.result import LinkResult, SolidResult
from alula.fea.pins.clearances import loose_holes
from alula.fea.standing.case_statics import locks_on_tight_pins
from alula.fea.standing.joint_forces import JointForces
from alula.loads.case.case import Case
from alula.loads.records.check_spec import DisplacementCheck
from alula.loads.states.play import Play

Real = NDArray[np.float64]

ROOM = 0.8
"""Share of the way to a limit that meshes may leave open, since a finer mesh moves the number as well."""
WORTH_TELLING = 0.01
"""Share of the displacement that the sinking of pins must add to be told."""


@dataclass(frozen=True, kw_only=True)
class PointDisplacement(LoadedLinkage):
    """How far a point moves under a load case, and by which model.

    Attributes
    ----------
    link, point : str
    shares : Shares
        What every link adds.
    why : Reason or None
        Why nothing tells it; None where something does.
    """

    link: str
    point: str
    shares: Shares
    why: Reason | None = None

    @classmethod
    def at(cls, loaded: LoadedLinkage, link: str, point: str) -> "PointDisplacement":
        """Return how far a point moves.

        Parameters
        ----------
        loaded : LoadedLinkage
        link, point : str

        Returns
        -------
        PointDisplacement
        """
        case, moved = loaded.case, loaded.moved
        displacement, factor, shares = moved.points.get((link, point)), moved.factor, Shares()
        why: Reason | None = reason("frame_gives_no_displacement", why=moved.reason)
        if displacement is not None and moved.state in ("small", "deformed", "off"):
            size, why = float(np.linalg.norm(displacement)), None
            near = factor is not None and factor < SNAP
            shares = shares_of(loaded, link, point)
            if shares.framed is not None:
                size = shares.framed.displaced(link, point).value
            blind = [other for other in shares.beams if not has_centre_line(case, other)]
            if blind:
                solved = loaded.free and isinstance(loaded.links[blind[0]], SolidResult)
                untold = loaded.free and moved.state == "small" and not solved
                why = reason(
                    "solid_tells_how_far_it_gives" if untold else "frame_is_blind",
                    link=blind[0],
                    rigid=blind[0] == case.linkage.ground,
                )
            elif not moved.followed and (near or size > LARGE * moved.span):
                if near:
                    what = reason("may_give_way_at", factor=factor, least=SNAP)
                else:
                    what = reason("moves_it_far", displacement=size, most=LARGE)
                why = reason("linear_frame_not_valid", why=what)
        return cls(**vars(loaded), link=link, point=point, shares=shares, why=why)

    def _by(self, cause: Alternatives[LargeDisplacement]) -> Scatter:
        """Return what a cause makes of the ends of the band: the point moves elsewhere, by other links' eyes."""
        moved, found = self.moved, self.moved.displaced(cause, self.link, self.point)
        framed = self.shares.framed is not None or self.shares.solids
        frames = [(one.frame, one.solution) for one in cause.others]
        known = [(frame, solution) for frame, solution in frames if frame is not None and solution is not None]
        if framed or moved.followed or not known or moved.frame is None or moved.solution is None:
            return found
        bounds = partial(point_bounds, self.case, moved.frame, moved.solution, self.link, self.point)
        own, every = bounds(), bounds(others=known)
        return replace(
            found,
            low=min(found.low, every.low / own.low) if own.low > 0.0 else found.low,
            high=max(found.high, every.high / own.high) if own.high > 0.0 else found.high,
        )

    @cached_property
    def _by_causes(self) -> tuple[tuple[Alternatives[LargeDisplacement], Scatter], ...]:
        """The causes that change what acts, each with what it makes of the band."""
        return tuple((cause, self._by(cause)) for cause in self.moved.of_loads)

    @property
    def play(self) -> Play | None:
        """What the play of pins does; None where no joint has play."""
        return None if self.forces is None else self.forces.play

    @property
    def by_centre_lines(self) -> bool:
        """True where a frame of centre lines tells it that could have links' solids in their place."""
        forces = self.forces
        known = forces is None or forces.by_equilibrium or self.shares.framed is not None or self.moved.followed
        return not known and any(condensable(self.case, link) for link in self.case.bending_links)

    @cached_property
    def value(self) -> Band:
        """The displacement [mm]."""
        return Band.unknown() if self.why else self.band()

    @cached_property
    def no_end(self) -> Reason | None:
        """Why the band has no upper end; None where it has one."""
        if self.why or math.isfinite(self.value.high):
            return None
        if math.isfinite(self.elastic().high):
            why = reason("play_through_dead_point")
        elif self._endless is not None:
            in_air = self._endless.source.kind is SourceKind.AIR
            why = reason("gives_way_in_some_air") if in_air else reason("gives_way_with_any_friction")
            if self._endless.endless and self._free_to_tilt and not locks_on_tight_pins(self.case, self.load_case):
                why = reason("locks_by_tilting_pins", joints=self._free_to_tilt)
        elif self.moved.followed:
            why = reason("gives_way_as_soft_as_may_be")
        else:
            why = reason("near_giving_way", factor=SNAP)
        return reason("no_upper_end", why=why)

    @property
    def _endless(self) -> Alternatives[LargeDisplacement] | None:
        """The cause that leaves it without upper end; None where none does."""
        return next((cause for cause, spread in self._by_causes if spread.high == math.inf), None)

    @property
    def _free_to_tilt(self) -> tuple[str, ...]:
        """Joints between layers that do not say in which links their pins are tight, which would narrow a band."""
        every = self.case.linkage.joints.items()
        turning = [name for name, joint in every if joint.pivots]
        return tuple(x for x in turning if self.case.linkage.rise(x) != 0.0 and not self.case.joints[x].tight_in)

    @cached_property
    def sinking(self) -> float:
        """What pins could add that sink into their bores beyond the mean motion of these [mm]."""
        solved = self.shares.solids or self.shares.framed is not None
        return self.band(sunk=True).high - self.value.high if solved and not self.why else 0.0

    def band(self, *, meshes: float = 1.0, sunk: bool = False) -> Band:
        """Return the band: that by which links give, and the play of pins beside it.

        Parameters
        ----------
        meshes, sunk
            As of ``elastic``.

        Returns
        -------
        Band
            [mm]; its value where pins rest under the load, its ends where they stand worst.
        """
        found = self.elastic(meshes=meshes, sunk=sunk)
        if self.play is None and self.tilting is None:
            return found
        moved = self.moved.points[self.link, self.point]
        along = moved / (float(np.linalg.norm(moved)) or 1.0)
        plane, across = complex(*along[:2]), float(along[2])
        rests = self._rests
        value = float(np.linalg.norm(found.value * along + rests[0]))
        least, most = (self._loose(end * plane, abs(end * across)) for end in (found.low, found.high))
        low = math.hypot(*least[0])
        node, grown = self._grown
        if len(rests) > 1:  # between layers they rest as the load says
            tight = [end * along for end in (found.low, found.value, found.high) if math.isfinite(end)]
            low = self._least(np.array(tight[:2]))
            low = low if grown is None else min(low, grown.least(node, tight))
        groups = ((name, group) for name in self.case.joints for group in loose_holes(self.case, name))
        radii = {(name, link): play / 2.0 for name, group in groups for link, play in group}
        farther = 0.0 if grown is None else grown.most(node, radii)
        sources = COUPLES if self.play is None else (play_source(self.play.clearances),)
        return Band(
            value=value,
            low=min(low, value),
            high=max(math.hypot(*most[1]) + farther, value),
            sources=distinct(found.sources, sources),
        )

    @cached_property
    def _grown(self) -> tuple[int, Farther | None]:
        """The point's node, and where rims let it stand on the deformed shape; None where nothing is shared there."""
        moved, case = self.moved, self.case
        between = self.forces is not None and self.forces.sharings
        if not between or moved.pins is None or moved.frame is None or moved.state not in ("small", "deformed"):
            return 0, None
        found = rim_growth(moved.pins, load_over_modulus(case, self.load_case, case.checked_links)[1]).farther
        return moved.frame.points[self.link, self.point], found

    @cached_property
    def _rests(self) -> Real:
        """How far the point stands off its place (n, 3) as pins rest under the load, without any strain [mm].

        First with the values of all clearances; between layers with their ends after it.
        """
        forces = self.shares.framed or self.forces
        if forces is not None and forces.pins is not None:
            assert forces.frame is not None
            assert forces.solution is not None
            node, tight = forces.frame.points[self.link, self.point], forces.solution.displacements
            return np.array([(one.displacements - tight)[node, :3] for one in forces.pins.answers])
        shift = 0j if self.play is None else complex(self.play.shift(self.link, self.point))
        return np.array([[shift.real, shift.imag, 0.0]])

    def _least(self, tight: Real) -> float:
        """How far the point moves at least where pins rest between layers, by what it may with tight pins (n, 3).

        What the search may leave is a share of what lies between its ends or, if that is less, of the least.
        """
        forces = self.shares.framed or self.forces
        assert forces is not None
        assert forces.frame is not None
        assert forces.pins is not None
        node, pins = forces.frame.points[self.link, self.point], forces.pins
        rests = np.vstack([self._rests, pins.nearest(node, tight) @ pins.moves(node).T])
        each = [np.linalg.norm(one + rests, axis=1).tolist() for one in tight]
        return float(min(max(sought(sizes)[0], (1.0 - LEFT) * min(sizes)) for sizes in each))

    def _loose(self, plane: complex, across: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and largest displacement in the plane and across it, where pins take up their play beside one."""
        play, tilting = self.play, self.tilting
        if not math.isfinite(abs(plane)):
            return (0.0, 0.0), (math.inf, math.inf)
        least = most = abs(plane)
        if play is not None:
            least, most = play.loose.spread(self.link, self.point, plane)
        if tilting is None:
            return (least, across), (most, across)
        least, most = min(least, tilting.plane.least(plane)), max(most, tilting.plane.largest(plane))
        return (least, max(across - tilting.across, 0.0)), (most, across + tilting.across)

    @cached_property
    def free_motion(self) -> float:
        """How far the play of pins lets the point go by itself [mm]."""
        return math.hypot(*self._loose(0j, 0.0)[1])

    @cached_property
    def tilting(self) -> FreeMotion | None:
        """How far play lets the point go as pins tilt in their holes; None without any, or where all is in a plane."""
        moved = self.moved
        if moved.frame is None or moved.solution is None:
            return None
        run = self.forces is not None and self.forces.pins is not None
        loose = self.play is not None and (self.case.layered or np.any(moved.solution.displacements[:, 2:5]))
        return free_motion(self.case, moved.frame, self.link, self.point) if run or loose else None

    def elastic(self, *, meshes: float = 1.0, sunk: bool = False) -> Band:
        """Return the band without play: what solids or beams leave open, the moduli, and the load.

        The linear answer may grow as a toggle does (``alula.fea.nonlinear.stability``); on the deformed shape
        equilibrium is sought again with the ends of load over stiffness, and with solids for the value: in a frame that
        is softer by the solids' linear displacement over the frame's own.

        Parameters
        ----------
        meshes : float, optional
            Share of what meshes of solids leave open that the band holds.
        sunk : bool, optional
            Whether pins may sink into their bores.

        Returns
        -------
        Band
            [mm]
        """
        case, moved, shares, link, point = self.case, self.moved, self.shares, self.link, self.point
        assert moved.frame is not None
        assert moved.solution is not None
        solids = shares.bands(meshes=meshes, sunk=sunk)
        load = load_scatter(case, self.load_case)
        for _, spread in self._by_causes:
            load = load.times(spread)
        materials = [case.material_of(other) for other in case.checked_links]
        ratios = [m.youngs_modulus / e for m in materials for e in (m.youngs_modulus_range or ())]
        softer = min((*ratios, 1.0)), max((*ratios, 1.0))
        if shares.framed is None:
            bounds = partial(point_bounds, case, moved.frame, moved.solution, link, point, solids, shares.carried)
            found, either = bounds(), bounds(moduli=self._moduli(solids))
        else:
            found = shares.framed.displaced(link, point, meshes=meshes, sunk=sunk)
            either = replace(found, low=found.low * softer[0], high=found.high * softer[1])
        slack = softer[0] * load.low, softer[1] * load.high
        moduli = (compliance_scatter(material).sources for material in materials)
        sources = distinct(shares.sources, found.sources, *moduli, load.sources)
        if moved.followed:
            # What materials add may cancel: then the displacement changes by more than any modulus does.
            beyond = (
                min(either.low / (found.low * softer[0]), 1.0) if found.low > 0.0 else 1.0,
                max(either.high / (found.high * softer[1]), 1.0) if found.high > 0.0 else 1.0,
            )
            return self._followed(found, solids, (slack[0] * beyond[0], slack[1] * beyond[1]), sources)
        # The ground's part is in no frame: it adds to the displacement, but does not make the frame softer.
        near_by = self._near_by(self._framed(found, solids), slack[1])
        grown, least = growth(1.0 / near_by) if near_by > 0.0 else 1.0, 1.0
        if moved.grown is not None and self._linear > 0.0:  # as it is on the deformed shape
            after = float(np.linalg.norm(moved.grown.points[link, point])) / self._linear
            grown, least = max(grown, after), min(after, 1.0)
        value = found.value if solids or shares.framed is not None else float(np.linalg.norm(moved.points[link, point]))
        grows = Source(kind=SourceKind.GROWTH, detail=reason("towards_buckling_or_dead_point"))
        return Band(
            value=value,
            low=min(either.low * load.low * least, value),
            high=max(either.high * load.high * grown, value),
            sources=(*sources, grows),
        )

    def _moduli(self, solids: Mapping[str, tuple[Band, ...]]) -> tuple[OneModulus, ...]:
        """The links of every material whose modulus has a range, and what it makes of their flexibility."""
        links: dict[tuple[float, float, float, str], list[str]] = {}
        for link in dict.fromkeys((*self.case.bending_links, *solids)):
            material = self.case.material_of(link)
            if material.youngs_modulus_range is not None:
                own = compliance_scatter(material)
                links.setdefault((own.low, own.high, material.youngs_modulus, material.title), []).append(link)
        return tuple(OneModulus(links=own, low=low, high=high) for (low, high, *_), own in links.items())

    def _near_by(self, framed: Band, slack: float) -> float:
        """Return one over the factor on its loads at which the linkage may give way, with links as soft as may be."""
        if self.moved.factor is None:
            return 0.0
        return (framed.high / self._linear if self._linear > 0.0 else 1.0) * slack / self.moved.factor

    @cached_property
    def _linear(self) -> float:
        """Displacement of the node by the linear frame [mm]."""
        moved = self.moved
        assert moved.frame is not None
        assert moved.solution is not None
        node = moved.frame.points[self.link, self.point]
        return float(np.linalg.norm(moved.solution.displacements[node, :3]))

    def _framed(self, found: Band, solids: Mapping[str, tuple[Band, ...]]) -> Band:
        """Band of the displacement without what the ground's part adds."""
        case, moved, ground = self.case, self.moved, self.case.linkage.ground
        if ground not in solids:
            return found
        assert moved.frame is not None
        assert moved.solution is not None
        bending = {other: bands for other, bands in solids.items() if other != ground}
        return point_bounds(case, moved.frame, moved.solution, self.link, self.point, bending, self.shares.carried)

    def _followed(
        self,
        found: Band,
        solids: Mapping[str, tuple[Band, ...]],
        slack: tuple[float, float],
        sources: tuple[Source, ...],
    ) -> Band:
        """Band on the deformed shape."""
        moved, link, point = self.moved, self.link, self.point
        assert moved.frame is not None
        framed, size, linear = (
            self._framed(found, solids),
            float(np.linalg.norm(moved.points[link, point])),
            self._linear,
        )
        low, high = (framed.low / linear, framed.high / linear) if linear > 0.0 else (1.0, 1.0)
        low, high = low * slack[0], high * slack[1]
        if solids and linear > 0.0:
            softer = displaced(moved.frame, link, point, found.value / linear)
            size = softer if math.isfinite(softer) else size
        ends = [displaced(moved.frame, link, point, factor) for factor in (low, high) if factor > 0.0]
        return Band(value=size, low=min(size, *ends) if low > 0.0 else 0.0, high=max(size, *ends), sources=sources)

    def meshes_to_refine(self, limit: float) -> dict[str, float]:
        """Return the error of displacements that the meshes of links must keep to for a decision.

        The links whose meshes leave most open of the point's displacement are to leave equally much, and all of them
        together no more than the way from the limit to the band that exact solutions would have. Nothing is returned
        where the limit lies inside that band, since no mesh decides then.

        Parameters
        ----------
        limit : float
            [mm]

        Returns
        -------
        dict of str to float
            Link -> relative error; infinite for a link that is to be solved as a solid in the first place.
        """
        if self.why or not self.value.low <= limit < self.value.high or self.free_motion > limit:
            return {}
        if self.shares.unsolved:
            return dict.fromkeys(self.shares.unsolved, math.inf)
        exact, missing = self.band(meshes=0.0), self.shares.missing
        way = limit - exact.high if limit >= exact.high else exact.low - limit
        width = self.value.high - exact.high if limit >= exact.high else exact.low - self.value.low
        if way <= 0.0 or width <= 0.0:
            return {}
        each = _equal_share(list(missing.values()), ROOM * way / width * sum(missing.values()))
        wanted = {}
        for link, open_by in missing.items():
            result = self.links[link]
            if open_by > each and isinstance(result, SolidResult):
                wanted[link] = result.discretisation.displacement.index * each / open_by
        return wanted


def point_outcome(loaded: LoadedLinkage, one: Asked) -> CheckOutcome:
    """Return the outcome of how far a point of the linkage moves: linear, or on the deformed shape where that rules.

    Parameters
    ----------
    loaded : LoadedLinkage
    one : Asked
        Of a point.

    Returns
    -------
    CheckOutcome
    """
    case, moved = loaded.case, loaded.moved
    told = PointDisplacement.at(loaded, *place_of(case, one.name))
    found = one.outcome(loaded.load_case, told.value, told.why or "")
    if told.why:
        return found
    notes: list[Reason | str | None] = [told.no_end, *(() if moved.frame is None else moved.frame.notes)]
    if told.sinking > WORTH_TELLING * told.value.value:
        beyond = found.verdict is Verdict.PASS and told.value.high + told.sinking > one.limit
        notes.append(reason("pins_may_sink_beyond_limit" if beyond else "pins_may_sink", most=told.sinking))
    if told.play is not None or told.tilting is not None:
        alone = Quantity.DISPLACEMENT.sense.verdict(told.elastic(), one.limit)
        loose, tilting = 0.0 if told.play is None else told.play.free_motion(told.link, told.point), told.tilting
        notes.append(
            reason(
                "play_lets_it_move",
                plane=loose if tilting is None else max(loose, tilting.plane.largest()),
                across=None if tilting is None else tilting.across,
                without=None if alone is found.verdict else alone.value,
            )
        )
        notes += unknown_lengths(case) if tilting is not None else ()
    if found.verdict is Verdict.UNDECIDED:
        notes += _remedies(told, one.limit)
    by_model = reason(
        "displacement_on_deformed_shape" if moved.followed else "displacement_by_linear_theory",
        model=told.shares.model,
        found=found.reason,
    )
    return found.because(together(by_model, *notes))


def meshes_to_refine(
    case: Case,
    load_case: str,
    moved: LargeDisplacement,
    links: Mapping[str, LinkResult],
    free: Mapping[str, LinkLoads],
    forces: JointForces | None = None,
) -> dict[str, float]:
    """Return the error of displacements that links' meshes must keep to for the checks of points, the least of all.

    Parameters
    ----------
    case, load_case, moved, links, free, forces
        As of ``LoadedLinkage``.

    Returns
    -------
    dict of str to float
        As of ``PointDisplacement.meshes_to_refine``.
    """
    loaded = LoadedLinkage(case=case, load_case=load_case, moved=moved, links=links, free=free, forces=forces)
    found: dict[str, float] = {}
    for one in asked(case, DisplacementCheck, quantity=Quantity.DISPLACEMENT):
        told = PointDisplacement.at(loaded, *place_of(case, one.name))
        for link, error in told.meshes_to_refine(one.limit).items():
            found[link] = min(error, found.get(link, math.inf))
    return found


_NO_MESH = reason("no_mesh_would_decide")


def _remedies(told: PointDisplacement, limit: float) -> list[Reason]:
    """Say what would decide, where something would."""
    if told.free_motion > limit:
        return [reason("less_play_would_decide")]
    if told.shares.unsolved or told.by_centre_lines:
        return [reason("solids_have_narrower_band")]
    if told.shares.framed is not None:
        exact = Quantity.DISPLACEMENT.sense.verdict(told.band(meshes=0.0), limit)
        return [_NO_MESH if exact is Verdict.UNDECIDED else reason("smaller_mesh_size_would_decide")]
    wanted = told.meshes_to_refine(limit)
    if not told.shares.beams and not wanted:
        return [_NO_MESH]
    stopped = {link: told.links[link] for link in wanted}
    return [
        reason("refinement_of_link_ended", link=link, why=result.discretisation.stopped)
        for link, result in stopped.items()
        if isinstance(result, SolidResult) and result.discretisation.stopped
    ]


def _equal_share(shares: list[float], total: float) -> float:
    """Return the largest share e for which the sum of min(share, e) is at most a total; infinite where all fit."""
    left, ordered = total, sorted(shares)
    for number, share in enumerate(ordered):
        each = left / (len(ordered) - number)
        if share > each:
            return each
        left -= share
    return math.inf
