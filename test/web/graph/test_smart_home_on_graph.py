"""The robot of the graph in a smart home: told and commanded through a real broker."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from fixtures.graph import RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.mosquitto import HomeSide, Mosquitto
from fixtures.waiting import wait_until

BASE = "roomba/roomba"


@pytest.mark.thorough
def test_it_cleans_and_docks_by_mqtt(tmp_path: Path) -> None:
    broker = Mosquitto(tmp_path)
    broker.start()
    side = HomeSide(broker)
    file = tmp_path / "smart_home.yaml"
    file.write_text(f"mqtt: {{host: 127.0.0.1, port: {broker.port}}}", "utf-8")

    def reaches(state: str) -> None:
        wait_until(
            lambda: json.loads(side.text(f"{BASE}/state") or "{}").get("state") == state,
            30.0,
            lambda: f"{state}; it is {side.text(f'{BASE}/state')} {side.text(f'{BASE}/answer')}",
            pause=0.1,
        )

    folder = tmp_path / "robot"
    folder.mkdir()
    with RosGraph(folder) as own:
        home = tiny_home(tmp_path)
        own.launch(f"home:={home}", "speed:=3", "page:=true", "page_port:=0", f"smart_home:={file}")
        reaches("docked")
        side.say(f"{BASE}/command", "start")
        reaches("cleaning")
        side.say(f"{BASE}/command", "pause")
        reaches("paused")
        side.say(f"{BASE}/command", "return_to_base")
        reaches("docked")
    wait_until(lambda: side.text(f"{BASE}/available") == "offline", 10.0)
    side.end()
    broker.kill()
