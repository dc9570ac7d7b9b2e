"""Where the time of a run goes."""

import time
from dataclasses import dataclass, field


@dataclass
class Clock:
    """Seconds that each stage took.

    Attributes
    ----------
    stages : dict of str to float
        Stage -> seconds.
    last : float
        When the last stage ended.
    """

    stages: dict[str, float] = field(default_factory=dict)
    last: float = field(default_factory=time.perf_counter)

    def __call__(self, stage: str) -> None:
        """End a stage and count the seconds since the last one ended.

        Parameters
        ----------
        stage : str
        """
        now = time.perf_counter()
        self.stages[stage] = self.stages.get(stage, 0.0) + now - self.last
        self.last = now
