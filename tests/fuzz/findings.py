"""How many inputs were tried, how long that took, and which of them failed: one JSON file per target and engine."""

import json
import time
import traceback
from dataclasses import dataclass, field
from pathlib import Path

from fuzz import targets

MOST = 20
"""Different faults after which a target is given up."""


@dataclass(kw_only=True)
class Findings:
    """The record of one target under one engine.

    tried     inputs so far
    accepted  how many of them were valid
    faults    where it failed -> input and traceback, one for each place
    """

    engine: str
    target: str
    folder: Path
    tried: int = 0
    accepted: int = 0
    last: object = None
    faults: dict[str, dict[str, str]] = field(default_factory=dict)
    begun: float = field(default_factory=time.perf_counter)

    @property
    def full(self) -> bool:
        """True where there are faults enough to work on."""
        return len(self.faults) >= MOST

    def keep(self, data: object, fault: BaseException) -> None:
        """Keep an input that failed, unless one failed at the same place already."""
        frames = [f for f in traceback.extract_tb(fault.__traceback__) if "/fuzz/" not in f.filename]
        place = f"{frames[-1].filename}:{frames[-1].lineno}" if frames else "the harness"
        told = "".join(traceback.format_exception(fault))
        self.faults.setdefault(f"{type(fault).__name__} at {place}", {"input": targets.shown(data), "traceback": told})

    def write(self) -> None:
        """Write the record; the file appears whole."""
        record = {
            "engine": self.engine,
            "target": self.target,
            "tried": self.tried,
            "accepted": self.accepted,
            "seconds": round(time.perf_counter() - self.begun, 1),
            "faults": self.faults,
        }
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.folder / f"{self.engine}-{self.target}.json"
        draft = path.with_suffix(".part")
        draft.write_text(json.dumps(record, indent=2), encoding="utf-8")
        draft.replace(path)
