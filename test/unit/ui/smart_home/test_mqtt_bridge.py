"""What the bridge publishes about a robot, and how often; the test makes the bridge look."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.households.written_robot import HOME, VIEW, WrittenRobot
from fixtures.mosquitto import HomeSide, Mosquitto
from fixtures.waiting import unchanged, wait_until

from roomba.client.view import GridLayer, LayerName
from roomba.ui.smart_home.mqtt_bridge import MqttBridge
from roomba.ui.smart_home.settings import MqttConfig

BASE = "roomba/roomba"


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Mosquitto]:
    """One of each test's own: a broker hands on what it holds from before."""
    made = Mosquitto(tmp_path)
    made.start()
    yield made
    made.kill()


@pytest.fixture
def home(broker: Mosquitto) -> Iterator[HomeSide]:
    side = HomeSide(broker)
    yield side
    side.end()


@pytest.fixture
def robot() -> WrittenRobot:
    return WrittenRobot()


@pytest.fixture
def bridge(broker: Mosquitto, robot: WrittenRobot) -> Iterator[MqttBridge]:
    config = MqttConfig(host="127.0.0.1", port=broker.port, state_period=60.0, map_period=600.0)
    made = MqttBridge(robot, config, threading.Event(), print)
    made.start()
    yield made
    made.stop()


def test_it_announces_itself_and_tells_what_is_seen(bridge: MqttBridge, home: HomeSide) -> None:
    bridge.show(VIEW, HOME, is_new_run=False)
    told = {f"{BASE}/{name}" for name in ("available", "state", "attributes", "map", "map_data")}
    wait_until(lambda: told <= home.newest.keys(), 10.0)
    assert home.text(f"{BASE}/available") == "online"
    assert json.loads(home.text(f"{BASE}/state"))["state"] == "cleaning"
    assert any(topic.startswith("homeassistant/") for topic in home.newest)
    bridge.show_gone()
    wait_until(lambda: home.text(f"{BASE}/available") == "offline", 10.0)
    bridge.stop()
    wait_until(lambda: not any(map(_draws, threading.enumerate())), 10.0)


def _draws(thread: threading.Thread) -> bool:
    return thread.name.startswith("smart home map")


def test_state_and_map_are_told_no_more_often_than_is_wanted(
    bridge: MqttBridge, home: HomeSide
) -> None:
    bridge.show(VIEW, HOME, is_new_run=False)
    wait_until(lambda: home.text(f"{BASE}/map"), 10.0)
    wait_until(lambda: unchanged(lambda: sum(home.count.values()), 0.3), 10.0, "all is told")
    home.forget()
    bridge.show(replace(VIEW, pose=(3.0, 2.0, 0.5), dirt=7.0), HOME, is_new_run=False)
    assert unchanged(lambda: dict(home.count), 0.5)
    assert home.count == {}


def test_a_command_is_answered_and_told_at_once_and_not_after_the_map(
    bridge: MqttBridge, home: HomeSide, robot: WrittenRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    goes_on, look = threading.Event(), robot.layer

    def draw_slowly(name: LayerName) -> GridLayer | None:
        assert goes_on.wait(10.0)
        return look(name)

    monkeypatch.setattr(robot, "layer", draw_slowly)
    bridge.show(VIEW, HOME, is_new_run=False)
    wait_until(lambda: home.text(f"{BASE}/state"), 10.0)
    assert not bridge.obey()
    home.forget()
    home.say(f"{BASE}/command", "locate")
    wait_until(bridge.obey, 10.0)
    assert [name for name, _ in robot.told] == ["locate"]
    bridge.show(replace(VIEW, dirt=7.0), HOME, is_new_run=False)
    wait_until(lambda: home.text(f"{BASE}/state") and home.text(f"{BASE}/answer"), 10.0)
    assert json.loads(home.text(f"{BASE}/state"))["bin"] == 7.0
    assert not home.text(f"{BASE}/map")
    goes_on.set()
    wait_until(lambda: home.text(f"{BASE}/map"), 10.0)
