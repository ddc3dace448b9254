"""Makes one robot and does its first step: ``python -m roomba_bench.start`` is what a start costs.

The module loads only the simulator.
"""

from __future__ import annotations

import numpy as np

from roomba.configuration.sensors import EXACT_LIDAR
from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.world.fleet import Fleet
from roomba.world.layers.layer import load_home

if __name__ == "__main__":
    robot = SimulatedRobotConfig().with_lidar(EXACT_LIDAR)
    Fleet([load_home("apartment", HOMES)], robot).step(np.array([[0.3, 0.0]]), 0.05)
