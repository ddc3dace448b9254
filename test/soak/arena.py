"""What a part of the soak is given."""

from __future__ import annotations

import random
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Arena:
    """A folder of its own, s of wall time that it may take, random numbers, and how many starts."""

    folder: Path
    seconds: float
    random: random.Random
    starts: int
