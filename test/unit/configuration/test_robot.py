import re
from pathlib import Path

import pytest

from roomba.configuration.body import BodyConfig, FanConfig
from roomba.configuration.robot import RobotConfig, load_robot_config
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION
from roomba.vocabulary import FanLevel

SHIPPED = CONFIGURATION / "robot.yaml"


def test_the_shipped_file_says_what_the_library_takes_without_a_file() -> None:
    assert load_robot_config(SHIPPED) == RobotConfig()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("body:\n  diameter: -1\n", "body.diameter: .*equal to 0.01, got -1"),
        ("brush:\n  width: 1.0e-9\n", "brush.width: expected .*0.05, got 1e-09"),
        ("brush:\n  width: 1.0e+12\n", "brush.width: expected .*1, got"),
        ("brush:\n  bin_capacity: 1.0e-9\n", "brush.bin_capacity: expected .*1, got"),
        ("tracking:\n  longest_blend: 1.0e+12\n", "tracking.longest_blend: expected .*1, got"),
        ("timing:\n  world_step: 1.0e-9\n", "timing.world_step: expected .*0.001, got"),
        ("lidar:\n  rate: 1.0e-9\n", "lidar.rate: expected"),
        ("camera:\n  width: 1000000000\n", "camera.width: expected .*8192, got"),
        ("body:\n  wings: 2\n", "body.wings"),
        ("brush:\n  duty: 1.5\n", "brush.duty"),
        ("brush:\n  pickup: 0.5\n", "brush.pickup: unknown; what is true .* under simulation:"),
        ("sensors: ideal\n", "sensors: unknown; what is true .* under simulation:"),
        ("body: [\n", "cannot be read as YAML"),
        ("control:\n  heading_gain: .nan\n", "control.heading_gain"),
        ("control:\n  restart_distance: 0.08\n", r"\(0.08\) of at most .*\(0.03\).*lower"),
        ("control:\n  restart_distance: 0.01\n", r"\(0.01\) of at least .*\(0.02\).*raise"),
        ("timing:\n  tick: 0.06\n", r"whole world steps \(0.025 s\), got 0.06"),
    ],
)
def test_a_broken_file_is_refused_by_name(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=said) as refusal:
        load_robot_config(path)
    assert "robot.yaml" in str(refusal.value)


def test_a_file_of_other_bytes_is_refused_without_the_words_of_a_codec(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_bytes(b"body: \xe0\n")
    with pytest.raises(ConfigError, match="expected UTF-8 text, got other bytes") as refusal:
        load_robot_config(path)
    assert "codec" not in str(refusal.value)


def test_a_robots_file_may_hold_what_only_its_simulator_reads(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("body: {diameter: 0.3}\nsimulation: {sensors: ideal}\n", encoding="utf-8")
    assert load_robot_config(path) == RobotConfig(body=BodyConfig(diameter=0.3))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("body: {command_timeout: 0.2}", "body.command_timeout"),
        ("control: {stream_timeout: 0.3}", "control.stream_timeout"),
        ("body: {max_deceleration: 0.9}", "body.max_deceleration"),
    ],
)
def test_timeouts_with_which_it_would_stand_too_late_are_refused(
    tmp_path: Path, text: str, named: str
) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=re.escape(named)):
        load_robot_config(path)


def test_a_brush_wider_than_the_body_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("brush: {width: 0.5}\n", encoding="utf-8")
    with pytest.raises(ConfigError, match=r"brush\.width of at most body\.diameter .*got 0\.5 m"):
        load_robot_config(path)


def test_silence_braking_and_two_ticks_are_half_a_second() -> None:
    config = RobotConfig()
    assert config.longest_silence + config.body.braking_time + 0.1 == pytest.approx(0.5)
    assert config.body.command_timeout <= config.longest_silence + 1e-9


def test_each_level_of_the_fan_has_its_duty_in_order() -> None:
    fan = RobotConfig().fan
    duties = [fan.duty_at(level) for level in FanLevel]
    assert duties == [fan.quiet, fan.standard, fan.strong]
    assert FanConfig(quiet=0.1).duty_at(FanLevel.QUIET) == 0.1
    with pytest.raises(ValueError, match=r"quiet <= standard <= strong, got 0\.7, 0\.6, 1\.0"):
        FanConfig(quiet=0.7)
