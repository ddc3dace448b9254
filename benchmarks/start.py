"""Makes one robot and does its first step: ``python -m benchmarks.start`` is what a start costs.

It loads nothing but the simulator.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from roomba.world.fleet import Fleet
from roomba.world.layer import load_home

_HOMES = Path(__file__).parents[1] / "homes"

if __name__ == "__main__":
    Fleet([load_home("apartment", _HOMES)]).step(np.array([[0.3, 0.0]]), 0.05)
