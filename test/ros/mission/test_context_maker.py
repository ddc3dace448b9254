"""Planning contexts use what is known then; only the last wanted one is made; without a graph."""

from __future__ import annotations

import os
import threading
from dataclasses import replace
from typing import Any

import pytest
import shapely
from fixtures.robots.missions import HOME, TWO_ROOMS

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import RoombaError
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba_ros.mission.context_maker import ContextInputs, ContextMaker
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.runtime.background import Background
from roomba_ros.runtime.timing.heart import Heart

MAT = Zones((Zone("mat", ZoneKind.NO_GO, ((1.0, 1.8), (1.4, 1.8), (1.4, 2.2))),))
INPUTS = ContextInputs(HOME.map, "whole", HOME.station, None, Zones(), "")


class Making:
    """A maker whose background works when it is told to, and a clock."""

    def __init__(self) -> None:
        self.inputs: ContextInputs | None = INPUTS
        self.now, self.lock, self.background = 0.0, threading.Lock(), Background()
        self.maker = ContextMaker(
            RobotConfig(), MissionConfig(), DockingConfig(), self.background, self.lock, self.known
        )

    def known(self) -> ContextInputs | None:
        assert self.lock.locked()
        return self.inputs

    def want(self, *, is_edited: bool = True, wait: float = 0.0) -> None:
        with self.lock:
            self.maker.make(is_edited=is_edited, wait=wait)

    def made(self) -> KnownHome | None:
        """Return what the background made."""
        self.background.work_off()
        return self.maker.take()


@pytest.fixture
def making(monkeypatch: pytest.MonkeyPatch) -> Making:
    making = Making()
    monkeypatch.setattr("time.monotonic", lambda: making.now)
    for level in ("logdebug", "logwarn"):
        monkeypatch.setattr(f"rospy.{level}", lambda *_: None)
    return making


def test_what_is_made_is_of_what_was_known_and_taken_once(making: Making) -> None:
    assert not making.maker.has_begun
    making.want()
    assert making.maker.has_begun
    assert making.maker.take() is None
    home = making.made()
    assert home is not None
    assert home.context.occupancy is HOME.map
    assert (home.context.station, home.context.zones, home.digest) == (
        HOME.station,
        Zones(),
        "whole",
    )
    assert not home.context.is_growing
    assert making.maker.take() is None


def test_a_plan_gives_signs_of_life(making: Making, monkeypatch: pytest.MonkeyPatch) -> None:
    """Over a large home it takes longer than a loop may hang."""
    heart = Heart()
    monkeypatch.setattr("roomba_ros.mission.context_maker.HEART", heart)
    making.want()
    home = making.made()
    assert home is not None
    reading, writing = os.pipe()
    heart.use(writing)
    heart.begin()
    making.now = 1.0
    context = home.context
    context.plan_coverage((1.0, 0.6), context.coverable(), [], edges_only=False)
    os.close(writing)
    with os.fdopen(reading, "rb") as signs:
        assert signs.read()


def test_of_many_that_are_wanted_the_last_is_made(making: Making) -> None:
    making.want()
    making.inputs = replace(INPUTS, zones=MAT)
    making.want()
    home = making.made()
    assert home is not None
    assert home.context.zones == MAT


def test_what_was_overtaken_while_it_was_made_is_not_told(
    making: Making, monkeypatch: pytest.MonkeyPatch
) -> None:
    def overtaken(*_: Any, **__: Any) -> PlanningContext:
        making.want(wait=1.0)
        raise RoombaError("no floor is left")

    monkeypatch.setattr("roomba_ros.mission.context_maker.PlanningContext", overtaken)
    making.want()
    assert making.made() is None
    assert making.maker.trouble == ""
    assert making.maker.is_changing


def test_it_waits_until_no_other_edit_came_for_a_while(making: Making) -> None:
    making.want(wait=0.5)
    making.now = 0.4
    making.want(wait=0.5)
    for making.now in (0.6, 0.9):
        with making.lock:
            making.maker.tick()
        assert making.made() is None
    making.now = 0.91
    with making.lock:
        making.maker.tick()
    assert making.made() is not None


def test_an_edit_changes_the_home_until_it_is_taken_and_more_map_does_not(making: Making) -> None:
    making.want(is_edited=False)
    assert not making.maker.is_changing
    making.want()
    assert making.maker.is_changing
    making.want(is_edited=False)
    assert making.maker.is_changing, "the edit is not made yet"
    making.background.work_off()
    assert making.maker.is_changing
    making.maker.take()
    assert not making.maker.is_changing
    making.want(is_edited=False)
    assert not making.maker.is_changing


def test_while_too_little_is_known_there_is_none_and_no_trouble(making: Making) -> None:
    making.inputs = None
    making.want()
    assert making.made() is None
    assert making.maker.trouble == ""
    assert not making.maker.is_changing


def test_why_there_is_none_is_said_until_there_is_one(making: Making) -> None:
    making.inputs = replace(INPUTS, zones=None, unreadable="zones.yaml: spoiled")
    making.want()
    assert making.made() is None
    assert making.maker.trouble == "nothing can be cleaned in this map: zones.yaml: spoiled"
    making.inputs = INPUTS
    making.want()
    assert making.made() is not None
    assert making.maker.trouble == ""


def test_a_map_too_large_is_refused(making: Making, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("roomba_ros.mission.context_maker.MOST_FINE_CELLS", 1000)
    making.want()
    assert making.made() is None
    assert "expected a map of" in making.maker.trouble


def test_a_growing_map_is_known_as_one(making: Making) -> None:
    making.inputs = replace(INPUTS, digest=GROWING)
    making.want()
    home = making.made()
    assert home is not None
    assert home.context.is_growing
    assert home.digest == GROWING


def test_the_field_of_a_map_is_made_once(making: Making) -> None:
    fields = []
    for zones, occupancy in ((Zones(), HOME.map), (MAT, HOME.map), (Zones(), TWO_ROOMS.map)):
        station = HOME.station if occupancy is HOME.map else TWO_ROOMS.station
        making.inputs = replace(INPUTS, occupancy=occupancy, zones=zones, station=station)
        making.want()
        home = making.made()
        assert home is not None
        fields.append(home.field)
    assert fields[0] is fields[1]
    assert fields[2] is not fields[0]


def test_rooms_that_make_no_sense_leave_it_without(making: Making) -> None:
    for outlines, has_rooms in (
        ((("den", shapely.box(0.0, 0.0, 3.0, 2.5)),), True),
        ((("den", shapely.box(50.0, 0.0, 53.0, 2.5)),), False),
    ):
        making.inputs = replace(INPUTS, outlines=outlines)
        making.want()
        home = making.made()
        assert home is not None
        assert (home.context.rooms is not None) == has_rooms
