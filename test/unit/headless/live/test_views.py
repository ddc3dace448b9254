"""What a page is shown of a robot and its home."""

from __future__ import annotations

import pytest
from fixtures.homes.worlds import NOISY
from fixtures.robots.missions import HOME

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.files.shipped import HOMES
from roomba.headless.body import SimulatedBody
from roomba.headless.embodied import Embodied
from roomba.headless.live.playing import Playing, lift
from roomba.headless.live.views import home_view, robot_view
from roomba.headless.mission import HeadlessMission
from roomba.perception.rooms.zones import Zones
from roomba.robot.brain import Brain
from roomba.world.layers.layer import load_home


@pytest.mark.parametrize("level", [0.5, 1.0])
def test_it_charges_on_its_station_until_it_is_full(level: float) -> None:
    """A real body tells no current."""
    body = SimulatedBody(HOME, NOISY, 0, None, None)
    brain = Brain(HOME.map, HOME.station, NOISY, MissionConfig(), DockingConfig())
    for robot in (Embodied(body, brain, NOISY), HeadlessMission(HOME, NOISY)):
        assert isinstance(robot.body, SimulatedBody)
        robot.body.simulator.set_charge(level)
        robot.tick()
        assert robot_view(robot, None).charges == (level < 1.0)


def test_off_its_station_it_charges_not() -> None:
    robot = HeadlessMission(HOME, NOISY)
    robot.simulator.set_charge(0.5)
    lift(robot.simulator)
    robot.tick()
    assert not robot_view(robot, None).charges


@pytest.mark.parametrize("height", [0.05, 0.3])
def test_overhead_is_what_the_robot_passes_below(height: float) -> None:
    config = NOISY.model_copy(update={"body": NOISY.body.model_copy(update={"height": height})})
    home = load_home("studio", HOMES, config.body)
    robot = HeadlessMission(home, config)
    seen = home_view(1, Playing(home, robot), robot, None, Zones())
    boxes = [box for piece in home.furniture if piece.on_map for box in piece.boxes]
    below = sum(box.bottom >= height for box in boxes)
    assert len(seen.overhead) == below
    assert len(seen.furniture) == len(boxes) - below
