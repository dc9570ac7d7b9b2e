"""What every picture is: a description that is asked for as PNG or as an element of a page, and tells what it plots."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Plotted:
    """A curve as it stands in a picture, in the units that the labels of its axes name.

    Attributes
    ----------
    name : str
        Of the curve, as the legend has it; "" where it has none.
    x, y : ndarray, shape (n,)
    x_label, y_label : str
        Of the axes.
    """

    name: str
    x: Real
    y: Real
    x_label: str
    y_label: str

    @property
    def unit(self) -> str:
        """What stands in brackets in the label of y; "" for a pure number."""
        found = re.search(r"\[([^\]]*)\]\s*$", self.y_label)
        return found[1] if found else ""


class Drawing(Protocol):
    """A picture: a sheet or a chart."""

    def png(self) -> bytes:
        """Return it as PNG, without a date, so that equal pictures are equal bytes.

        Returns
        -------
        bytes
        """
        ...

    def element(self, alt: str) -> str:
        """Return it as an element of a page.

        Parameters
        ----------
        alt : str
            What it shows, for who does not see it.

        Returns
        -------
        str
        """
        ...

    @property
    def plotted(self) -> Sequence[Plotted]:
        """Its curves, in the units of their axes."""
        ...


def data_uri(picture: bytes) -> str:
    """Return the bytes of a PNG, WebP or GIF file as a data URI.

    Parameters
    ----------
    picture : bytes

    Returns
    -------
    str
    """
    import base64

    kind = "webp" if picture.startswith(b"RIFF") else "gif" if picture.startswith(b"GIF") else "png"
    return f"data:image/{kind};base64," + base64.b64encode(picture).decode("ascii")
