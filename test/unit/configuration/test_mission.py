from pathlib import Path

import pytest

from roomba.configuration.body import BodyConfig
from roomba.configuration.mission import MissionConfig, load_mission_config
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION

BODY = BodyConfig()
SHIPPED = CONFIGURATION / "mission.yaml"


def test_the_shipped_file_says_what_the_library_takes_without_a_file() -> None:
    assert load_mission_config(SHIPPED, BODY) == MissionConfig()


def test_a_broken_file_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "mission.yaml"
    path.write_text("driving: {speed: -0.3}\n", encoding="utf-8")
    with pytest.raises(ConfigError, match=r"mission\.yaml: driving\.speed"):
        load_mission_config(path, BODY)


@pytest.mark.parametrize("part", ["driving", "exploring"])
def test_a_speed_that_the_body_cannot_do_is_refused(tmp_path: Path, part: str) -> None:
    path = tmp_path / "mission.yaml"
    path.write_text(f"{part}: {{speed: 0.55}}\n", encoding="utf-8")
    said = rf"mission\.yaml: {part}\.speed: expected at most 0\.5 m/s.*got 0\.55"
    with pytest.raises(ConfigError, match=said):
        load_mission_config(path, BODY)
    faster = BODY.model_copy(update={"max_speed": 0.55})
    assert getattr(load_mission_config(path, faster), part).speed == 0.55


def test_for_a_slower_robot_it_is_slowed() -> None:
    slow = BODY.model_copy(update={"max_speed": 0.2})
    slowed = MissionConfig().slowed_for(slow)
    slowed.require_possible(slow)
    assert (slowed.driving.speed, slowed.exploring.speed) == (0.2, 0.2)
    assert MissionConfig().slowed_for(BODY) == MissionConfig()
