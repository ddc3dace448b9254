"""Lidars as sold: each file is complete, names the sources of its numbers, and can be chosen."""

from __future__ import annotations

from pathlib import Path

import pytest

from roomba.configuration.frozen import load_config
from roomba.configuration.robot import load_robot_config
from roomba.configuration.sensors import EXACT_LIDAR, LIDARS, LidarConfig, lidar_file, lidar_models
from roomba.configuration.simulation import (
    SimulatedLidar,
    SimulatedRobotConfig,
    load_simulated_config,
)
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION

SHIPPED = CONFIGURATION / "simulation.yaml"
MOUNTED = {"model", "mount_ahead", "mount_height"}
"""What is the robot's choice, not the lidar's."""


def robot_file(folder: Path, text: str) -> Path:
    path = folder / "robot.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_lidars_named_in_the_documents_are_there() -> None:
    known = {"ideal_12m", "neato", "neato_serial", "lds_01", "lds_02", "rplidar_a1", "ld19"}
    assert set(lidar_models()) >= known | {"urg_04lx", "sick_lms_200"}


@pytest.mark.parametrize("model", lidar_models())
def test_a_file_has_every_number_with_a_reason_and_its_source(model: str) -> None:
    parts = lidar_file(model)
    assert set(parts) == {"lidar", "simulation"}
    assert set(parts["lidar"]) == set(LidarConfig.model_fields) - MOUNTED
    assert set(parts["simulation"]) == set(SimulatedLidar.model_fields)
    text = (LIDARS / f"{model}.yaml").read_text(encoding="utf-8")
    assert "# Sources: " in text
    values = [line for line in text.splitlines() if line.startswith("  ")]
    assert [line for line in values if "  # " not in line] == []


@pytest.mark.parametrize("model", lidar_models())
def test_a_robot_takes_any_of_them_by_name_or_by_its_file(model: str, tmp_path: Path) -> None:
    config = SimulatedRobotConfig().with_lidar(model)
    path = robot_file(tmp_path, f"lidar: {{model: {model}}}\n")
    assert load_simulated_config(path, SHIPPED) == config
    assert load_robot_config(path).lidar == config.lidar
    assert config.lidar.model == model
    assert config.is_swept == (model != EXACT_LIDAR)


def test_the_default_is_one_that_robot_vacuums_have() -> None:
    assert SimulatedRobotConfig().with_lidar("lds_02") == SimulatedRobotConfig()


def test_single_numbers_replace_those_of_the_model(tmp_path: Path) -> None:
    text = "lidar: {model: neato, max_range: 5.0}\nsimulation: {lidar: {dark: 0.0}}\n"
    config = load_simulated_config(robot_file(tmp_path, text), SHIPPED)
    neato = SimulatedRobotConfig().with_lidar("neato")
    assert config.lidar == neato.lidar.model_copy(update={"max_range": 5.0})
    errors = neato.simulation.lidar.model_copy(update={"dark": 0.0})
    assert config.simulation.lidar == errors


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("lidar: {model: sonar}\n", "lidar.model: expected one of ideal_12m, .* got 'sonar'"),
        ("lidar: {rate: 5.0, sweep_time: 0.3}\n", "sweep_time of at most 1 / rate"),
        ("simulation: {lidar: {delay: 0.3}}\n", "delay of at most 1 / rate"),
    ],
)
def test_what_cannot_be_is_refused(text: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=said):
        load_simulated_config(robot_file(tmp_path, text), SHIPPED)


def test_beams_of_a_fan_lie_on_both_sides_of_ahead() -> None:
    fan = LidarConfig(beams=181, field=180.0)
    last = fan.first_angle + 180 * fan.beam_step
    assert fan.first_angle == pytest.approx(-last) == pytest.approx(-1.5707963)
    around = LidarConfig(beams=360)
    assert (around.first_angle, around.beam_step) == (0.0, pytest.approx(0.0174533, abs=1e-6))
    assert LidarConfig(beams=250, rate=4.0, sweep_time=0.25).time_increment == pytest.approx(1e-3)
    assert load_config(LidarConfig, Path("/dev/null")) == LidarConfig()
