"""The file of a linkage that another program saved, and the case that it makes."""

import tomllib
from typing import Literal

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_file import validate
from alula.loads.exchange.pmks import read_pmks
from alula.loads.exchange.pylinkage import read_pylinkage
from alula.loads.exchange.sketch import MALFORMED, case_text
from alula.loads.text.explain import printable

Program = Literal["pylinkage", "pmks"]


def case_of_linkage(program: Program, text: str, name: str, millimetres: float = 1.0) -> str:
    """Return the text of the case that a linkage makes.

    Parameters
    ----------
    program : {"pylinkage", "pmks"}
        What saved it.
    text : str
        Of its file.
    name : str
        Of its file; it prints.
    millimetres : float, optional
        Length of a unit of pylinkage, whose files do not state it [mm].

    Returns
    -------
    str

    Raises
    ------
    CaseError
        For a text that is no linkage, and for one that is no case or has no pose.
    """
    sketch = read_pylinkage(text, name, millimetres) if program == "pylinkage" else read_pmks(text, name)
    try:
        found = case_text(sketch)
        tables = tomllib.loads(found)
    except MALFORMED as error:
        raise CaseError(f"'{name}': its linkage makes no case ({printable(repr(error))}); save it anew") from None
    validate(tables).solve_pose()
    return found
