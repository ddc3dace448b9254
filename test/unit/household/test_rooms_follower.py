"""Edits of rooms are followed once each, finished after trouble, and taken back with them."""

from __future__ import annotations

import contextlib
import datetime as dt
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from fixtures.households.written_robot import HOME, WrittenRobot

from roomba.client.protocol import RobotUnavailableError
from roomba.client.view import HomeView, RoomView
from roomba.configuration.frozen import Frozen
from roomba.configuration.household import DueConfig
from roomba.household.dirt_keeper import DirtKeeper
from roomba.household.folder import KeptValues
from roomba.household.plan_changes import Change
from roomba.household.rooms_follower import RoomsFollower
from roomba.household.seen_rooms import SeenRooms
from roomba.plans.due import DirtRecords, RoomRecord
from roomba.plans.plan import HouseholdPlans, Plan, PlannedOrder
from roomba.vocabulary import CleanMode


def room(name: str, x: float) -> RoomView:
    """Return a room of 1 m at x, m."""
    corners = ((x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 0.0))
    return RoomView(name, 1.0, (x + 0.5, 0.2), (corners,))


ROOMS = (room("kitchen", 0.0), room("den", 2.0))
RENAMED = (room("galley", 0.0), room("den", 2.0))
AT = dt.datetime(2026, 3, 2, 8, 0, tzinfo=dt.timezone.utc)


class RoomyRobot(WrittenRobot):
    rooms: tuple[RoomView, ...] = ROOMS

    def home(self) -> HomeView:
        if self.is_gone:
            raise RobotUnavailableError("the robot's program has ended")
        return replace(HOME, rooms=self.rooms)


class Following:
    """A follower, and the plans that it changes."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.robot = folder, RoomyRobot()
        order = PlannedOrder(mode=CleanMode.ROOMS, rooms=("kitchen",))
        self.plans = HouseholdPlans(plans=(Plan(name="one", order=order),))
        self.told: list[str] = []
        self.is_full = False
        self.kept("dirt.json").write(DirtRecords(rooms={"kitchen": RoomRecord(cleaned=AT)}))
        self.again()

    def kept(self, name: str) -> KeptValues:
        return KeptValues(self.folder / name, lambda text: pytest.fail(text))

    def again(self) -> None:
        """Begin as another program."""
        self.follower = RoomsFollower(
            self.robot,
            self.kept("rooms.json"),
            DirtKeeper(self.kept("dirt.json"), DueConfig()),
            lambda: self.plans,
            self.changing,
        )

    @contextlib.contextmanager
    def changing(self, change: Change, why: str) -> Iterator[None]:
        if self.is_full:
            raise OSError("No space left on device")
        self.plans = change(self.plans)
        yield
        self.told.append(why)

    def look(self, *rooms: RoomView) -> None:
        self.robot.rooms = rooms
        self.follower.follow()

    @property
    def planned(self) -> tuple[str, ...]:
        return self.plans.plans[0].order.rooms

    @property
    def dirty(self) -> list[str]:
        return list(self.kept("dirt.json").read(DirtRecords()).rooms)

    @property
    def seen(self) -> SeenRooms:
        return self.kept("rooms.json").read(SeenRooms())


@pytest.fixture
def following(tmp_path: Path) -> Following:
    following = Following(tmp_path)
    following.look(*ROOMS)
    return following


def test_the_first_rooms_are_kept_and_change_nothing(following: Following) -> None:
    assert [each.name for each in following.seen.rooms] == ["kitchen", "den"]
    assert not following.seen.is_pending
    assert (following.planned, following.told) == (("kitchen",), [])


def test_another_name_is_followed_once(following: Following) -> None:
    following.look(*RENAMED)
    following.look(*RENAMED)
    assert following.planned == ("galley",)
    assert following.dirty == ["galley"]
    assert following.told == ["goes on by other names of rooms: 'kitchen' is 'galley'"]
    assert not following.seen.is_pending


def test_rooms_that_are_as_they_were_are_not_written_again(
    following: Following, monkeypatch: pytest.MonkeyPatch
) -> None:
    def write(kept: KeptValues, values: Frozen) -> None:
        pytest.fail(f"written again: {values}")

    monkeypatch.setattr(KeptValues, "write", write)
    following.look(*ROOMS)
    following.again()
    following.look(*ROOMS)


def test_an_edit_that_is_taken_back_gives_plans_their_orders_again(following: Following) -> None:
    following.look(room("galley", 0.0), room("galley 2", 2.0))
    following.look(*ROOMS)
    assert following.planned == ("kitchen",)
    assert following.told[1:] == ["has its rooms again: the newest edit was taken back"]


def test_a_map_without_rooms_and_a_robot_that_is_gone_say_nothing(following: Following) -> None:
    following.look()
    following.robot.is_gone = True
    following.look(*RENAMED)
    assert (following.planned, following.told) == (("kitchen",), [])
    assert [each.name for each in following.seen.rooms] == ["kitchen", "den"]


def test_rooms_of_numbers_that_are_none_are_not_followed(following: Following) -> None:
    following.look(replace(RENAMED[0], area=float("nan")), RENAMED[1])
    assert (following.planned, following.told) == (("kitchen",), [])


@pytest.mark.parametrize("is_killed", [False, True])
def test_what_the_disk_refused_is_raised_and_finished_later(
    following: Following, is_killed: bool
) -> None:
    following.is_full = True
    with pytest.raises(OSError, match="No space left"):
        following.look(*RENAMED)
    assert following.seen.is_pending
    assert following.planned == ("kitchen",)
    following.is_full = False
    if is_killed:
        following.again()
    following.look()
    assert following.planned == ("galley",), "an edit that is pending needs no rooms"
    assert (following.dirty, len(following.told)) == (["galley"], 1)
    assert not following.seen.is_pending
