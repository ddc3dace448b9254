"""Playing with the home of a live robot, as the page does, and the truth that the page gets."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from fixtures.waiting import wait_until

from roomba.clean_request import CleanRequest
from roomba.client.observed import SPILL
from roomba.client.protocol import RequestRefusedError
from roomba.client.view import LayerName, PlayAct, TruthView
from roomba.commands.play.living import live_client
from roomba.headless.live.client import LiveClient
from roomba.headless.live.robot_client import LiveRobotClient
from roomba.vocabulary import CleanMode, FanLevel, RoomWay

DEADLINE = 20.0
"""s of wall time."""


@pytest.fixture(scope="module")
def shared() -> Iterator[LiveClient]:
    client = live_client("flat", seed=1, speed=20.0, knows_map=True)
    client.start()
    yield client
    client.end()


@pytest.fixture
def client(shared: LiveClient) -> Iterator[LiveClient]:
    """The robot on its station, in a home that is as it was."""
    yield shared
    shared.clear_away()
    for door in truth_of(shared).doors:
        shared.set_door(door.name, is_shut=False)
    shared.stop()
    shared.put_down(*shared.home().station)


def truth_of(client: LiveClient) -> TruthView:
    truth = client.robot().truth
    assert truth is not None
    return truth


def test_all_acts_are_offered(client: LiveClient) -> None:
    assert set(client.limits().play) == {act.value for act in PlayAct}


def test_the_truth_is_near_the_belief_and_shows_what_was_put_down(client: LiveClient) -> None:
    truth = truth_of(client)
    assert math.dist(truth.pose[:2], client.robot().pose[:2]) < 0.05
    client.place_chair(1.5, 1.5)
    added = set(truth_of(client).things) - set(truth.things)
    assert len(added) == 4
    for ring in added:
        middle = np.mean(ring, axis=0)
        assert math.dist(middle.tolist(), (1.5, 1.5)) == pytest.approx(0.2 * math.sqrt(2.0))
    client.clear_away()
    assert truth_of(client).things == truth.things


def test_dirt_lies_where_it_was_spilled(client: LiveClient) -> None:
    before = client.layer(LayerName.TRUE_DIRT)
    client.spill_dirt(1.5, 1.5)
    after = client.layer(LayerName.TRUE_DIRT)
    assert before is not None
    assert after is not None
    more = np.maximum(after.cells.astype(float) - before.cells, 0.0)
    rows, columns = np.indices(more.shape)
    x = after.origin_x + (columns + 0.5) * after.resolution
    y = after.origin_y + (rows + 0.5) * after.resolution
    near = np.hypot(x - 1.5, y - 1.5) < 3.0 * SPILL[0]
    assert more[near].sum() > 0.95 * more.sum() > 1000.0


def test_a_door_is_shut_and_opened(client: LiveClient) -> None:
    names = [door.name for door in truth_of(client).doors]
    assert "kitchen door" in names
    client.set_door("kitchen door", is_shut=True)

    def shut() -> list[str]:
        return [door.name for door in truth_of(client).doors if door.is_shut]

    wait_until(lambda: shut() == ["kitchen door"], DEADLINE, "the door to be shut")
    client.set_door("kitchen door", is_shut=False)
    wait_until(lambda: shut() == [], DEADLINE, "the door to be open")
    with pytest.raises(RequestRefusedError, match=r"a door of: .*kitchen door.*; got 'gate'"):
        client.set_door("gate", is_shut=True)


def test_a_lifted_robot_stands_and_finds_itself_where_it_was_put(client: LiveClient) -> None:
    client.clean(CleanRequest())
    wait_until(lambda: client.robot().vacuum.covered > 0.3, DEADLINE, "some clean floor")
    client.lift()
    assert truth_of(client).is_lifted
    wait_until(lambda: client.robot().vacuum.phase != "cleaning", DEADLINE, "it to notice")
    client.put_down(1.2, 2.2, 0.5)
    truth = truth_of(client)
    assert not truth.is_lifted
    assert truth.pose == pytest.approx((1.2, 2.2, 0.5))
    with pytest.raises(RequestRefusedError, match="does not fit"):
        client.put_down(-50.0, 0.0, 0.0)
    client.resume()
    wait_until(lambda: client.robot().vacuum.phase == "cleaning", DEADLINE, "it to go on")

    def is_found() -> bool:
        return math.dist(truth_of(client).pose[:2], client.robot().pose[:2]) < 0.1

    wait_until(is_found, DEADLINE, "it to know where it is")


def test_a_box_before_the_station_is_refused_where_the_robot_stands(client: LiveClient) -> None:
    before = len(truth_of(client).things)
    client.block_station()
    assert len(truth_of(client).things) == before + 1


def test_it_drives_no_faster_than_it_may(client: LiveClient) -> None:
    limits = client.limits()
    client.set_top_speed(0.2)
    assert client.robot().top_speed == 0.2
    client.go_to(1.5, 1.5)
    wait_until(lambda: client.robot().speed > 0.1, DEADLINE, "it to drive")
    assert client.robot().speed < 0.23
    for wrong in (0.5 * limits.min_speed, 2.0 * limits.max_speed):
        with pytest.raises(RequestRefusedError, match="a speed from"):
            client.set_top_speed(wrong)
    client.set_top_speed(limits.max_speed)


def test_each_room_is_cleaned_its_own_way(client: LiveClient) -> None:
    rooms = ("bathroom", "hallway")
    once = CleanRequest(mode=CleanMode.ROOMS, rooms=rooms, in_order=True)
    client.clean(once)
    wanted = client.robot().vacuum.wanted
    ways = (RoomWay(2, FanLevel.QUIET), RoomWay(1, FanLevel.STRONG))
    client.clean(CleanRequest(mode=CleanMode.ROOMS, rooms=rooms, each=ways, in_order=True))
    assert client.robot().vacuum.wanted == wanted
    with pytest.raises(RequestRefusedError, match="each of the 2 rooms"):
        client.clean(CleanRequest(mode=CleanMode.ROOMS, rooms=rooms, each=ways[:1], in_order=True))


def test_the_rooms_of_a_clean_are_changed_while_it_is_under_way(client: LiveClient) -> None:
    client.clean(CleanRequest(mode=CleanMode.ROOMS, rooms=("bathroom", "hallway"), in_order=True))
    assert client.robot().vacuum.queue == ("bathroom", "hallway")
    client.change_rooms(("hallway", "bathroom"))
    assert client.robot().vacuum.queue == ("hallway", "bathroom")
    with pytest.raises(RequestRefusedError, match="got 'attic'"):
        client.change_rooms(("attic",))
    LiveRobotClient(client).change_rooms(["bathroom"])
    assert client.robot().vacuum.queue == ("bathroom",)
    client.stop()
    assert client.robot().vacuum.queue == ()
