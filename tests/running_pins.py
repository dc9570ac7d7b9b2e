"""Pins in their holes on the deformed shape, solved directly: co-rotational beams and discs, step by step in the load.

Independent of ``alula.fea.nonlinear.rim_growth``: no geometric stiffness is made, the tangent of the whole frame by
where pins stand is found by moving each, and equilibrium is that of the deformed shape.
"""

from dataclasses import replace

import numpy as np

from alula.fea.beam.cut_free import link_loads
from alula.fea.frame.system import natural_deformations
from alula.fea.links.link_by_hand import HandStates, cut_link, on_plates
from alula.fea.nonlinear.corotational import subdivide
from alula.fea.nonlinear.deformed_links import balanced, on_deformed_shape
from alula.fea.nonlinear.equilibrium_path import EquilibriumPath
from alula.fea.nonlinear.jet import Jet
from alula.fea.nonlinear.large_displacement import LargeDisplacement
from alula.fea.pins.holes import RimFrame
from alula.fea.pins.programme import least_in_discs


class RunningPins:
    """A linkage whose pins stand in their holes, with all moduli divided by a factor."""

    def __init__(self, case, load_case, statics, factor, parts=2, steps=2):
        self.case, self.load_case, self.steps = case, load_case, steps
        forces, self.loads = statics.forces[load_case], statics.loads[load_case]
        self.pins, frame = forces.pins, forces.frame
        soft = replace(frame.model, elements=tuple(replace(e, young=e.young / factor) for e in frame.model.elements))
        self.frame = replace(frame, model=soft)
        stiff = set(frame.pin_beams.values())
        each = [1 if i in stiff else parts for i in range(len(soft.elements))]
        rims = {(joint, hole.link): (hole.low, hole.high) for hole in self.pins.rims.holes for joint in hole.joints}
        divided = subdivide(soft, each)
        self.rims = RimFrame.of(self.frame, rims).divided(divided, np.repeat(np.arange(len(each)), each))
        self.path = EquilibriumPath(divided)
        self.start = self.path.state
        self.numbers = list(self.rims.frame.pin_beams.values())
        system = self.rims.solved.system
        opened = natural_deformations(system.lengths[self.numbers]) @ system.matrices[self.numbers]
        self.opened, self.v = opened @ self.rims.ends, np.zeros(self.rims.ends.shape[2])
        plain = self.path.elements.natural

        def natural(displacements, rotations):
            found, axes = plain(displacements, rotations)
            value = found.value.copy()
            value[self.numbers] += self.opened @ self.v
            return Jet(value=value, gradient=found.gradient, hessian=found.hessian), axes

        self.path.elements.natural = natural

    def stresses(self, radii):
        """Link -> its stress by hand with pins in discs of these radii, where load over modulus is the factor.

        ``displacements`` of the nodes are kept.
        """
        self._stand(np.zeros(len(self.v)))
        state, K = self.start, self.rims.K
        for load in np.linspace(0.0, 1.0, self.steps + 1)[1:]:
            for k in range(80):
                state = self._balanced(state, load)
                K = self._stiffness(state, load) if k % 3 == 0 else K
                values = np.linalg.eigvalsh(K)
                convex = K + max(0.0, 1e-12 * values[-1] - values[0]) * np.eye(len(K))
                last = self.v
                found = least_in_discs(convex, convex @ last - self._slope(state), radii[None]).v[0]
                self._stand(found if k < 20 else (found + last) / 2.0)
                if np.abs(self.v - last).max() < 1e-4 * radii.max():
                    break
            else:
                raise AssertionError("pins do not settle")
        self.path.state = self._balanced(state, 1.0)
        return self._links(self._recorded())

    def held_at(self, v):
        """Displacements of the nodes with pins held at places of the discs."""
        self._stand(v)
        self.path.state = self._balanced(self.path.state, 1.0)
        self._recorded()
        return self.displacements

    def _recorded(self):
        found = self.path.record()
        self.displacements = found.displacements[: len(self.frame.model.nodes), :3]
        return found

    def _stand(self, v):
        self.v, self.path._at, self.path._balanced = v, None, {}

    def _balanced(self, state, load):
        for _ in range(60):
            left, tangent = self.path.balance(state, load)
            if self.path._measure(left) <= max(1e-9, self.path._rounding(state)):
                return state
            change = -self.path._solve(tangent, left)
            turn = np.abs(change[: self.path.chain.count][self.path.chain.is_turn]).max(initial=0.0)
            state = self.path._moved(state, change * min(1.0, 0.1 / max(turn, 1e-9)))
        raise AssertionError("no equilibrium")

    def _slope(self, state):
        natural, _ = self.path._natural(state)
        forces = self.path.elements.stiffness[self.numbers] @ natural.value[self.numbers, :, None]
        return np.einsum("pij,pi->j", self.opened, forces[:, :, 0])

    def _stiffness(self, state, load):
        left, tangent = self.path.balance(state, load)
        slope, v, found = self._slope(state), self.v, np.zeros((len(self.v),) * 2)
        for j in range(len(v)):
            self._stand(v + 1e-5 * np.eye(len(v))[j])
            more = self.path.balance(state, load)[0] - left
            found[:, j] = (self._slope(self.path._moved(state, -self.path._solve(tangent, more))) - slope) / 1e-5
        self._stand(v)
        return (found + found.T) / 2.0

    def _links(self, found):
        case, frame, count = self.case, self.frame, len(self.frame.model.nodes)
        reactions = frame.reactions(found.joint_wrenches[:count], found.residual, found.displacements[:count])
        links = {
            link: balanced(
                on_deformed_shape(frame, found, reactions, link, self.load_case, case.body(link), self.loads),
                frame.model.load_scale,
            )
            for link in case.bending_links
        }
        moved = LargeDisplacement(state="deformed", span=1.0, points={}, links=links, reactions=reactions, reason="")
        cut = {link: cut_link(case, link, self.load_case, moved, reactions, self.loads) for link in case.checked_links}
        return {link: float(HandStates(case, link, [one]).stress[0]) for link, one in cut.items()}


def in_small_motions(case, load_case, statics, v):
    """Link -> its stress by hand with pins that stand at v, as linear statics has them."""
    forces, loads = statics.forces[load_case], statics.loads[load_case]
    reactions = forces.pins.reactions(v)
    cut = {
        link: on_plates(case, link, link_loads(load_case, link, case.body(link), reactions, loads))
        for link in case.checked_links
    }
    return {link: float(HandStates(case, link, [one]).stress[0]) for link, one in cut.items()}
