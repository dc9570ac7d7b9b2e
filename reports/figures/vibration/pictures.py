"""All pictures of natural frequencies, by name."""

from alula.fea.vibration.frequency_outcomes import deciding_load_case, unit
from alula.fea.vibration.over_motion import CaseFrequencies
from alula.reports.figures.sheet.canvas import Canvas
from alula.reports.figures.vibration.campbell import campbell_diagram
from alula.reports.figures.vibration.shapes import shapes_drawing


def shapes_name(load_case: str) -> str:
    """Return the name of the picture of shapes under a load case.

    Parameters
    ----------
    load_case : str

    Returns
    -------
    str
    """
    return f"shapes-{load_case}"


def campbell_name(load_case: str) -> str:
    """Return the name of the diagram of natural frequencies under a load case.

    Parameters
    ----------
    load_case : str

    Returns
    -------
    str
    """
    return f"campbell-{load_case}"


def frequency_pictures(found: CaseFrequencies | None, *, every: bool = False) -> dict[str, Canvas]:
    """Draw shapes and diagram of the load case that decides, or of every one.

    Parameters
    ----------
    found : CaseFrequencies or None
    every : bool, optional

    Returns
    -------
    dict of str to Canvas
        By name; nothing where frequencies were not computed.
    """
    if found is None:
        return {}
    case, drawn = found.case, dict[str, Canvas]()
    for name in found.histories if every else [deciding_load_case(found)]:
        history = found.histories[name]
        coordinate = "pose" if case.motion is None else case.motion_coordinate.name
        drawn[shapes_name(name)] = shapes_drawing(history.lowest)
        drawn[campbell_name(name)] = campbell_diagram(history, coordinate=coordinate, unit=unit(case), load_case=name)
    return drawn
