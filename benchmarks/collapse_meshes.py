"""The band of the mesh of plastic collapse against finer meshes, of eyes drawn at random.

Writes benchmarks/results/collapse_meshes.json. Bars of 2.2 eyes length about pins of 5 mm, pulled straight: outer over
inner radius 1.4 to 3.5, width of the bar over that of the eye 0.55 to 1, 2 to 5 mm thick, fillets of 0.5 mm. The mesh
of the check, that with edges 1.6 times as long, and those with shorter ones, all at the same f·u. Some ten minutes.

    python -m benchmarks.collapse_meshes [COUNT]
"""

import math
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "benchmarks")]

from calculix_plasticity import pulled  # noqa: E402
from eye_case import EYES  # noqa: E402
from record import save  # noqa: E402

from alula.fea.elements.space import displacement_space  # noqa: E402
from alula.fea.judging.plastic_collapse import yield_law  # noqa: E402
from alula.fea.plastic.link_collapse import CAUTION, COARSER, ORDER, _ratio_in_flow  # noqa: E402
from alula.fea.plastic.load_path import LoadPath, ProportionalLoad, follow  # noqa: E402
from alula.fea.vibration.link_solid import first_mesh  # noqa: E402
from alula.geometry.meshing.mesh import mesh_body  # noqa: E402
from alula.loads.case.case import Case  # noqa: E402
from alula.loads.case.case_file import validate  # noqa: E402

PIN = 5.0
FINER = (0.8, 0.625)
"""Edges over those of the check's mesh."""


def drawn(by: np.random.Generator) -> dict[str, float]:
    """Return the proportions of an eye."""
    ratio = math.exp(by.uniform(math.log(1.4), math.log(3.5)))
    return {"ratio": ratio, "shank": float(by.uniform(0.55, 1.0)), "thickness": float(by.uniform(2.0, 5.0))}


def case_of(eye: dict[str, float]) -> Case:
    """Return a case with such a bar, whose link is ``level``."""
    outer = PIN * eye["ratio"]
    tables = tomllib.loads(EYES)
    sizes = {"eye_diameter": outer, "width": eye["shank"] * outer, "thickness": eye["thickness"]}
    sizes |= {"eye_thickness": eye["thickness"], "fillet_radius": 0.5}
    tables["parts"]["bar"] |= {name: f"{size:.4f} mm" for name, size in sizes.items()}
    length = 2.2 * outer
    tables["links"]["level"]["points"]["B"] = [f"{length:.6f} mm", "0 mm"]
    tables["links"]["rising"]["points"]["B"] = [f"{math.hypot(60.0, length):.9f} mm", "0 mm"]
    tables["pose"]["near"]["rising"] = f"{math.degrees(math.atan2(60.0, length)):.4f} deg"
    return validate(tables)


def tried(eye: dict[str, float], finer: tuple[float, ...] = FINER) -> dict[str, Any]:
    """Return the factors on all meshes, and the share by which the check's may be off."""
    case = case_of(eye)
    body, law = case.body("level"), yield_law(case.material_of("level"))
    pins = {"O": (0.0, -500.0), "B": (2.2 * PIN * eye["ratio"], 500.0)}
    loads, paths = dict[float, ProportionalLoad](), dict[float, LoadPath]()
    for edges in (1.0, COARSER, *finer):
        space = displacement_space(mesh_body(body, first_mesh(case).scaled(edges)))
        loads[edges] = pulled(space, law, pins, PIN)
        paths[edges] = follow(loads[edges], like=paths.get(1.0))
    own = paths[1.0]
    ratio = _ratio_in_flow(loads[1.0].body, own.last, loads[COARSER].body)
    band = CAUTION * abs(paths[COARSER].factor / own.factor - 1.0) / (ratio**ORDER - 1.0)
    change = {str(edges): path.factor / own.factor - 1.0 for edges, path in paths.items()}
    return {**eye, "factor": own.factor, "ratio_in_flow": ratio, "band": band, "change": change}


if __name__ == "__main__":
    by, eyes = np.random.default_rng(7), list[dict[str, Any]]()
    for _ in range(int(sys.argv[1]) if sys.argv[1:] else 10):
        eyes.append(tried(drawn(by)))
        print(eyes[-1], flush=True)
        save("collapse_meshes", {"eyes": eyes})
