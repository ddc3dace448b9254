"""The entities announced to Home Assistant agree with the robot's commands and messages."""

from __future__ import annotations

import json
import re
from pathlib import Path

from fixtures.households.written_robot import HOME, VIEW, WrittenRobot

from roomba.ui.smart_home.announcement import announcements
from roomba.ui.smart_home.commands import SmartCommands
from roomba.ui.smart_home.told_state import StateTeller, attributes_of
from roomba.ui.smart_home.topics import MqttTopics

PAGE = Path(__file__).parents[4] / "docs" / "smart_home.md"
TOPICS = MqttTopics("roomba/robbie", "homeassistant")
TOLD = announcements(TOPICS, "robbie", "Robbie")


def test_each_entity_is_announced_once_and_belongs_to_one_device() -> None:
    assert len(TOLD) == 14
    assert len({entity["unique_id"] for entity in TOLD.values()}) == len(TOLD)
    assert len({json.dumps(entity["device"]) for entity in TOLD.values()}) == 1
    for topic, entity in TOLD.items():
        discovery, component, name, config = topic.split("/")
        assert (discovery, config) == ("homeassistant", "config")
        assert entity["default_entity_id"] == f"{component}.{name}"
        assert entity["availability_topic"] == "roomba/robbie/available"
    assert "homeassistant/camera/robbie_map_data/config" in TOLD


def test_what_the_vacuum_offers_is_obeyed() -> None:
    vacuum = TOLD["homeassistant/vacuum/robbie/config"]
    commands = SmartCommands(WrittenRobot())
    payloads = {value for key, value in vacuum.items() if key.startswith("payload_")}
    payloads -= {"online", "offline"}
    assert payloads == {"start", "pause", "stop", "return_to_base", "clean_spot", "locate"}
    assert all(commands.command(payload)["ok"] for payload in payloads)
    assert all(commands.set_fan(level)["ok"] for level in vacuum["fan_speed_list"])
    assert commands.send(TOLD["homeassistant/button/robbie_empty_bin/config"]["payload_press"])[
        "ok"
    ]


def test_what_sensors_show_is_told() -> None:
    state = StateTeller().state_of(VIEW, "standard")
    shown = {
        key
        for entity in TOLD.values()
        if entity.get("state_topic") == TOPICS.state
        for key in re.findall(r"value_json\.(\w+)", entity.get("value_template", ""))
    }
    assert shown == state.keys() - {"state", "fan_speed"}


def test_the_page_names_all_topics_commands_and_keys() -> None:
    page = PAGE.read_text(encoding="utf-8")
    rows = {
        cells[0].strip("` "): cells[1].strip()
        for line in page.splitlines()
        if line.startswith("| `")
        for cells in [line.strip("|").split("|")]
    }
    base = f"{TOPICS.base}/"
    topics = {
        value.removeprefix(base): value
        for name in dir(MqttTopics)
        if isinstance(getattr(MqttTopics, name), property)
        and isinstance(value := getattr(TOPICS, name), str)
        and value.startswith(base)
    }
    assert topics.keys() <= rows.keys()
    for topic in TOPICS.heard[:3]:
        assert rows[topic.removeprefix(base)] == "to the robot"
    for topic in topics.keys() - {topic.removeprefix(base) for topic in TOPICS.heard}:
        assert rows[topic] == "from the robot"
    told = set(re.findall(r"`([^`]+)`", page))
    assert set(SmartCommands(WrittenRobot()).names) <= told
    assert StateTeller().state_of(VIEW, "standard").keys() <= told
    assert attributes_of(HOME).keys() <= told
