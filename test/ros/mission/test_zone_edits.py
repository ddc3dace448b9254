"""Zones are kept, published and edited for the present map; without a graph."""

from __future__ import annotations

import sys
import threading
from pathlib import Path
from typing import Any, ClassVar

import pytest
from fixtures.robots.missions import HOME, TWO_ROOMS
from roomba_robot.msg import Zone as ZoneMessage
from roomba_robot.srv import RemoveZoneRequest, SetZoneRequest

from roomba.geometry import Pose
from roomba.perception.floors.carry_over import moved
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones
from roomba.storage.map_bound import map_digest, map_file_name
from roomba.storage.zones import load_zones, save_zones
from roomba_ros.convert.rooms import zones_message
from roomba_ros.mission.known_home import GROWING
from roomba_ros.mission.zone_edits import ZoneEdits

MAT = Zone("mat", ZoneKind.NO_GO, ((1.0, 1.8), (1.4, 1.8), (1.4, 2.2)))
BOWL = Zone("bowl", ZoneKind.NO_GO, ((0.5, 0.5), (0.7, 0.5), (0.7, 0.7)))
WHOLE = map_digest(HOME.map)
RUN = ["run-1"]
"""The run of the robot that the master tells."""


class Published:
    """Keeps the names of the zones that were told."""

    def __init__(self, topic: str, *_: Any, **__: Any) -> None:
        self.topic = topic

    told: ClassVar[list[list[str]]] = []

    def publish(self, message: Any) -> None:
        if self.topic == "zones":
            self.told.append([zone.name for zone in message.zones])


