"""What a part of the soak is given."""

from __future__ import annotations

import random
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Arena:
    """A folder of its own, its time, s of wall time, random numbers, and a number of starts."""

    folder: Path
    seconds: float
    random: random.Random
    starts: int
