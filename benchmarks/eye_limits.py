"""What a perfectly plastic eye bears, by limit analysis, over the formulas of ``fea/modes/eye_modes.py``.

    python -m benchmarks.eye_limits [anew | pressures]

Writes ``fea/eye_scatter.toml`` from drawn eyes, and tries it on further ones. Eyes that are kept are not solved again,
unless ``anew``; ``pressures`` for what pins in contact bear more than pressures that are given.

Eyes are drawn: outer radius over that of the hole, pin over hole, shank over eye, and the angle of the force to the
pull straight off the shank. Of the eye alone the strength is in question: the shank is five times as strong, and held
one outer radius behind the eye. A pin does not rub. One that is loose lies on the wall as far round as when it has
moved ``DENT`` of its diameter into it. Thickness is between its limits: a thin eye is in plane stress, and no thicker
one bears less over its thickness (that stress field is in equilibrium in it too); none bears more than in plane strain
(that motion is one of its own).

Each stress field that is in equilibrium and nowhere beyond von Mises' condition bears no more than the eye does (lower
bound theorem of limit analysis). The best of those that are linear in each triangle, with jumps along edges where
equilibrium allows them (after Sloan, 1988), is found by a cone programme, which needs ``pip install clarabel``. Finer
meshes give more. The results are in ``benchmarks/results/eyes.json``.
"""

import json
import math
import sys
from pathlib import Path
from typing import Any

import gmsh
import numpy as np
import scipy.sparse as sp

from alula.fea.modes.eye_modes import EyeMode, RoundEye, asme_bth_1
from benchmarks.record import RESULTS, save

KEPT = RESULTS / "eyes.json"
SCATTER = Path(__file__).parents[1] / "fea" / "eye_scatter.toml"
CALIBRATING, TRYING = 60, 30
"""Eyes from which the bands come, and further ones on which they are tried."""
RATIOS = (1.3, 7.0)
"""Outer over inner radius, evenly in their logarithm."""
PINS = (0.85, 1.0)
"""Pin over hole; every second pair of eyes has one that fits."""
SHANKS = (0.5, 1.0)
"""Width of the shank over that of the eye."""
ANGLES = (0.0, 150.0)
"""Of the force [degrees]: beyond, it presses into the shank, and bearing alone is asked for."""
ELEMENT = 0.11
"""Largest edge over the outer radius."""
DENT = 0.05
"""Over the pin's diameter; assumed."""
STRONG = 5.0
"""Strength of the shank over that of the eye, so that the eye ends first."""
MARGIN = 1.05
"""On both ends of a band, beyond what the calibrating eyes have."""
NEAR = 1.05
"""An eye tries each formula that gives no more than so many times the least one."""


