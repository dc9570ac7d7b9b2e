"""
A study of one dimension
========================

``alula.study`` computes variants side by side and keeps them in a folder. Here: the thickness of a four-bar's bars,
by hand calculation, in seconds.
"""

import tempfile

import alula

folder = tempfile.TemporaryDirectory()
found = alula.study(
    "four-bar",
    {"parts.bar.thickness": ["4 mm", "6 mm", "8 mm"]},
    folder.name,
    fidelity="beam",
    threads=1,
)
found

# %%
# What the study draws of its variants: here the margin of the check that is nearest to its limit.
pictures = found.pictures
print(*pictures, sep="\n")
next(iter(pictures.values()))

# %%
# Thicker bars pass by more. The folder keeps all numbers; the table has the check that is nearest to its limit.
rows = sorted((float(row["parts.bar.thickness"].split()[0]), row) for row in found.table())
for thickness, row in rows:
    print(f"{thickness:g} mm: {row['verdict']}, margin {row['margin']:.2f}, {row['nearest to its limit']}")
margins = [row["margin"] for _, row in rows]
assert margins == sorted(margins)

# %%
# An independent check: a bar's second moment of area is t b³/12, so that its deflection in the plane falls with its
# thickness.
thin, thick = (
    alula.check(
        alula.read_case("four-bar", {"parts.bar.thickness": thickness, "load_cases.lift.own_weight": False}),
        fidelity="beam",
    )
    .displacements["rocker"]
    .value
    for thickness in ("6 mm", "8 mm")
)
print(f"deflection of the rocker: {thin:.3f} mm at 6 mm, {thick:.3f} mm at 8 mm")
assert abs(thin / thick - 8.0 / 6.0) < 1e-6
folder.cleanup()
