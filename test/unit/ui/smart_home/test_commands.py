"""Commands of a smart home: what the robot is told, and what is refused."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from fixtures.households.written_robot import VIEW, WrittenRobot
from hypothesis import given
from hypothesis import strategies as st

from roomba.clean_request import CleanRequest
from roomba.ui.smart_home.commands import SmartCommands
from roomba.vocabulary import CleanMode, FanLevel


def in_phase(phase: str) -> WrittenRobot:
    robot = WrittenRobot()
    robot.view = replace(VIEW, vacuum=replace(VIEW.vacuum, state=phase, phase=phase))
    return robot


def on_its_way_home(to_go: float) -> WrittenRobot:
    robot = in_phase("returning")
    robot.view = replace(robot.view, vacuum=replace(robot.view.vacuum, seconds_to_go=to_go))
    return robot


@pytest.mark.parametrize(
    ("phase", "told"),
    [
        ("docked", [("clean", (CleanRequest(),))]),
        ("idle", [("clean", (CleanRequest(),))]),
        ("paused", [("resume", ())]),
        ("error", [("resume", ())]),
        ("cleaning", []),
        ("undocking", []),
        ("exploring", []),
        ("charging", []),
        ("bin full", []),
    ],
)
def test_a_start_goes_on_or_cleans_all(phase: str, told: list[Any]) -> None:
    robot = in_phase(phase)
    assert SmartCommands(robot).command("start")["ok"]
    assert robot.told == told


def test_a_start_leaves_a_clean_alone_that_only_charges_and_begins_after_one_that_is_done() -> None:
    charges, done = on_its_way_home(60.0), on_its_way_home(0.0)
    for robot in (charges, done):
        assert SmartCommands(robot).command("start")["ok"]
    assert charges.told == []
    assert done.told == [("clean", (CleanRequest(),))]


@pytest.mark.parametrize(
    ("payload", "told"),
    [
        ("pause", ("pause", ())),
        ("stop", ("stop", ())),
        ("return_to_base", ("dock", ())),
        ("locate", ("locate", ())),
        ("clean_spot", ("clean", (CleanRequest(CleanMode.SPOT),))),
    ],
)
def test_the_commands_of_the_vacuum(payload: str, told: tuple[str, tuple[Any, ...]]) -> None:
    robot = WrittenRobot()
    assert SmartCommands(robot).command(payload) == {
        "command": payload,
        "ok": True,
        "message": "",
    }
    assert robot.told == [told]


def test_rooms_and_zones_by_send_command() -> None:
    robot = WrittenRobot()
    commands = SmartCommands(robot)
    assert commands.set_fan("quiet")["ok"]
    wish = {"command": "clean", "mode": "rooms", "rooms": ["hall"], "passes": 2}
    assert commands.send(json.dumps(wish))["ok"]
    wish = {"command": "clean", "mode": "zones", "zones": [[0, 0, 1, 2.5]], "fan": "strong"}
    assert commands.send(json.dumps(wish))["ok"]
    assert commands.send('{"command": "go_to", "x": 1, "y": -2}')["ok"]
    assert commands.send("empty_bin")["ok"]
    assert commands.send('{"command": "explore"}')["ok"]
    rooms = CleanRequest(CleanMode.ROOMS, ("hall",), passes=2, fan=FanLevel.QUIET, in_order=True)
    zone = (0.0, 0.0, 1.0, 2.5)
    zones = CleanRequest(CleanMode.ZONES, zones=(zone,), fan=FanLevel.STRONG, in_order=True)
    assert robot.told == [
        ("clean", (rooms,)),
        ("clean", (zones,)),
        ("go_to", (1.0, -2.0)),
        ("empty_bin", ()),
        ("explore", ()),
    ]


@pytest.mark.parametrize(
    ("payload", "expected"),
    [
        ("fly", "expected one of start, pause"),
        ("clean", ""),
        ('{"command": "clean", "mode": "rooms", "rooms": "hall"}', "rooms: "),
        ('{"command": "clean", "passes": 99}', "passes: "),
        ('{"command": "clean", "speed": 1}', "speed: "),
        ('{"command": "go_to", "x": 1}', "y: "),
        ('{"command": "go_to", "x": NaN, "y": 1}', "expected one of"),
        ('{"command": "pause", "x": 1}', "expected one of"),
        ('{"command": 7}', "expected one of"),
        ("[" * 100_000, "expected one of"),
        ("{" * 10_000, "expected one of"),
        ("", "expected one of"),
    ],
)
def test_what_cannot_be_done_is_refused_with_a_sentence(payload: str, expected: str) -> None:
    robot = WrittenRobot()
    answer = SmartCommands(robot).send(payload)
    if expected:
        assert not answer["ok"]
        assert answer["message"].startswith(expected)
        assert len(answer["message"]) <= 255
        assert robot.told == []
    else:
        assert robot.told == [("clean", (CleanRequest(in_order=True),))]


def test_a_refusal_of_the_robot_is_the_answer() -> None:
    robot = WrittenRobot()
    robot.refusal = "the battery is at 3%; charge it first" + "!" * 300
    answer = SmartCommands(robot).command("return_to_base")
    assert not answer["ok"]
    assert answer["message"].startswith("the battery is at 3%")
    assert len(answer["message"]) == 255


def test_a_fan_level_that_there_is_not_changes_nothing() -> None:
    commands = SmartCommands(WrittenRobot())
    assert "expected one of quiet, standard, strong" in commands.set_fan("turbo")["message"]
    assert commands.fan is FanLevel.STANDARD


@given(st.text() | st.recursive(st.none() | st.text() | st.floats(), st.lists).map(json.dumps))
def test_any_text_is_answered(payload: str) -> None:
    robot = WrittenRobot()
    commands = SmartCommands(robot)
    for take in (commands.command, commands.set_fan, commands.send):
        assert isinstance(take(payload)["ok"], bool)
