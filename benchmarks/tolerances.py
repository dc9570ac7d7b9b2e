"""Tolerances against direct checks of sampled geometry; writes benchmarks/results/tolerances.json.

The starter case with tolerances of places, pose, load and sizes. Each of the samples is drawn, meshed and checked anew
as solids on one mesh each, and compared with what ``alula tolerance`` says of that sample from as coarse solids.

    python -m benchmarks.tolerances [--samples 200] [--share PART/PARTS]
"""

import argparse
import json
import tempfile
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.fea.check.run import check_case
from alula.fea.refine.refinement import Effort
from alula.fea.tolerance.analysis import tolerance_case
from alula.fea.tolerance.result import ToleranceResult
from alula.geometry.base.errors import CaseError
from alula.loads.case.case import Case
from alula.loads.case.case_file import read_case
from alula.loads.case.toleranced import Variable, toleranced

Real = NDArray[np.float64]

TOLERANCES = {
    "pins": "0.2 mm",
    "pose.angle": "1 deg",
    "load_cases.lift.forces.0": "10 %",
    "parts.bar.thickness": "0.3 mm",
    "parts.bar.width": "0.5 mm",
    "parts.bar.fillet_radius": "0.3 mm",
    "joints.A.pin_diameter": "0.2 mm",
}
ONE_MESH = Effort(max_meshes=1)


def starter() -> Case:
    """Return the starter case with tolerances."""
    text = files("alula.loads.cases").joinpath("four-bar.toml").read_text(encoding="utf-8")
    path = Path(tempfile.mkdtemp()) / "starter.toml"
    path.write_text(text, encoding="utf-8")
    return read_case(str(path)).with_values({"tolerances": TOLERANCES})


def direct_case(case: Case, variables: Sequence[Variable], row: Real) -> Case:
    """Return the case with the deviations of places, pose, loads and sizes written into its entries.

    Parameters
    ----------
    case : Case
    variables : sequence of Variable
    row : ndarray, shape (d,)
        Deviations.

    Returns
    -------
    Case
    """
    values = {}
    for variable, x in zip(variables, row.tolist(), strict=True):
        if variable.kind == "place":
            link, point, axis = variable.target
            values[f"links.{link}.points.{point}.{axis}"] = f"{case.links[link].points[point][axis] + x!r} mm"
        elif variable.kind == "pose" and case.pose.travel is None:
            values["pose.angle"] = f"{case.pose.angle + x!r} rad"
        elif variable.kind == "size":
            values[variable.tolerance] = f"{variable.nominal + x!r} mm"
        elif variable.kind == "load" and variable.target[1] != -1:
            load_case, number = variable.target
            for axis, force in enumerate(case.load_cases[load_case].forces[number].force):
                values[f"load_cases.{load_case}.forces.{number}.force.{axis}"] = f"{force * (1.0 + x)!r} N"
        else:
            raise CaseError(f"{variable.tolerance}: it has no entry of its own here; leave it out")
    return case.with_values(values)


def compared(case: Case, result: ToleranceResult, sample: int) -> list[dict[str, Any]]:
    """Return every number of a sample beside that of its direct check.

    Parameters
    ----------
    case : Case
    result : ToleranceResult
    sample : int

    Returns
    -------
    list of dict
    """
    direct = check_case(
        direct_case(case, toleranced(case), result.deviations[sample]), fidelity="solid", threads=1, effort=ONE_MESH
    )
    found = []
    for one in (number for number in result.numbers if number.certain is not None):
        own = next(
            o for o in direct.load_cases[one.load_case].checks if (o.name, str(o.subject)) == (one.check, one.subject)
        )
        found.append(
            {
                "check": one.check,
                "subject": one.subject,
                "sample": sample,
                "value": float(one.values[sample]),
                "low": float(one.low[sample]),
                "high": float(one.high[sample]),
                "direct": own.value.value,
                "direct_low": own.value.low,
                "direct_high": own.value.high,
            }
        )
    return found


def summary(rows: Sequence[Mapping[str, Any]], result: ToleranceResult) -> list[dict[str, Any]]:
    """Return per number how far samples are from direct checks, and both shares that keep a limit amid them.

    The limit is the median of all samples, so that about half of them keep it.

    Parameters
    ----------
    rows : sequence of dict
    result : ToleranceResult

    Returns
    -------
    list of dict
    """
    from scipy.stats import binomtest

    found = []
    for one in (number for number in result.numbers if number.certain is not None):
        own = [row for row in rows if (row["check"], row["subject"]) == (one.check, one.subject)]
        told, direct = (np.array([row[which] for row in own]) for which in ("value", "direct"))
        off = told / direct - 1.0
        inside = [row["low"] <= row["direct"] <= row["high"] for row in own]
        limit = float(np.median(one.values))
        kept = int((direct >= limit).sum())
        interval = binomtest(kept, len(own)).proportion_ci(0.95, method="exact")
        found.append(
            {
                "check": one.check,
                "subject": one.subject,
                "samples": len(own),
                "median_difference": float(np.median(off)),
                "median_of_its_size": float(np.median(np.abs(off))),
                "largest": float(np.abs(off).max()),
                "within_1_percent": float((np.abs(off) <= 0.01).mean()),
                "inside_the_band": float(np.mean(inside)),
                "deviation_of_direct": float(np.log(direct).std()),
                "correlation": float(np.corrcoef(np.log(told), np.log(direct))[0, 1]),
                "probability_above_its_median": float((one.values >= limit).mean()),
                "direct_share_above": kept / len(own),
                "direct_interval": [float(interval.low), float(interval.high)],
            }
        )
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--samples", type=int, default=200)
    parser.add_argument("--rows", type=Path, help="file of rows, to which more are added")
    parser.add_argument("--part", default="1/1", help="of several processes, which share of the samples: 1/2")
    options = parser.parse_args()
    number, parts = map(int, options.part.split("/"))
    case = starter()
    result = tolerance_case(case, samples=20_000, threads=1, effort=ONE_MESH)
    rows = []
    if options.rows and options.rows.exists():
        rows = [json.loads(line) for line in options.rows.read_text(encoding="utf-8").splitlines()]
    done = {row["sample"] for row in rows}
    for sample in (s for s in range(options.samples) if s not in done and s % parts == number - 1):
        new = compared(case, result, sample)
        rows += new
        print(sample, *(f"{row['value'] / row['direct'] - 1.0:+.3f}" for row in new), flush=True)
        if options.rows:
            with options.rows.open("a", encoding="utf-8") as file:
                file.writelines(json.dumps(row) + "\n" for row in new)
    if number == parts:
        from benchmarks.record import save

        print(save("tolerances", {"tolerances": TOLERANCES, "numbers": summary(rows, result)}))


if __name__ == "__main__":
    main()
