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


@pytest.mark.parametrize("wrong", ["clearance: 0.5", "way_clearance: 0.001"])
def test_a_way_that_keeps_less_from_walls_than_a_swath_is_refused(
    tmp_path: Path, wrong: str
) -> None:
    path = tmp_path / "mission.yaml"
    path.write_text(f"driving: {{{wrong}}}\n", encoding="utf-8")
    said = (
        r"mission\.yaml: driving: expected a way_clearance of at least half of clearance \(.* m\)"
    )
    with pytest.raises(ConfigError, match=said):
        load_mission_config(path, BODY)
    path.write_text("driving: {clearance: 0.08, way_clearance: 0.04}\n", encoding="utf-8")
    load_mission_config(path, BODY)


@pytest.mark.parametrize(
    ("part", "number", "value"),
    [
        ("coverage", "piece", "1.0e-9"),
        ("driving", "way_clearance", "1.0e+12"),
        ("driving", "progress_timeout", "1.0e+12"),
        ("driving", "progress_timeout", "0.01"),
        ("driving", "look_ahead", "10.0"),
        ("exploring", "stand_first", "1.0e+12"),
        ("bin", "full", "1.0e-9"),
        ("cleaning", "most_rounds", "1000000000"),
    ],
)
def test_a_number_that_no_robot_can_have_is_refused(
    tmp_path: Path, part: str, number: str, value: str
) -> None:
    path = tmp_path / "mission.yaml"
    path.write_text(f"{part}: {{{number}: {value}}}\n", encoding="utf-8")
    with pytest.raises(ConfigError, match=rf"mission\.yaml: {part}\.{number}: expected .* equal"):
        load_mission_config(path, BODY)


def test_for_a_slower_robot_it_is_slowed() -> None:
    slow = BODY.model_copy(update={"max_speed": 0.2})
    slowed = MissionConfig().slowed_for(slow)
    slowed.require_possible(slow)
    assert (slowed.driving.speed, slowed.exploring.speed) == (0.2, 0.2)
    assert MissionConfig().slowed_for(BODY) == MissionConfig()
