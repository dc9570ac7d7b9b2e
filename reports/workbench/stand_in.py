"""Stand-ins of what is not built yet: a document that takes ``set`` alone, workers and solids that tell nothing."""

import tomllib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import tomlkit

from alula.geometry.base.errors import CaseError


class Document:
    """The text of a case, its changes, and what they can be taken back to."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.revision = 1
        self._before: list[tuple[str, str]] = []
        self._after: list[str] = []

    @property
    def can_undo(self) -> bool:
        return bool(self._before)

    @property
    def can_redo(self) -> bool:
        return bool(self._after)

    def apply(self, operations: Sequence[Mapping[str, Any]], pose: Any, gesture: str = "") -> None:
        made: Any = tomlkit.parse(self.text)
        for one in operations:
            if one.get("op") != "set":
                raise CaseError(f"operation '{one.get('op')}': it is not known yet")
            here = made
            for key in one["path"][:-1]:
                here = here[key]
            here[one["path"][-1]] = one["value"]
        self.replace(tomlkit.dumps(made), gesture)

    def replace(self, text: str, gesture: str = "") -> None:
        if not (gesture and self._before and self._before[-1][0] == gesture):
            self._before.append((gesture, self.text))
        self._after = []
        self._stand(text)

    def undo(self) -> None:
        if self._before:
            self._after.append(self.text)
            self._stand(self._before.pop()[1])

    def redo(self) -> None:
        if self._after:
            self._before.append(("", self.text))
            self._stand(self._after.pop())

    def _stand(self, text: str) -> None:
        self.text = text
        self.revision += 1

    def tables(self) -> dict[str, Any]:
        try:
            return tomllib.loads(self.text.removeprefix("\ufeff").replace("\r\n", "\n"))
        except ValueError as error:
            raise CaseError(f"this is not valid TOML: {error}") from None

    def line_of(self, problem: str) -> int | None:
        return None


class Workers:
    """Answers nothing."""

    def __init__(self, tell: Callable[[str, dict[str, Any]], None], folder: Path) -> None: ...

    def ask(self, revision: int, text: str, name: str) -> None: ...

    async def close(self) -> None: ...


class Solids:
    """Solves nothing."""

    def __init__(self, tell: Callable[[str, dict[str, Any]], None], folder: Path) -> None: ...

    def start(self, revision: int, text: str, name: str, fidelity: str = "solid") -> None: ...

    def stop(self) -> None: ...

    def model(self, link: str) -> dict[str, Any]:
        raise CaseError(f"'{link}': no solid of this link stands")

    async def close(self) -> None: ...
