import math
from pathlib import Path

import pytest

from roomba.configuration.robot import (
    RobotConfig,
    SeedParameters,
    load_robot_config,
    parse_seed_parameters,
)
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION

SHIPPED = CONFIGURATION / "robot.yaml"


def test_the_shipped_file_says_what_the_library_takes_without_a_file() -> None:
    assert load_robot_config(SHIPPED) == RobotConfig()


def test_sensors_have_noise_unless_told_otherwise() -> None:
    assert RobotConfig().sensors == "noisy"


def test_every_value_of_the_shipped_file_has_a_reason_beside_it() -> None:
    lines = SHIPPED.read_text(encoding="utf-8").splitlines()
    values = [line for line in lines if line.startswith("  ")]
    assert len(values) > 25
    assert [line for line in values if "#" not in line] == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("body:\n  diameter: -1\n", "body.diameter: .*greater than 0, got -1"),
        ("body:\n  wings: 2\n", "body.wings"),
        ("brush:\n  pickup: 1.5\n", "brush.pickup"),
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


def test_missing_parameters_have_the_reports_values() -> None:
    assert parse_seed_parameters({}) == SeedParameters(
        robot_name="roomba_robot",
        robot_max_speed=0.5,
        initial_post_x=0.0,
        initial_post_y=0.0,
        min_cordinate=-100.0,
        max_cordinate=100.0,
    )


def test_the_reports_other_spellings_mean_the_same() -> None:
    parsed = parse_seed_parameters(
        {"initial_pos_x": 1, "initial_pos_y": 2.5, "min_coordinate": -7, "max_coordinate": 7}
    )
    assert (parsed.initial_post_x, parsed.initial_post_y) == (1.0, 2.5)
    assert (parsed.min_cordinate, parsed.max_cordinate) == (-7.0, 7.0)


def test_where_both_spellings_are_set_the_other_one_was_set_by_somebody() -> None:
    assert parse_seed_parameters({"max_coordinate": 7, "max_cordinate": 9}).max_cordinate == 7.0


@pytest.mark.parametrize(
    "wrong",
    [
        {"robot_max_speed": -0.5},
        {"robot_max_speed": 0},
        {"robot_max_speed": "fast"},
        {"robot_max_speed": math.nan},
        {"robot_max_speed": math.inf},
        {"robot_max_speed": True},
        {"initial_post_x": math.nan},
        {"min_cordinate": 5, "max_cordinate": 5},
        {"min_cordinate": [1]},
        {"robot_name": 3},
        {"robot_name": ""},
    ],
)
def test_a_wrong_parameter_is_refused_in_one_line_that_names_it(wrong: dict[str, object]) -> None:
    with pytest.raises(ConfigError) as refusal:
        parse_seed_parameters(wrong)
    message = str(refusal.value)
    assert "\n" not in message
    assert any(name in message for name in wrong)


def test_limits_hold_for_both_coordinates_and_refuse_what_is_no_number() -> None:
    limits = SeedParameters(min_cordinate=-1.0, max_cordinate=2.0)
    assert limits.allows(-1.0, 2.0)
    assert not limits.allows(-1.01, 0.0)
    assert not limits.allows(0.0, 2.01)
    assert not limits.allows(math.nan, 0.0)
    assert not limits.allows(0.0, -math.inf)
