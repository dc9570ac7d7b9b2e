"""Draws a pin in its holes, seated and tilted, for docs/images: ``python -m benchmarks.pin_picture``."""

from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes

mpl.use("Agg")
import matplotlib.pyplot as plt

TARGET = Path(__file__).resolve().parents[1] / "docs" / "images" / "pin-in-hole.png"
DIAMETER, CLEARANCE, LENGTH, GAP, REACH = 3.0, 0.6, 4.0, 0.6, 5.2
"""Of the pin, its clearance, plates and the gap between them, and how far plates are drawn [mm]; the clearance is drawn
many times as wide as in any fit."""
STEEL, LOWER, UPPER, FORCE = "#5b6770", "#c9b79c", "#9fb8cc", "#b3261e"


def plate(axes: Axes, bottom: float, middle: float, hole: float, colour: str) -> None:
    """Draw a plate in section, with a hole [mm]."""
    for left, right in ((-REACH, middle - hole / 2.0), (middle + hole / 2.0, REACH)):
        axes.fill_between([left, right], bottom, bottom + LENGTH, facecolor=colour, edgecolor="black", linewidth=0.8)


def pin(axes: Axes, slope: float, top: float) -> None:
    """Draw a pin that stands upright in the lower plate, and with a slope above it."""
    z = [0.0, LENGTH, top]
    x = [0.0, 0.0, slope * (top - LENGTH)]
    left, right = ([one + side * DIAMETER / 2.0 for one in x] for side in (-1.0, 1.0))
    axes.fill_betweenx(z, left, right, facecolor=STEEL, edgecolor="black", linewidth=0.8)
    axes.plot(x, z, color="white", linewidth=0.8, linestyle=(0, (6, 3, 1, 3)))


def arrow(axes: Axes, x: float, z: float, along: float) -> None:
    """Draw a force on a rim."""
    axes.annotate("", (x, z), (x - along, z), arrowprops={"arrowstyle": "-|>", "color": FORCE, "lw": 1.8})


def main() -> None:
    """Draw both states."""
    figure, (one, other) = plt.subplots(1, 2, figsize=(8.0, 4.2), sharey=True)
    low, high = LENGTH + GAP, 2.0 * LENGTH + GAP
    slope = CLEARANCE / LENGTH
    tilted = slope * (GAP + LENGTH / 2.0)
    for axes, own, middle in ((one, 0.0, -CLEARANCE / 2.0), (other, slope, tilted)):
        plate(axes, 0.0, 0.0, DIAMETER, LOWER)
        plate(axes, low, middle, DIAMETER + CLEARANCE, UPPER)
        pin(axes, own, high + 1.0)
        axes.axis("off")
        axes.set_aspect("equal")
        axes.set_xlim(-7.6, 7.6)
        axes.text(-REACH + 0.15, LENGTH - 0.7, "pressed", fontsize=9)
        axes.text(-REACH + 0.15, high - 0.7, "running", fontsize=9)
        axes.annotate("", (6.0, low), (6.0, high), arrowprops={"arrowstyle": "<->", "lw": 0.8})
        axes.text(6.2, (low + high) / 2.0, "t", fontsize=10, va="center")
    wall = (DIAMETER + CLEARANCE) / 2.0
    for z in (low + 0.15, high - 0.15):
        arrow(one, wall - CLEARANCE / 2.0, z, -2.2)
    arrow(other, tilted + wall, high - 0.15, -2.2)
    arrow(other, tilted - wall, low + 0.15, 2.2)
    one.set_title("seated: both rims on one side,\nbears up to F t/2", fontsize=10)
    other.set_title("tilted by c/t: rims on opposite sides,\nbears more", fontsize=10)
    figure.tight_layout()
    figure.savefig(TARGET, dpi=110)


if __name__ == "__main__":
    main()
