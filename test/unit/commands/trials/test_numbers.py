"""Numbers of the configuration by dotted names, for one trial."""

from __future__ import annotations

import pytest

from roomba.commands.options import UsageError
from roomba.commands.trials.numbers import check_numbers, with_numbers
from roomba.commands.trials.runs import docking_config, mission_config, robot_config_of
from roomba.commands.trials.trial import Trial
from roomba.configuration.mission import MissionConfig
from roomba.errors import ConfigError


def test_they_change_what_they_name_and_nothing_else() -> None:
    changed = with_numbers(MissionConfig(), "mission", [("mission.coverage.turning", 5.0)])
    assert changed.coverage.turning == 5.0
    back = changed.model_copy(
        update={"coverage": changed.coverage.model_copy(update={"turning": 1.0})}
    )
    assert back == MissionConfig()


def test_those_of_another_file_are_left_alone() -> None:
    config = MissionConfig()
    assert with_numbers(config, "mission", [("robot.body.max_speed", 0.2)]) is config


def test_each_file_has_its_own() -> None:
    trial = Trial(
        numbers=(
            ("docking.place_tolerance", 0.031),
            ("mission.coverage.turning", 2.5),
            ("robot.body.max_speed", 0.2),
            ("simulation.condition", "worn"),
        )
    )
    robot = robot_config_of(trial)
    assert robot.body.max_speed == 0.2
    assert robot.simulation.condition == "worn"
    mission = mission_config(robot, trial.numbers)
    assert mission.coverage.turning == 2.5
    assert mission.driving.speed <= 0.2
    assert docking_config(trial.numbers).place_tolerance == 0.031


def test_a_trial_without_any_is_the_shipped_robot() -> None:
    assert mission_config(robot_config_of(Trial())) == MissionConfig()


@pytest.mark.parametrize(
    ("number", "said"),
    [
        (("mission.coverage.turn", 1.0), "coverage.turn: there is no such number"),
        (("mission.coverage.turning", -1.0), "coverage.turning: .*greater than or equal to 0"),
        (("mission.coverage.turning", "fast"), "coverage.turning: .*valid number"),
    ],
)
def test_what_is_no_number_is_refused(number: tuple[str, float | str], said: str) -> None:
    with pytest.raises(ConfigError, match=f"numbers: mission.{said}"):
        with_numbers(MissionConfig(), "mission", [number])


@pytest.mark.parametrize("name", ["coverage.turning", "mission", "mission.", "robot..speed"])
def test_a_name_begins_with_its_file(name: str) -> None:
    with pytest.raises(UsageError, match="expected a name that begins with robot, simulation"):
        check_numbers([(name, 1.0)])
