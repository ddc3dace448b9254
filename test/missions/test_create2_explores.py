"""The brain in a Create 2 with an LD19, both made up: it maps a home, and docks, in real time."""

from __future__ import annotations

import faulthandler
from pathlib import Path

from fixtures.robots.create2_rig import Create2Rig
from fixtures.waiting import wait_until

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import load_robot_config
from roomba.files.shipped import CONFIGURATION
from roomba.robot.brain import Brain
from roomba.vocabulary import Phase

TICK = 0.05
LONGEST = 400.0
"""s of wall time."""


def test_it_explores_the_studio_and_docks_by_the_beams_of_its_station(tmp_path: Path) -> None:
    # That it takes long is no reason to tell what each thread does.
    faulthandler.cancel_dump_traceback_later()
    rig = Create2Rig(tmp_path)
    config = load_robot_config(CONFIGURATION / "robots" / "create2.yaml")
    mission = MissionConfig().slowed_for(config.body)
    station = rig.simulator.home.station
    brain = Brain(MappingConfig(), station, config, mission, DockingConfig())

    def ticked() -> bool:
        rig.body.act(brain.tick(rig.body.read()))
        return brain.is_ready

    def explored() -> bool:
        return ticked() and brain.mission.state.phase is Phase.DOCKED

    try:
        wait_until(ticked, 20.0, "the first scan", pause=TICK)
        brain.mission.explore(brain.senses())
        wait_until(lambda: not explored(), 20.0, "it leaves its station", pause=TICK)
        wait_until(explored, LONGEST, lambda: str(brain.mission.state), pause=TICK)
        assert rig.simulator.observe().battery.is_docked
        here, true = brain.pose, rig.simulator.pose
        assert here.distance_to(true.x, true.y) < 0.06
        assert brain.mapper is not None
        made, whole = brain.mapper.occupancy(), rig.simulator.home.map
        free = [
            float((each.values == 0).sum()) * each.frame.resolution**2 for each in (made, whole)
        ]
        assert free[0] > 0.8 * free[1]
    finally:
        rig.end()
