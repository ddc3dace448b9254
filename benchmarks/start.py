"""Makes one robot and does its first step: ``python -m benchmarks.start`` is what a start costs.

It loads nothing but the simulator.
"""

from __future__ import annotations

import numpy as np

from roomba.files.shipped import HOMES
from roomba.world.fleet import Fleet
from roomba.world.layers.layer import load_home

if __name__ == "__main__":
    Fleet([load_home("apartment", HOMES)]).step(np.array([[0.3, 0.0]]), 0.05)
