"""The station of the graph empties the robot's bin as the household wants it, by the page's API."""

from __future__ import annotations

import json
import math
import urllib.request
from pathlib import Path
from typing import Any

import pytest
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.homes.tiny_home import tiny_home
from fixtures.waiting import wait_until
from web.graph.test_page_on_graph import address

EAST = {"mode": "zones", "zones": [[0.9, 0.0, 1.5, 1.4]]}
"""The half of the near room in which crumbs lie: a run of about a minute."""
ALWAYS = [{"begins": "00:00", "ends": "12:00"}, {"begins": "12:00", "ends": "00:00"}]
"""Quiet hours of all day."""
AS_LONG = 15.0
"""s of the robot's clock: several looks of the household, and longer than the bin is emptied."""


class Api:
    """The page of a graph, as a program asks it."""

    def __init__(self, graph: RosGraph) -> None:
        page, token = address(graph).split("#token=")
        self._base, self._token = f"{page}api/v1/", token

    def ask(self, method: str, path: str, **body: object) -> Any:
        headers = {"Authorization": f"Bearer {self._token}", "Content-Type": "application/json"}
        content = None if method == "GET" else json.dumps(body).encode()
        asked = urllib.request.Request(self._base + path, content, headers, method=method)
        with urllib.request.urlopen(asked, timeout=20.0) as answer:
            return json.load(answer)

    @property
    def state(self) -> Any:
        return self.ask("GET", "state")

    @property
    def phase(self) -> str:
        return str(self.state["vacuum"]["phase"])

    @property
    def bag(self) -> float:
        told = self.ask("GET", "upkeep")["bag"]
        return math.nan if told is None else float(told)

    def reaches(self, phase: str) -> None:
        wait_until(
            lambda: self.phase == phase, 100.0, lambda: f"{phase}, not {self.phase}", pause=0.1
        )

    def keeps_its_dirt(self) -> None:
        """Wait for so long that it would have been emptied, if that were wanted."""
        before = self.state
        wait_until(lambda: self.state["time"] > before["time"] + AS_LONG, 60.0, pause=0.2)
        assert self.phase == "docked"
        assert self.state["dirt"] == before["dirt"] > 1.0

    def is_emptied(self) -> None:
        wait_until(lambda: self.state["dirt"] == 0.0, 60.0, "the bin is empty", pause=0.1)
        self.reaches("docked")


@pytest.mark.thorough
def test_it_is_emptied_as_the_household_wants_it(tmp_path: Path) -> None:
    folder = tmp_path / "robot"
    folder.mkdir()
    with RosGraph(folder) as own:
        own.environment["ROOMBA_HOUSEHOLD"] = str(tmp_path / "household")
        home = tiny_home(tmp_path)
        own.launch(f"home:={home}", "speed:=5", "empties:=true", "page:=true", "page_port:=0")
        wait_until(lambda: "The page: " in own.programs[-1].output, START_DEADLINE, "the page")
        api = Api(own)
        api.reaches("docked")
        wait_until(lambda: api.bag == 0.0, 20.0, "an empty bag", pause=0.1)
        api.ask("POST", "clean", **EAST)
        api.reaches("cleaning")
        # By level, as it is set at first: some grams are left in the bin.
        api.reaches("docked")
        api.keeps_its_dirt()
        api.ask("PUT", "household/quiet", quiet=ALWAYS)
        api.ask("PUT", "household/emptying", when="after each run")
        api.keeps_its_dirt()
        api.ask("PUT", "household/quiet", quiet=[])
        api.is_emptied()
        wait_until(lambda: 0.0 < api.bag < 0.01, 20.0, lambda: f"{api.bag} of a bag", pause=0.1)
        api.ask("POST", "replace_bag")
        wait_until(lambda: api.bag == 0.0, 20.0, "an empty bag", pause=0.1)
