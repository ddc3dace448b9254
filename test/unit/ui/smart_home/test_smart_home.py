"""The headless robot in a smart home with a real broker: told, commanded, and found again."""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fixtures.households.written_robot import WrittenRobot
from fixtures.mosquitto import HomeSide, Mosquitto
from fixtures.waiting import unchanged, wait_until

from roomba.commands.play.living import live_client
from roomba.errors import RoombaError
from roomba.files.valetudo.reading import parse
from roomba.headless.live.client import LiveClient
from roomba.ui.smart_home.switch import switched_on

BASE = "roomba/roomba"
SPEED = 20.0


@pytest.fixture(scope="module")
def broker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mosquitto]:
    made = Mosquitto(tmp_path_factory.mktemp("broker"))
    made.start()
    yield made
    made.kill()


@pytest.fixture
def home(broker: Mosquitto) -> Iterator[HomeSide]:
    side = HomeSide(broker)
    yield side
    side.end()


@pytest.fixture
def robot() -> Iterator[LiveClient]:
    live = live_client("studio", 0, SPEED, knows_map=True)
    live.start()
    yield live
    live.end()


def settings(folder: Path, broker: Mosquitto, more: str = "") -> Path:
    file = folder / "smart_home.yaml"
    file.write_text(
        f"mqtt: {{host: 127.0.0.1, port: {broker.port}, state_period: 0.2, map_period: 1.0{more}}}"
    )
    return file


def state(home: HomeSide) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(home.text(f"{BASE}/state") or "{}")
    return found


def test_commands_make_it_clean_pause_and_dock(
    tmp_path: Path, broker: Mosquitto, home: HomeSide, robot: LiveClient
) -> None:
    smart_home = switched_on(robot, settings(tmp_path, broker), print)
    smart_home.start()

    def reaches(wanted: str) -> None:
        wait_until(lambda: state(home).get("state") == wanted, 20.0, lambda: f"{state(home)}")
        assert robot.robot().vacuum.state == wanted

    reaches("docked")
    assert home.text(f"{BASE}/available") == "online"
    home.say(f"{BASE}/command", "start")
    reaches("cleaning")
    wait_until(lambda: (state(home).get("area") or 0.0) > 0.1, 20.0)
    home.say(f"{BASE}/command", "pause")
    reaches("paused")
    home.say(f"{BASE}/command", "start")
    reaches("cleaning")
    home.say(f"{BASE}/command", "return_to_base")
    reaches("docked")
    home.say(f"{BASE}/send_command", '{"command": "clean", "mode": "rooms", "rooms": ["cellar"]}')
    wait_until(lambda: "cellar" in json.loads(home.text(f"{BASE}/answer"))["message"], 10.0)
    map_data = parse(zlib.decompress(home.newest[f"{BASE}/map_data"]).decode())
    names = json.loads(home.text(f"{BASE}/attributes"))["rooms"]
    assert [name for name, _ in map_data.rooms] == names
    assert home.newest[f"{BASE}/map"].startswith(b"\x89PNG")
    smart_home.stop()
    wait_until(lambda: home.text(f"{BASE}/available") == "offline", 10.0)


def test_a_home_assistant_that_starts_anew_is_told_all_again(
    tmp_path: Path, broker: Mosquitto, home: HomeSide
) -> None:
    smart_home = switched_on(WrittenRobot(), settings(tmp_path, broker), print)
    smart_home.start()
    wait_until(lambda: home.text(f"{BASE}/map"), 10.0)
    wait_until(lambda: unchanged(lambda: sum(home.count.values()), 0.3), 10.0, "all is told")
    told = {topic for topic in home.newest if topic.startswith(("homeassistant/", BASE))}
    home.forget()
    home.say("homeassistant/status", "offline")
    assert unchanged(lambda: home.newest.keys() - {"homeassistant/status"}, 0.3)
    home.say("homeassistant/status", "online")
    wait_until(lambda: told <= home.newest.keys() | {f"{BASE}/answer"}, 10.0)
    assert len([topic for topic in told if topic.endswith("/config")]) == 14
    smart_home.stop()


def test_a_robot_that_is_silent_is_told_and_the_program_that_was_killed_too(
    tmp_path: Path, broker: Mosquitto, home: HomeSide
) -> None:
    robot = WrittenRobot()
    smart_home = switched_on(robot, settings(tmp_path, broker), print)
    smart_home.start()
    wait_until(lambda: home.text(f"{BASE}/available") == "online", 10.0)
    robot.is_gone = True
    wait_until(lambda: home.text(f"{BASE}/available") == "offline", 10.0)
    robot.is_gone = False
    wait_until(lambda: home.text(f"{BASE}/available") == "online", 10.0)
    smart_home.stop()


def test_a_robot_that_answers_nonsense_is_asked_again(
    tmp_path: Path, broker: Mosquitto, home: HomeSide
) -> None:
    told: list[str] = []
    robot = WrittenRobot()
    good, robot.view = robot.view, None  # type: ignore[assignment]
    smart_home = switched_on(robot, settings(tmp_path, broker), told.append)
    smart_home.start()
    wait_until(lambda: any("a look failed" in text for text in told), 10.0)
    robot.view = good
    wait_until(lambda: state(home), 10.0)
    assert len([text for text in told if "a look failed" in text]) == 1
    smart_home.stop()


def test_a_file_that_asks_for_nothing_is_refused(tmp_path: Path) -> None:
    (tmp_path / "empty.yaml").write_text("{}")
    with pytest.raises(RoombaError, match="expected mqtt or webhook"):
        switched_on(WrittenRobot(), tmp_path / "empty.yaml", print)