def mesh(radius: float, shank: float, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Return corners (n, 2) and triangles (m, 3) of an eye about a hole of radius 1 with its shank towards -x."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    shape, half = gmsh.model.occ, shank * radius
    disc, bar = shape.addDisk(0, 0, 0, radius, radius), shape.addRectangle(-2 * radius, -half, 0, 2 * radius, 2 * half)
    whole, _ = shape.fuse([(2, disc)], [(2, bar)])
    shape.cut(whole, [(2, shape.addDisk(0, 0, 0, 1, 1))])
    shape.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", size * radius)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 5.0 / size)
    gmsh.model.mesh.generate(2)
    tags, places, _ = gmsh.model.mesh.getNodes()
    number = {tag: row for row, tag in enumerate(tags)}
    nodes = np.array([number[tag] for tag in gmsh.model.mesh.getElements(2)[2][0]])
    gmsh.finalize()
    used, triangles = np.unique(nodes, return_inverse=True)
    return places.reshape(-1, 3)[used, :2], triangles.reshape(-1, 3)


def reach(pin: float) -> float:
    """Return the cosine of the angle from the force up to which a pin (its diameter over the hole's) is in contact."""
    return (1.0 - pin) / (1.0 - pin + DENT * 2.0 * pin)


def traction(normal: np.ndarray, along: np.ndarray, element: int, corner: int) -> list[tuple[int, float]]:
    """Return the traction on a face along a direction as (unknown, factor); unknowns are σx, σy, τ of every corner."""
    first = 9 * element + 3 * corner
    shear = normal[0] * along[1] + normal[1] * along[0]
    return [(first, normal[0] * along[0]), (first + 1, normal[1] * along[1]), (first + 2, shear)]


def matrix(rows: list[list[tuple[int, float]]], columns: int) -> sp.csc_matrix:
    """Return the rows as a sparse matrix."""
    if not rows:
        return sp.csc_matrix((0, columns))
    entries = [(row, column, value) for row, one in enumerate(rows) for column, value in one]
    row, column, value = zip(*entries, strict=True)
    return sp.csc_matrix((value, (row, column)), shape=(len(rows), columns))


def limit_load(
    radius: float,
    angle: float,
    pin: float = 1.0,
    shank: float = 1.0,
    *,
    thick: bool = False,
    given: float = 0.0,
    size: float = ELEMENT,
) -> float:
    """Return a force that an eye bears over (hole diameter · thickness · yield strength), pulled at an angle [rad].

    ``thick`` for plane strain; ``given`` for a pressure as a cosine over so many degrees in place of contact.
    """
    import clarabel

    places, triangles = mesh(radius, shank, size)
    count, even, pressed = 9 * len(triangles), list[list[tuple[int, float]]](), list[list[tuple[int, float]]]()
    faces: dict[tuple[int, int], list[int]] = {}
    for element, corners in enumerate(triangles):
        slopes = np.linalg.inv(np.column_stack([np.ones(3), places[corners]]))[1:]
        for first, second in ((0, 2), (2, 1)):  # ∂σx/∂x + ∂τ/∂y = 0, ∂τ/∂x + ∂σy/∂y = 0
            even.append(
                [(9 * element + 3 * k + first, slopes[0, k]) for k in range(3)]
                + [(9 * element + 3 * k + second, slopes[1, k]) for k in range(3)]
            )
        for i, j in ((0, 1), (1, 2), (2, 0)):
            faces.setdefault(tuple(sorted((int(corners[i]), int(corners[j])))), []).append(element)  # type: ignore[arg-type]
    force, towards = np.zeros((2, count)), np.array([math.cos(angle), math.sin(angle)])
    for ends, elements in faces.items():
        edge = places[ends[1]] - places[ends[0]]
        length, middle = np.hypot(*edge), places[list(ends)].mean(axis=0)
        normal = np.array([edge[1], -edge[0]]) / length
        at_hole = np.hypot(*middle) < 1.0001
        at_pin = at_hole and middle @ towards >= reach(pin) * np.hypot(*middle)
        if at_hole and normal @ middle > 0.0:
            normal = -normal
        tangent = np.array([-normal[1], normal[0]])
        for end in ends:
            corner = [int(np.flatnonzero(triangles[element] == end)[0]) for element in elements]
            if len(elements) == 2:
                for along in np.eye(2):
                    one, other = (traction(normal, along, *of) for of in zip(elements, corner, strict=True))
                    even.append(one + [(unknown, -factor) for unknown, factor in other])
            elif at_pin:
                even.append(traction(normal, tangent, elements[0], corner[0]))
                pressure = traction(normal, normal, elements[0], corner[0])
                if given:  # the last unknown is the pressure in the middle
                    off = math.acos(min(1.0, float(places[end] @ towards) / np.hypot(*places[end])))
                    share = max(0.0, math.cos(min(off * 180.0 / given, math.pi / 2.0)))
                    even.append([*pressure, (count, share)])
                else:
                    pressed.append(pressure)
                for axis, along in enumerate(np.eye(2)):
                    for unknown, factor in traction(normal, along, elements[0], corner[0]):
                        force[axis, unknown] += factor * length / 2.0
            elif at_hole or middle[0] > -2.0 * radius + 1e-6:
                even += [traction(normal, along, elements[0], corner[0]) for along in np.eye(2)]
    across, unknowns = np.array([-towards[1], towards[0]]) @ force, count + 1
    at, half, root = np.arange(count // 3), 0.0 if thick else 0.5, math.sqrt(3.0)
    twist = root / 2.0
    cone = sp.csc_matrix(  # (σx + σy)/2 unless thick, √3 (σx - σy)/2 and √3 τ are no longer than the strength
        (
            np.repeat([-half, -half, -twist, twist, -root], len(at)),
            (
                np.concatenate([4 * at + 1, 4 * at + 1, 4 * at + 2, 4 * at + 2, 4 * at + 3]),
                np.concatenate([3 * at, 3 * at + 1, 3 * at, 3 * at + 1, 3 * at + 2]),
            ),
        ),
        shape=(4 * len(at), unknowns),
    )
    bound = np.zeros(4 * len(at))
    outside = np.hypot(*places[triangles].mean(axis=1).T) > radius
    bound[::4] = np.where(np.repeat(outside, 3), STRONG, 1.0)
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    solution = clarabel.DefaultSolver(
        sp.csc_matrix((unknowns, unknowns)),
        np.append(-(towards @ force), 0.0),
        sp.vstack(
            [matrix(even, unknowns), sp.csc_matrix(np.append(across, 0.0)), matrix(pressed, unknowns), cone]
        ).tocsc(),
        np.concatenate([np.zeros(len(even) + 1 + len(pressed)), bound]),
        [
            clarabel.ZeroConeT(len(even) + 1),
            clarabel.NonnegativeConeT(len(pressed)),
            *(clarabel.SecondOrderConeT(4) for _ in at),
        ],
        settings,
    ).solve()
    return -float(solution.obj_val) / 2.0


def draw(seed: int = 1) -> list[dict[str, float]]:
    """Return the proportions of drawn eyes."""
    by, found = np.random.default_rng(seed), []
    for number in range(CALIBRATING + TRYING):
        ratio = math.exp(by.uniform(*map(math.log, RATIOS)))
        pin, shank, angle = (float(by.uniform(*ends)) for ends in (PINS, SHANKS, ANGLES))
        found.append({"ratio": ratio, "pin": pin if number // 2 % 2 else 1.0, "shank": shank, "angle": angle})
    return found


MODES = (EyeMode.NET_SECTION, EyeMode.FRACTURE, EyeMode.SHEAR_OUT, EyeMode.BEARING)


def of_mode(eyes: list[dict[str, Any]], mode: EyeMode) -> list[tuple[float, float]]:
    """Return what eyes that try a formula bear over it, in plane stress and in plane strain."""
    return [tuple(eye["over_formula"][mode]) for eye in eyes if mode in eye["over_formula"]]


def formulas(eye: dict[str, float]) -> dict[EyeMode, float]:
    """Return what an eye bears by each formula over (hole diameter · thickness · strength), where F_u = F_y."""
    made = RoundEye(radius=eye["ratio"], hole=2.0, pin=2.0 * eye["pin"], thickness=1.0, wall=1.0)
    found = asme_bth_1(made, 1.0, 1.0)
    return {mode: found[mode] / 2.0 for mode in MODES}


def lost(eye: dict[str, Any], low: dict[EyeMode, float]) -> float:
    """Return the least share of its sine by which a force at an angle must lower all modes but bearing."""
    bears = {mode: low[mode] * force for mode, force in formulas(eye).items()}
    if bears.pop(EyeMode.BEARING) <= eye["oblique"]:
        return 0.0
    return max(0.0, (1.0 - eye["oblique"] / min(bears.values())) / math.sin(math.radians(eye["angle"])))


def tried(eye: dict[str, float]) -> dict[str, Any]:
    """Return what an eye bears, and over each formula that may decide."""
    ratio, pin, shank, modes = eye["ratio"], eye["pin"], eye["shank"], formulas(eye)
    thin, thick = (limit_load(ratio, 0.0, pin, shank, thick=thick) for thick in (False, True))
    near = {mode: (thin / force, thick / force) for mode, force in modes.items() if force <= NEAR * min(modes.values())}
    oblique = limit_load(ratio, math.radians(eye["angle"]), pin, shank)
    return {**eye, "thin": thin, "thick": thick, "oblique": oblique, "over_formula": near}


def table(eyes: list[dict[str, Any]]) -> str:
    """Return the file of scatter, and print what the eyes that try it make of it."""
    ours, others = eyes[:CALIBRATING], eyes[CALIBRATING:]
    ends = {}
    for mode in MODES:
        own, held_out = of_mode(ours, mode), of_mode(others, mode)
        ends[mode] = low, high = min(x for x, _ in own) / MARGIN, max(x for _, x in own) * MARGIN
        held = sum(low <= thin and thick <= high for thin, thick in held_out)
        print(
            f"{mode}: {len(own)} eyes, {low:.3f} to {high:.3f}; of {len(held_out)} others {held} held, "
            f"{min(x for x, _ in held_out):.3f} to {max(x for _, x in held_out):.3f}"
        )
    low = {mode: ends[mode][0] for mode in MODES}
    across = min(1.0, MARGIN * max(lost(eye, low) for eye in ours))
    most = [lost(eye, low) for eye in others]
    print(f"across {across:.3f}; others at most {max(most):.3f}, {sum(x <= across for x in most)} of {len(most)} held")
    lines = [
        "# Limit analysis of drawn eyes over the formulas of ASME BTH-1 where F_u = F_y: [least, largest], widened by",
        "# the margin; the share of its sine by which a force at an angle lowers them; and the proportions drawn.",
        "# Written by benchmarks/eye_limits.py; do not edit.",
        f"eyes = {len(ours)}",
        f"margin = {MARGIN}",
        f"across = {across:.3f}",
        *("[ranges]", f"ratio = {list(RATIOS)}", f"pin = {list(PINS)}", f"shank = {list(SHANKS)}"),
        *("[modes]", *(f"{mode.name} = [{low:.3f}, {high:.3f}]" for mode, (low, high) in ends.items())),
    ]
    return "\n".join(lines) + "\n"


def pressures() -> None:
    """Print what eyes bear under a pin in contact over what they bear under a cosine over 180°, and that over 90°.

    Of the eyes that try the bands, with a pin that fits, pulled straight.
    """
    for eye in draw()[CALIBRATING:]:
        ratio, shank = eye["ratio"], eye["shank"]
        contact, wide, narrow = (limit_load(ratio, 0.0, 1.0, shank, given=given) for given in (0.0, 180.0, 90.0))
        print(f"ratio {ratio:.2f}, shank {shank:.2f}: {contact / wide:.3f} of 180°, {wide / narrow:.3f}", flush=True)


def main() -> None:
    """Compare drawn eyes with the formulas."""
    found = [] if sys.argv[1:] == ["anew"] else json.loads(KEPT.read_text(encoding="utf-8"))["eyes"]
    for eye in draw()[len(found) :]:
        found.append(tried(eye))
        print(json.dumps(found[-1]), flush=True)
        save("eyes", {"element": ELEMENT, "dent": DENT, "eyes": found})
    SCATTER.write_text(table(found), encoding="utf-8")


if __name__ == "__main__":
    pressures() if sys.argv[1:] == ["pressures"] else main()
