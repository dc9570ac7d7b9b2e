"""``study.html``: one file with the pictures and tables of a study, which loads nothing from elsewhere."""

import os
from collections.abc import Sequence
from pathlib import Path

from alula.fea.study.store import NAME, Store
from alula.geometry.base.errors import CaseError
from alula.geometry.base.version import alula_version
from alula.reports.page.output import place, refuse_unusable, write_folder
from alula.reports.renderers.folder import drawn_pictures
from alula.reports.renderers.page import Page, as_page
from alula.reports.sections.markup import code
from alula.reports.sections.section import Picture, Section, Text, parts_of
from alula.reports.study.columns import StudyColumns, read_study
from alula.reports.study.sections import study_sections

PAGE = "study.html"
FOLDER = "pictures"
COMMAND = "study"


def write_study(folder: Path, output: Path, wanted: Sequence[str] = ()) -> Path:
    """Write the page and the pictures of a study.

    Parameters
    ----------
    folder : Path
        Of the study, which stays as it is.
    output : Path
        They are written into its subfolder ``study``.
    wanted : sequence of str, optional
        Parts of the names of numbers to be drawn.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    CaseError
        For a folder without a study, a study without points, and an output that is the folder of a study.
    CannotRunError
        Where the disk refuses.
    """
    refuse_folder(folder, output)
    with Store.reading(folder) as store:
        study = read_study(store, wanted)
    if not len(study.outcome):
        raise CaseError("study: no point of it has a result yet; go on with 'alula study', then draw it")
    page = study_page(study, study_sections(study))
    drawn = drawn_pictures(page)

    def fill(target: Path) -> None:
        (target / PAGE).write_text(as_page(page, drawn), encoding="utf-8")
        (target / FOLDER).mkdir()
        for name, picture in drawn.items():
            (target / FOLDER / f"{name}.png").write_bytes(picture.png())

    write_folder(output, COMMAND, fill)
    return output / COMMAND / PAGE


def study_page(study: StudyColumns, sections: Sequence[Section]) -> Page:
    """Return the page of a study.

    Parameters
    ----------
    study : StudyColumns
    sections : sequence of Section
        As ``study_sections``; it begins with what the first one tells.

    Returns
    -------
    Page
    """
    case, (alula, gmsh, *_) = study.facts["plan"]["case"], study.facts["versions"]
    return Page(
        title=f"Study: {Path(case).name}",
        kind="Study of a planar linkage",
        heading=Path(case).name,
        lead=tuple(part.text for part in sections[0].parts if isinstance(part, Text)),
        sections=tuple(sections[1:]),
        footer=(
            f"alula {alula_version()}. Computed with alula {alula} and gmsh {gmsh}. Case {code(case)}.",
            f"All numbers: {code('study.sqlite')} in the folder of the study.",
        ),
    )


def pictures_of(sections: Sequence[Section]) -> list[Picture]:
    """Return the pictures of sections.

    Parameters
    ----------
    sections : sequence of Section

    Returns
    -------
    list of Picture
    """
    return [part for section in sections for part in parts_of(section.parts) if isinstance(part, Picture)]


def refuse_folder(folder: Path, output: Path) -> None:
    """Refuse a folder for the page before anything is computed for it.

    Parameters
    ----------
    folder : Path
        Of the study, which may not be there yet.
    output : Path
        For the page.

    Raises
    ------
    CaseError, CannotRunError
        As ``write_study``.
    """
    target, study = place(output, COMMAND), Path(os.path.abspath(folder))
    if target in (study, study / COMMAND) or (target / NAME).exists():
        raise CaseError(f"output: '{output}' is the folder of a study, which stays as it is; choose another folder")
    refuse_unusable(output, COMMAND, (PAGE,))
