"""All pictures of a report, by name."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

from alula.fea.outcomes.result import CheckResult
from alula.fea.whole.size import size_limits
from alula.reports.tables.layers import build_directions_of
from alula.reports.tables.record import worst_load_case


def linkage_name(load_case: str) -> str:
    """Return the name of the linkage's drawing under a load case.

    Parameters
    ----------
    load_case : str
        Name of the load case.

    Returns
    -------
    str
    """
    return f"linkage-{load_case}"


def flapping_name(load_case: str) -> str:
    """Return the name of the figure of the drive with and without air on wings.

    Parameters
    ----------
    load_case : str
        Name of the load case.

    Returns
    -------
    str
    """
    return f"air-{load_case}"


ASSEMBLY, CONTACT, BOX = "assembly", "clearance", "box"
"""Names of the drawings of links in layers, of two outlines where they touch or come nearest, and of all in a box."""


def diagram_name(link: str) -> str:
    """Return the name of a link's N, V and M diagram.

    Parameters
    ----------
    link : str
        Name of the link.

    Returns
    -------
    str
    """
    return f"diagram-{link}"


def stress_name(link: str) -> str:
    """Return the name of a link's stress plot.

    Parameters
    ----------
    link : str
        Name of the link.

    Returns
    -------
    str
    """
    return f"stress-{link}"


def layers_name(link: str) -> str:
    """Return the name of the map of a printed link's directions of building.

    Parameters
    ----------
    link : str
        Name of the link.

    Returns
    -------
    str
    """
    return f"layers-{link}"


def governing_load_cases(result: CheckResult) -> tuple[str, ...]:
    """Return the first load case and those with the least safety factor of some link.

    Parameters
    ----------
    result : CheckResult

    Returns
    -------
    tuple of str
        Their names.
    """
    first = next(iter(result.load_cases.values()))
    return tuple(dict.fromkeys([first.name, *(worst_load_case(result, link).name for link in first.links)]))


def draw_pictures(
    result: CheckResult, progress: Callable[[str], None] = lambda message: None
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Draw every picture of a report.

    The linkage under every governing load case, and its links in layers; internal forces and, for a solid, stress of
    every link under its governing load case; of a printed link the safety factor of its layers over the direction of
    building. Shapes and diagram of natural frequencies under the load case that decides.

    Parameters
    ----------
    result : CheckResult
    progress : callable, optional
        Receives messages.

    Returns
    -------
    tuple
        Name -> PNG, and warnings.
    """
    from alula.reports.figures.build_map import build_map
    from alula.reports.figures.diagrams import internal_force_diagram
    from alula.reports.figures.drawings import linkage_drawing
    from alula.reports.figures.figures import stress_plots
    from alula.reports.figures.motion.air_figures import case_air_pictures
    from alula.reports.figures.outlines.assembly import assembly_drawing
    from alula.reports.figures.outlines.box import box_drawing
    from alula.reports.figures.outlines.contact import contact_drawing
    from alula.reports.figures.vibration.pictures import frequency_pictures

    worst = {link: worst_load_case(result, link).links[link] for link in next(iter(result.load_cases.values())).links}
    points = {link: result.case.links[link].points for link in worst}
    stations = {link: {point: x for point, (x, _) in points[link].items()} for link in worst}
    progress("Drawing the linkage, the internal forces and the stress plots ...")
    with ThreadPoolExecutor(1) as beside:  # its work is that of a child process
        rendered = beside.submit(stress_plots, worst, points)
        pictures = {linkage_name(name): linkage_drawing(result, name) for name in governing_load_cases(result)}
        if result.clearance is not None:
            pictures[ASSEMBLY] = assembly_drawing(result.clearance)
            if result.clearance.shown is not None:
                pictures[CONTACT] = contact_drawing(result.clearance)
        pictures |= frequency_pictures(result.frequencies)
        if result.size is not None and (limits := size_limits(result.case)):
            pictures[BOX] = box_drawing(result.size, limits)
        pictures |= {flapping_name(name): figure for name, figure in case_air_pictures(result.in_air).items()}
        pictures |= {
            diagram_name(link): internal_force_diagram(found.beam, stations[link])
            for link, found in worst.items()
            if not found.beam.without
        }
        pictures |= {
            layers_name(link): build_map(layers)
            for link, layers in build_directions_of(result).items()
            if layers.scan is not None
        }
        plots, warnings = rendered.result()
    return pictures | {stress_name(link): plot for link, plot in plots.items()}, warnings


def repacked(picture: bytes) -> bytes:
    """Return a PNG as lossless WebP, which takes some six tenths of the bytes where colours shade into one another.

    Parameters
    ----------
    picture : bytes

    Returns
    -------
    bytes
    """
    from io import BytesIO

    from PIL import Image

    packed = BytesIO()
    with Image.open(BytesIO(picture)) as image:
        image.save(packed, "WEBP", lossless=True, quality=60)
    return packed.getvalue()
