"""Saved maps and offered changes on the page, over the whole running graph."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
import rospy
from fixtures.graph import START_DEADLINE, RosGraph
from fixtures.probe import Probe
from fixtures.waiting import wait_until
from geometry_msgs.msg import Point
from roomba_robot.msg import MapChange, MapUpdate
from web.graph.test_page_on_graph import WORKS_WITHIN, open_page

from roomba.files.shipped import HOMES
from roomba.storage.map_store import MapStore, StoredMap
from roomba.world.layers.layer import load_home


def store_of(folder: Path) -> MapStore:
    return MapStore(folder / "ros_home" / "roomba_robot" / "maps")


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[RosGraph]:
    """A robot in the studio that goes by one of its two saved maps."""
    home = load_home("studio", HOMES)
    for name in ("attic", "cellar"):
        store_of(tmp_path).save(name, StoredMap(home.map, home.station))
    with RosGraph(tmp_path) as own:
        own.launch("home:=studio", "map:=attic", "page:=true", "page_port:=0")
        wait_until(lambda: "The page: " in own.programs[-1].output, START_DEADLINE, "the page")
        yield own


@pytest.mark.thorough
def test_maps_are_chosen_removed_and_saved(graph: RosGraph, tmp_path: Path) -> None:
    with open_page(graph) as page:
        page.set_default_timeout(WORKS_WITHIN)
        page.locator("#maps summary").click()
        page.get_by_text("attic (in use)").wait_for()
        names = page.locator("#map-list .name")
        assert names.all_inner_texts() == ["attic (in use)", "cellar"]
        page.get_by_role("button", name="Use cellar").click()
        page.get_by_text("cellar (in use)").wait_for()
        page.get_by_role("button", name="Remove the map attic").click()
        page.get_by_role("button", name="OK").click()
        wait_until(lambda: store_of(tmp_path).names() == ("cellar",), 20.0, "one map")
        page.get_by_role("button", name="Save the map as").click()
        page.get_by_role("textbox", name="Name").fill("given")
        page.get_by_role("button", name="OK").click()
        page.wait_for_selector("#ask-fault:not([hidden])")
        assert "given" in page.inner_text("#ask-fault")
        assert page.get_by_role("textbox", name="Name").input_value() == "given"
        page.get_by_role("button", name="Cancel").click()
        Probe(graph, "offers_a_change")
        publisher = rospy.Publisher("map/update", MapUpdate, queue_size=1, latch=True)
        change = MapChange(True, Point(1.0, 1.0, 0.0), 0.5, 0.4, 0.2)
        publisher.publish(MapUpdate(changes=[change]))
        page.wait_for_selector("#map-offer:not([hidden])")
        assert "(1 new)" in page.inner_text("#map-offer-text")
        page.get_by_role("button", name="Leave it").click()
        page.get_by_text("expected an offer").wait_for()


def test_a_desktop_sees_the_page_by_itself_once(tmp_path: Path) -> None:
    """Also when its node was killed and is back."""
    browser, asked = tmp_path / "browser", tmp_path / "asked"
    browser.write_text(f'#!/bin/sh\necho "$1" >>{asked}\n', encoding="utf-8")
    browser.chmod(0o755)
    with RosGraph(tmp_path) as own:
        own.environment |= {"DISPLAY": ":99", "BROWSER": str(browser)}
        run = own.launch("home:=studio", "page:=true", "page_port:=0")
        wait_until(asked.exists, START_DEADLINE, "the browser")
        assert asked.read_text(encoding="utf-8").strip() in run.output
        own.signal("dashboard_node", signal.SIGKILL)
        wait_until(lambda: run.output.count("The page: ") == 2, START_DEADLINE, "it is back")
        run.send_to_leader(signal.SIGINT)
        run.ends(10.0)
        assert len(asked.read_text(encoding="utf-8").splitlines()) == 1
