"""A linkage in one layer whose pins stand in their holes, solved another way: stiffness, rigid pins, springs at rims.

Every pin is a rigid body of six unknowns. At both rims of a hole a stiff spring acts on what the pin's place exceeds
half the clearance by, in any direction; Newton's method finds where that is at rest. The program condenses a frame by
forces and follows an interior point method.
"""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from alula.loads.case.case import Case

Real = NDArray[np.float64]
HELD, RIM, ALONE = 1e8, 1e6, 1e-7
"""Stiffness of what is tied and of rims, and of everything on the ground, which holds what floats [N/mm]."""


def beam(E: float, nu: float, area: float, i_y: float, i_z: float, torsion: float, L: float) -> Real:
    """Stiffness (12, 12) of a Timoshenko beam with shear areas of 5/6."""
    G, K = E / 2.0 / (1.0 + nu), np.zeros((12, 12))
    for first, stiffness in ((0, E * area / L), (3, G * torsion / L)):
        K[np.ix_([first, first + 6], [first, first + 6])] = stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
    for inertia, shifts, turns, sign in ((i_z, (1, 7), (5, 11), 1.0), (i_y, (2, 8), (4, 10), -1.0)):
        soft = 12.0 * E * inertia / (G * area * 5.0 / 6.0 * L**2)
        a, arm = E * inertia / (L**3 * (1.0 + soft)), 6.0 * L * sign
        near, far = (4.0 + soft) * L**2, (2.0 - soft) * L**2
        rows = [shifts[0], turns[0], shifts[1], turns[1]]
        K[np.ix_(rows, rows)] += a * np.array(
            [[12.0, arm, -12.0, arm], [arm, near, -arm, far], [-12.0, -arm, 12.0, -arm], [arm, far, -arm, near]]
        )
    return K


class InHoles:
    """The linkage of a case, with forces at points [N] and holes (joint, link) -> clearance and z of both rims [mm]."""

    def __init__(
        self,
        case: Case,
        forces: Mapping[tuple[str, str], Real],
        holes: Mapping[tuple[str, str], tuple[float, tuple[float, float]]],
    ) -> None:
        linkage, pose = case.linkage, case.solve_pose()
        self.beams: list[tuple[str, Real, Real]] = []
        self.nodes: dict[tuple[str, str], int] = {}
        for link in linkage.moving:
            self.nodes |= {(link, point): 6 * (len(self.nodes) + k) for k, point in enumerate(case.links[link].points)}
        pins = {name: 6 * (len(self.nodes) + k) for k, name in enumerate(case.joints)}
        size = 6 * (len(self.nodes) + len(pins))
        self.K, self.f = ALONE * np.eye(size), np.zeros(size)
        for link in linkage.moving:
            part, material, turn = case.part_of(link).section, case.material_of(link), np.eye(3)
            turn[:2, :2] = pose.rotation(link).T
            T = np.kron(np.eye(4), turn)
            along = sorted(case.links[link].points, key=lambda point: case.links[link].points[point][0])
            for a, b in pairwise(along):
                length = case.links[link].points[b][0] - case.links[link].points[a][0]
                k = beam(material.youngs_modulus, material.poissons_ratio, part.area, part.i_y, part.i_z, part.torsion,
                         length)  # fmt: skip
                rows = np.concatenate([self.nodes[link, end] + np.arange(6) for end in (a, b)])
                self.K[np.ix_(rows, rows)] += T.T @ k @ T
                self.beams.append((link, rows, k @ T))
        for at, force in forces.items():
            self.f[self.nodes[at] : self.nodes[at] + 3] += force

        def node(link: str, joint: str) -> Real:
            """(6, size) of what turns and shifts a link at a joint."""
            found = np.zeros((6, size))
            if link != linkage.ground:
                found[:, (first := self.nodes[link, linkage.point_of(joint, link)]) : first + 6] = np.eye(6)
            return found

        tied, self.rims = list[Real](), list[tuple[float, Real]]()
        for name, joint in case.joints.items():
            for k, link in enumerate(joint.links):
                between = np.eye(size)[pins[name] : pins[name] + 6] - node(link, name)
                clearance, rims = holes[name, link]
                tied.append(between[[2] if k else [2, 5]])
                if clearance == 0.0:
                    tied.append(between[[0, 1, 3, 4]])
                else:
                    self.rims += [
                        (clearance / 2.0, np.array([between[0] + z * between[4], between[1] - z * between[3]]))
                        for z in rims
                    ]
        assert case.drive is not None
        tied.append((node(case.drive.link, case.drive.joint) - node(linkage.ground, case.drive.joint))[[5]])
        held = np.vstack(tied)
        self.K += HELD * held.T @ held

    def solved(self) -> Real:
        """Displacements (n,) of all nodes and pins."""

        def energy(u: Real) -> float:
            beyond = [max(float(np.linalg.norm(A @ u)) - r, 0.0) for r, A in self.rims]
            return float(u @ self.K @ u / 2.0 - self.f @ u) + RIM / 2.0 * sum(one**2 for one in beyond)

        u = np.zeros_like(self.f)
        for _ in range(200):
            slope, K = self.K @ u - self.f, self.K.copy()
            for r, A in self.rims:
                v = A @ u
                far = float(np.linalg.norm(v))
                if far > r:
                    n = v / far
                    slope += RIM * (far - r) * (A.T @ n)
                    K += RIM * A.T @ (np.outer(n, n) * (r / far) + np.eye(2) * (1.0 - r / far)) @ A
            step, whole = -np.linalg.solve(K, slope), energy(u)
            length = 1.0
            while energy(u + length * step) > whole and length > 1e-9:
                length /= 2.0
            u = u + length * step
            if abs(slope @ step) < 1e-12 * abs(whole):
                break
        return np.asarray(u)

    def stresses(self, case: Case, u: Real) -> dict[str, float]:
        """Largest |N|/A + |My|/Wy + |Mz|/Wz of every link, at the ends of its beams [MPa]."""
        found = dict.fromkeys(case.linkage.moving, 0.0)
        for link, rows, k in self.beams:
            part, ends = case.part_of(link).section, (k @ u[rows]).reshape(2, 6)
            over = np.array([part.area, part.i_y / part.half_z, part.i_z / part.half_y])
            found[link] = max(found[link], *(np.abs(ends[:, [0, 4, 5]]) / over).sum(axis=1))
        return found
