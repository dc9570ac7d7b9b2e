"""Parts drawn at random, as STEP files of the geometry kernel, and what closed forms say of them.

``python random_parts.py FOLDER SEED ...`` writes one file for each seed, in a process of its own.
"""

import math
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
GAP = 2.0
"""Least distance of rims from each other and from the outline [mm]."""


@dataclass(frozen=True, kw_only=True)
class Hole:
    """A hole through the part along z, and the bosses about it on top and bottom."""

    x: float
    y: float
    diameter: float
    boss: float
    """Diameter of its bosses [mm]."""
    top: float
    bottom: float
    """Height of its bosses; 0 where there is none [mm]."""

    def rim(self, side: int) -> float:
        """Diameter of what bounds the plate's face about it, on top (0) or at the bottom (1)."""
        return self.boss if (self.top, self.bottom)[side] > 0.0 else self.diameter


@dataclass(frozen=True, kw_only=True)
class Plate:
    """A plate between z = -t/2 and t/2, its outline a convex polygon, counter-clockwise.

    It stands in the file at ``turn`` p + ``shift``.
    """

    outline: Real
    thickness: float
    holes: tuple[Hole, ...]
    turn: Real
    shift: Real

    def moved(self, point: tuple[float, float, float]) -> Real:
        """Return where a point stands in the file."""
        return np.asarray(self.turn @ np.asarray(point) + self.shift)

    def moments(self) -> tuple[float, Real]:
        """Return volume and centroid (3,) in the part's own frame, by sums over prisms and cylinders."""
        x, y = self.outline.T
        xn, yn = np.roll(self.outline, -1, axis=0).T
        cross = x * yn - xn * y
        area = cross.sum() / 2.0
        middle = np.array([((x + xn) * cross).sum(), ((y + yn) * cross).sum(), 0.0]) / (6.0 * area)
        volumes, centres = [area * self.thickness], [middle]
        for hole in self.holes:
            for height, side in ((hole.top, 1.0), (hole.bottom, -1.0)):
                volumes.append(math.pi / 4.0 * hole.boss**2 * height)
                centres.append(np.array([hole.x, hole.y, side * (self.thickness + height) / 2.0]))
            volumes.append(-math.pi / 4.0 * hole.diameter**2 * (self.thickness + hole.top + hole.bottom))
            centres.append(np.array([hole.x, hole.y, (hole.top - hole.bottom) / 2.0]))
        return sum(volumes), np.average(centres, axis=0, weights=volumes)

    def ring(self, hole: Hole) -> float:
        """Return the diameter of the flat ring about a hole that docs/parts.md states."""
        found = []
        for side in (0, 1):
            if hole.rim(side) > hole.diameter:
                found.append(hole.boss)  # the whole face of a boss
                continue
            others = [(math.hypot(hole.x - o.x, hole.y - o.y), o) for o in self.holes if o is not hole]
            walls = [
                self.inside(hole.x, hole.y) - hole.diameter / 2.0,
                *(distance - (hole.diameter + o.rim(side)) / 2.0 for distance, o in others),
                *((distance - (hole.diameter + o.diameter) / 2.0) / 2.0 for distance, o in others),
                1.5 * hole.diameter,  # where the wall counts up to four times the diameter
            ]
            found.append(hole.diameter + 1.5 * min(walls))  # three quarters of the wall on either side
        return min(found)

    def inside(self, x: float, y: float) -> float:
        """Return the distance of a place from the outline, negative outside [mm]."""
        along = np.roll(self.outline, -1, axis=0) - self.outline
        normals = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.hypot(*along.T)[:, None]
        return float((normals * (np.array([x, y]) - self.outline)).sum(axis=1).min())


def drawn(seed: int) -> Plate:
    """Draw a part with two to four holes, of which some have bosses."""
    rng = np.random.default_rng(seed)
    size, corners = rng.uniform(20.0, 80.0), int(rng.integers(3, 9))
    angles = (np.arange(corners) + rng.uniform(-0.3, 0.3, corners)) * 2.0 * math.pi / corners
    outline = size * np.stack([np.cos(angles), rng.uniform(0.5, 1.0) * np.sin(angles)], axis=1)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn[:, 0] *= np.linalg.det(turn)
    plate = Plate(
        outline=outline,
        thickness=rng.uniform(2.0, 8.0),
        holes=(),
        turn=turn,
        shift=rng.uniform(-100.0, 100.0, 3),
    )
    holes: list[Hole] = []
    wanted = int(rng.integers(2, 5))
    while len(holes) < wanted:
        (x, y), diameter = rng.uniform(-size, size, 2), rng.uniform(2.0, 8.0)
        hole = Hole(
            x=x,
            y=y,
            diameter=diameter,
            boss=diameter * rng.uniform(1.5, 2.5),
            top=rng.uniform(1.0, 5.0) * rng.integers(0, 2),
            bottom=rng.uniform(1.0, 5.0) * rng.integers(0, 2),
        )
        reach = hole.boss / 2.0 + GAP
        clear = all(math.hypot(x - o.x, y - o.y) > reach + o.boss / 2.0 for o in holes)
        # Diameters and distances that differ tell the bores apart.
        told = all(abs(diameter - o.diameter) > 0.7 for o in holes)
        if clear and told and plate.inside(x, y) > reach:
            holes.append(hole)
        elif rng.random() < 0.01:
            wanted = max(2, wanted - 1)  # no room for more
    return Plate(outline=outline, thickness=plate.thickness, holes=tuple(holes), turn=turn, shift=plate.shift)


def write(folder: Path, seeds: list[int]) -> dict[int, Path]:
    """Write the parts of these seeds in a child process; return their files."""
    subprocess.run([sys.executable, __file__, str(folder), *map(str, seeds)], check=True, timeout=300)
    return {seed: folder / f"{seed}.step" for seed in seeds}


def main() -> None:
    """Write the files."""
    import gmsh
    from scipy.spatial.transform import Rotation

    folder, *seeds = sys.argv[1:]
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    for seed in map(int, seeds):
        plate = drawn(seed)
        gmsh.model.add(str(seed))
        half = plate.thickness / 2.0
        points = [occ.addPoint(x, y, -half) for x, y in plate.outline]
        lines = [occ.addLine(p, q) for p, q in zip(points, points[1:] + points[:1], strict=True)]
        face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        solid = [entity for entity in occ.extrude([(2, face)], 0.0, 0.0, plate.thickness) if entity[0] == 3]
        bosses = []
        for hole in plate.holes:
            for height, side in ((hole.top, 1.0), (hole.bottom, -1.0)):
                if height > 0.0:
                    cylinder = (hole.x, hole.y, side * half, 0.0, 0.0, side * height, hole.boss / 2.0)
                    bosses.append((3, occ.addCylinder(*cylinder)))
        if bosses:
            solid, _ = occ.fuse(solid, bosses)
        reach = half + 10.0
        tools = [(3, occ.addCylinder(h.x, h.y, -reach, 0, 0, 2.0 * reach, h.diameter / 2.0)) for h in plate.holes]
        solid, _ = occ.cut(solid, tools)
        about = Rotation.from_matrix(plate.turn).as_rotvec()
        occ.rotate(solid, 0.0, 0.0, 0.0, *about, float(np.linalg.norm(about)))  # an affine map would make splines
        occ.translate(solid, *plate.shift)
        occ.synchronize()
        gmsh.write(str(Path(folder) / f"{seed}.step"))
        gmsh.model.remove()
    gmsh.finalize()


if __name__ == "__main__":
    main()
