"""``frequencies.html``, and what the page of a check shows of natural frequencies."""

from collections.abc import Mapping
from typing import Any

from alula.fea.vibration.frequency_outcomes import deciding_load_case
from alula.fea.vibration.over_motion import CaseFrequencies
from alula.reports.figures.sheet.drawing import Drawing
from alula.reports.figures.vibration.pictures import campbell_name, shapes_name
from alula.reports.page.template import fill
from alula.reports.tables.frequencies import LEFT_OUT, history_sentence, mode_rows

PAGE = "frequencies.html"


def frequencies_view(
    found: CaseFrequencies | None, pictures: Mapping[str, Drawing], *, opened: bool = False
) -> dict[str, Any] | None:
    """Return what the section of natural frequencies shows.

    Parameters
    ----------
    found : CaseFrequencies or None
    pictures : mapping
        Name -> Drawing; the page omits missing ones.
    opened : bool, optional
        Whether its tables are shown from the start.

    Returns
    -------
    dict or None
        None where frequencies were not computed.
    """
    if found is None:
        return None
    first = deciding_load_case(found)
    rows = mode_rows(found)
    return {
        "load_cases": [
            {
                "name": name,
                "sentence": history_sentence(found.case, history),
                "shapes": pictures.get(shapes_name(name)),
                "campbell": pictures.get(campbell_name(name)),
                "rows": [row for row in rows if row["load_case"] == name],
                "driving": history.driving,
                "notes": history.lowest.notes,
            }
            for name, history in sorted(found.histories.items(), key=lambda item: item[0] != first)
        ],
        "links": [row for row in rows if not row["load_case"]],
        "moves": found.case.motion is not None,
        "left_out": LEFT_OUT,
        "opened": opened,
    }


def frequencies_page(found: CaseFrequencies, pictures: Mapping[str, Drawing], *, name: str) -> str:
    """Return the page of natural frequencies.

    Parameters
    ----------
    found : CaseFrequencies
    pictures : mapping
        Name -> Drawing.
    name : str
        Of the case, as the command was given it.

    Returns
    -------
    str
    """
    view = frequencies_view(found, pictures, opened=True)
    return fill("frequencies_page.html.jinja", case=found.case, name=name, frequencies=view)