class Editing:
    """Edits of zones over a folder, and how often they were told of."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.edits, self.lock = folder, 0, threading.Lock()
        self.zones = ZoneEdits(folder, self.lock, self.note)
        self.zones.start()

    def note(self) -> None:
        assert self.lock.locked()
        self.edits += 1

    def set_zone(self, zone: Zone) -> tuple[bool, str]:
        [message] = zones_message(0.0, Zones((zone,)), "map").zones
        response = self.zones._on_set(SetZoneRequest(message))
        return response.success, response.message

    def remove(self, name: str) -> tuple[bool, str]:
        response = self.zones._on_remove(RemoveZoneRequest(name))
        return response.success, response.message

    def path(self, digest: str = WHOLE) -> Path:
        return self.folder / f"{map_file_name(digest)}.yaml"

    @property
    def told(self) -> list[list[str]]:
        return Published.told


@pytest.fixture
def editing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Editing:
    monkeypatch.setattr("rospy.Publisher", Published)
    monkeypatch.setattr("rospy.get_time", lambda: 1.0)
    monkeypatch.setattr("rospy.logerr", lambda *_: None)
    monkeypatch.setattr("rospy.get_namespace", lambda: "/upstairs/")
    monkeypatch.setattr("rospy.get_param", lambda *_: RUN[0])
    monkeypatch.setattr(sys.modules[__name__], "RUN", ["run-1"])
    monkeypatch.setattr(Published, "told", [])
    return Editing(tmp_path)


def test_without_a_map_nothing_is_edited(editing: Editing) -> None:
    assert editing.zones.zones is None
    assert editing.set_zone(MAT) == (False, "there is no map yet; is home_sim_node running?")
    assert (editing.told, editing.edits) == ([], 0)


def test_an_edit_is_saved_and_told_at_once(editing: Editing) -> None:
    editing.zones.follow_map(WHOLE)
    assert editing.set_zone(MAT) == (True, "the zones are: mat")
    assert editing.set_zone(BOWL) == (True, "the zones are: mat, bowl")
    assert editing.remove("mat") == (True, "the zones are: bowl")
    assert editing.told == [[], ["mat"], ["mat", "bowl"], ["bowl"]]
    assert editing.edits == 3
    assert load_zones(editing.path(), WHOLE) == Zones((BOWL,))


def test_an_edit_that_makes_no_sense_changes_nothing(editing: Editing) -> None:
    editing.zones.follow_map(WHOLE)
    is_done, why = editing.remove("mat")
    assert not is_done
    assert "mat" in why
    response = editing.zones._on_set(SetZoneRequest(ZoneMessage(name="thin")))
    assert not response.success
    assert (editing.told, editing.edits) == ([[]], 0)


def test_an_edit_that_the_disk_refuses_changes_nothing(
    editing: Editing, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError("No space left on device")

    editing.zones.follow_map(WHOLE)
    monkeypatch.setattr("roomba_ros.mission.zone_edits.save_zones", refuse)
    text = "the zones cannot be saved: No space left on device; nothing was changed"
    assert editing.set_zone(MAT) == (False, text)
    assert (editing.zones.zones, editing.edits) == (Zones(), 0)


def test_each_map_has_its_own_zones(editing: Editing) -> None:
    editing.zones.follow_map(WHOLE)
    editing.set_zone(MAT)
    editing.zones.follow_map(map_digest(TWO_ROOMS.map))
    assert editing.zones.zones == Zones()
    editing.zones.follow_map(WHOLE)
    assert editing.zones.zones == Zones((MAT,))
    assert editing.told == [[], ["mat"], [], ["mat"]]
    assert editing.edits == 1


def test_zones_of_a_growing_map_go_on_in_the_whole_one(editing: Editing) -> None:
    editing.zones.follow_map(GROWING)
    editing.set_zone(MAT)
    editing.zones.follow_map(GROWING)
    assert editing.told == [[], ["mat"]], "more of the same map tells nothing new"
    editing.zones.follow_map(WHOLE)
    assert editing.zones.zones == Zones((MAT,))
    assert load_zones(editing.path(), WHOLE) == Zones((MAT,))


def test_zones_of_a_growing_map_turn_with_it(editing: Editing) -> None:
    turn = Pose(0.5, -0.2, 0.05)
    editing.zones.follow_map(GROWING)
    editing.set_zone(MAT)
    editing.zones.follow_map(WHOLE, turn)
    expected = moved(Zones((MAT,)), turn)
    assert editing.zones.zones == expected
    assert load_zones(editing.path(), WHOLE) == expected


def test_a_node_that_was_killed_finds_the_zones_of_a_map_that_is_being_made(
    editing: Editing,
) -> None:
    editing.zones.follow_map(GROWING)
    editing.set_zone(MAT)
    again = Editing(editing.folder)
    again.zones.follow_map(GROWING)
    assert again.zones.zones == Zones((MAT,))
    # It is killed again, and the map is whole meanwhile.
    later = Editing(editing.folder)
    later.zones.follow_map(WHOLE)
    assert later.zones.zones == Zones((MAT,))
    assert [path.name for path in editing.folder.iterdir()] == [editing.path().name]


@pytest.mark.parametrize("run", ["run-2", ""])
def test_zones_of_a_map_that_never_became_whole_are_forgotten(editing: Editing, run: str) -> None:
    editing.zones.follow_map(GROWING)
    editing.set_zone(MAT)
    editing.set_zone(BOWL)
    RUN[0] = run
    later = Editing(editing.folder)
    later.zones.follow_map(GROWING)
    assert later.zones.zones == Zones()
    assert list(editing.folder.iterdir()) == []


def test_another_map_that_is_begun_has_none_of_the_one_before(editing: Editing) -> None:
    editing.zones.follow_map(GROWING)
    editing.set_zone(MAT)
    editing.zones.follow_map(WHOLE)
    editing.zones.follow_map(GROWING)
    assert editing.zones.zones == Zones()


def test_zones_that_cannot_be_carried_over_are_not_forgotten(
    editing: Editing, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError("No space left on device")

    editing.zones.follow_map(GROWING)
    editing.set_zone(MAT)
    with monkeypatch.context() as full:
        full.setattr("roomba_ros.mission.zone_edits.save_zones", refuse)
        editing.zones.follow_map(WHOLE)
    assert editing.zones.zones == Zones((MAT,))
    again = Editing(editing.folder)
    again.zones.follow_map(WHOLE)
    assert again.zones.zones == Zones((MAT,))
    assert load_zones(editing.path(), WHOLE) == Zones((MAT,))


def test_zones_that_the_whole_map_has_stay(editing: Editing) -> None:
    save_zones(Zones((BOWL,)), WHOLE, editing.path())
    editing.zones.follow_map(GROWING)
    editing.set_zone(MAT)
    editing.zones.follow_map(WHOLE)
    assert editing.zones.zones == Zones((BOWL,))


def test_a_map_that_is_told_again_may_have_taken_zones_over(editing: Editing) -> None:
    editing.zones.follow_map(WHOLE)
    assert not editing.zones.look_again()
    save_zones(Zones((BOWL,)), WHOLE, editing.path())
    assert editing.zones.look_again()
    assert editing.zones.zones == Zones((BOWL,))
    assert editing.told == [[], ["bowl"]]


def test_zones_that_cannot_be_read_are_not_edited(editing: Editing) -> None:
    save_zones(Zones((BOWL,)), map_digest(TWO_ROOMS.map), editing.path())
    editing.zones.follow_map(WHOLE)
    assert editing.zones.zones is None
    assert str(editing.path()) in editing.zones.unreadable
    assert editing.set_zone(MAT) == (False, f"{editing.zones.unreadable}; then restart")
    assert editing.told == [[]]
