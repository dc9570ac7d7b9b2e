"""The moving linkage as an animated GIF, drawn without a display."""

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from numpy.typing import NDArray
from PIL import Image

from alula.fea.findings.joint_paths import moving_points
from alula.geometry.linkage.motion import Motion
from alula.reports.figures.motion.motion_figures import COLOURS, chains, ground, plane
from alula.reports.figures.sheet.style import quiet_glyphs

Real = NDArray[np.float64]

FRAMES = 60
SECONDS = 3.0
"""Length of one full turn, or of the way there and back."""
_COLOURS = 64
_SAMPLES = 4
"""Frames by which the colours are chosen: all hold the same things."""
_STEPS = np.uint8(0xFC)
"""Bits of a colour that are kept: Pillow finds the nearest colour of a palette in steps of 4."""
_PLACES = np.array([1 << 16, 1 << 8, 1])
_DPI = 80


def draw_animation(motion: Motion, path: Path) -> None:
    """Draw one full turn, or a range there and back, as a GIF that repeats.

    Parameters
    ----------
    motion : Motion
    path : Path
        File to write.
    """
    figure, axes = plane(motion, width=7.0)
    for xy in moving_points(motion).values():
        axes.plot(*xy.T, color="0.75", linewidth=1.0, zorder=1)
    ground(axes, motion)
    drawn = []
    for i, chain in enumerate(chains(motion.linkage)):
        colour = COLOURS[i % len(COLOURS)]
        [line] = axes.plot([], [], color=colour, linewidth=3.0, marker="o", markersize=5, markerfacecolor="white")
        drawn.append((line, [motion.column(link, point) for link, point in chain]))
    title = axes.set_title("", parse_math=False, loc="left", fontsize=10)
    figure.set_dpi(_DPI)
    canvas = FigureCanvasAgg(figure)
    angles = _angles(motion)
    points = motion.closure.positions(motion.track.at(angles))
    frames = []
    with quiet_glyphs():
        title.set_text(motion.coordinate.name)
        moving = [*(line for line, _ in drawn), *axes.texts, title]  # names stand above the links
        for artist in moving:
            artist.set_animated(True)
        canvas.draw()
        figure.set_layout_engine("none")  # laid out once: a layout of its own per frame would shake
        still = canvas.copy_from_bbox(figure.bbox)
        for angle, here in zip(angles, points, strict=True):
            canvas.restore_region(still)
            for line, columns in drawn:
                line.set_data(here[columns].real, here[columns].imag)
            title.set_text(f"{motion.coordinate} at {motion.told(angle):.1f} {motion.unit}")
            for artist in moving:
                axes.draw_artist(artist)
            frames.append(np.asarray(canvas.buffer_rgba())[..., :3] & _STEPS)
    pictures = _indexed(frames)
    pictures[0].save(
        path,
        save_all=True,
        append_images=pictures[1:],
        duration=round(1000.0 * SECONDS / len(frames)),
        loop=0,
        optimize=True,
    )


def _indexed(frames: list[NDArray[np.uint8]]) -> list[Image.Image]:
    """Return frames (height, width, 3) in the colours that are most frequent in some of them, or they would flicker."""
    found, counts = np.unique(
        np.concatenate(frames[:: len(frames) // _SAMPLES]).reshape(-1, 3) @ _PLACES, return_counts=True
    )
    colours = found[np.argsort(-counts, kind="stable")[:_COLOURS], None] // _PLACES % 256
    palette = Image.new("P", (1, 1))
    palette.putpalette(colours.astype(np.uint8).tobytes())
    pictures = [Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    for picture in pictures:
        picture.putpalette(np.rint(colours * (255.0 / _STEPS)).astype(np.uint8).tobytes())
    return pictures


def _angles(motion: Motion) -> Real:
    """Angles of the coordinate at the frames: evenly spread in time (in the angle where there is none)."""
    clock = motion.times if motion.times is not None else np.abs(motion.angles - motion.angles[0])
    if motion.instants is not None:
        clock = motion.progress - motion.progress[0]
    last = float(clock[-1])
    if motion.returns or motion.instants is not None:
        wanted = np.linspace(0.0, last, FRAMES, endpoint=False)
    else:
        there = np.linspace(0.0, last, FRAMES // 2 + 1)
        wanted = np.concatenate([there, there[-2:0:-1]])
    return np.interp(wanted, clock, motion.angles)
