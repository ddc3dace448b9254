"""The bridge of a graph that has the page's server, and what tests offer it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from fixtures.graph import RosGraph
from fixtures.waiting import wait_until


@dataclass(frozen=True)
class Served:
    """A graph with a bridge, at a port of this machine."""

    graph: RosGraph
    port: int
    token: str

    @property
    def address(self) -> str:
        """Where a program proves itself by the address."""
        return f"ws://127.0.0.1:{self.port}/rosbridge?token={self.token}"


@pytest.fixture(scope="module")
def bridge_graph(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A bare master, and the page's server on it."""
    with RosGraph(tmp_path_factory.mktemp("bridge")) as own:
        own.start_master()
        node = own.rosrun("dashboard_node.py", "_port:=0")
        wait_until(lambda: "The page: " in node.output, 30.0, "the page is served")
        yield own


@pytest.fixture(scope="module")
def served(bridge_graph: RosGraph) -> Served:
    """The bridge of that graph."""
    output = bridge_graph.programs[-1].output
    found = re.search(r"The page: http://127.0.0.1:(\d+)/#token=(\S+)", output)
    assert found
    return Served(bridge_graph, int(found[1]), found[2])
