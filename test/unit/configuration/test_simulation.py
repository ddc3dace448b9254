from pathlib import Path

import pytest

from roomba.configuration.body import BodyConfig
from roomba.configuration.frozen import load_config
from roomba.configuration.simulation import (
    SimulatedLidar,
    SimulatedRobotConfig,
    SimulationConfig,
    load_simulated_config,
)
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION

ROBOT, SHIPPED = CONFIGURATION / "robot.yaml", CONFIGURATION / "simulation.yaml"


def test_the_shipped_files_say_what_the_library_takes_without_a_file() -> None:
    assert load_config(SimulationConfig, SHIPPED) == SimulationConfig()
    assert load_simulated_config(ROBOT, SHIPPED) == SimulatedRobotConfig()


def test_sensors_have_noise_unless_told_otherwise() -> None:
    config = SimulatedRobotConfig()
    assert config.simulation.sensors == "noisy"
    assert config.with_sensors("ideal").simulation.sensors == "ideal"
    assert config.with_sensors("ideal").with_sensors("noisy") == config


def test_one_file_holds_what_the_robot_knows_and_what_is_true_of_it(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("body: {diameter: 0.3}\nsimulation: {lidar: {misses: 0.2}}\n", encoding="utf-8")
    assert load_simulated_config(path, SHIPPED) == SimulatedRobotConfig(
        body=BodyConfig(diameter=0.3),
        simulation=SimulationConfig(lidar=SimulatedLidar(misses=0.2)),
    )


def test_what_the_robots_file_leaves_out_is_in_the_simulations_file(tmp_path: Path) -> None:
    robot, simulation = tmp_path / "robot.yaml", tmp_path / "simulation.yaml"
    robot.write_text("body: {diameter: 0.3}\n", encoding="utf-8")
    simulation.write_text("sensors: ideal\n", encoding="utf-8")
    assert load_simulated_config(robot, simulation) == SimulatedRobotConfig(
        body=BodyConfig(diameter=0.3), simulation=SimulationConfig(sensors="ideal")
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("simulation:\n  brush:\n    pickup: 1.5\n", "robot.yaml: simulation.brush.pickup"),
        ("simulation: {lidar: {noise_growth: 0.16}}\n", "lidar.noise_growth: expected .*0.02"),
        ("simulation: {battery: {charge_hours: 1.0e+12}}\n", "battery.charge_hours: expected"),
        ("simulation:\n  wings: 2\n", "robot.yaml: simulation.wings"),
        ("simulation: 3\n", "robot.yaml: simulation"),
        ("- 3\n", "robot.yaml: "),
        ("brush:\n  pickup: 0.5\n", "brush.pickup: unknown; what is true .* under simulation:"),
    ],
)
def test_a_broken_file_is_refused_by_name(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=said):
        load_simulated_config(path, SHIPPED)
