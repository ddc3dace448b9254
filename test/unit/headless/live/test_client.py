"""A live robot, observed and commanded as a page does."""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np
import pytest
from fixtures.waiting import wait_until
from unit.headless.live.living import living, stop_while_busy

from roomba.clean_request import CleanRequest
from roomba.client.plain import home_from, home_of
from roomba.client.protocol import RequestRefusedError, RobotUnavailableError
from roomba.client.view import LayerName, ZoneView
from roomba.commands.play.living import live_client
from roomba.configuration.frozen import load_config
from roomba.configuration.household import HouseholdConfig
from roomba.files.shipped import CONFIGURATION
from roomba.headless.live.client import LiveClient
from roomba.household.household import LiveHousehold
from roomba.perception.rooms.low_things import LowThing, LowThings
from roomba.plans.plan import Plan
from roomba.storage.kept_stop import KeptStop
from roomba.vocabulary import CleanMode

LINE = ZoneView("line", "wall", ((0.5, -0.5), (0.9, -0.5)))
DEADLINE = 20.0
"""s of wall time."""


@pytest.fixture
def client() -> Iterator[LiveClient]:
    client = live_client("studio", seed=1, speed=40.0, knows_map=True)
    client.start()
    wait_until(lambda: phase(client) == "docked", DEADLINE, "the robot on its station")
    yield client
    client.end()


def phase(client: LiveClient) -> str:
    return client.robot().vacuum.phase


def test_it_cleans_pauses_goes_on_stops_and_docks(client: LiveClient) -> None:
    assert phase(client) == "docked"
    client.clean(CleanRequest())
    wait_until(lambda: client.robot().vacuum.covered > 0.5, DEADLINE, "some clean floor")
    client.pause()
    assert phase(client) == "paused"
    stood = client.robot()
    wait_until(lambda: client.robot().time > stood.time + 2.0, DEADLINE, "time to pass")
    assert math.dist(client.robot().pose[:2], stood.pose[:2]) < 0.1
    client.resume()
    assert phase(client) != "paused"
    client.stop()
    assert phase(client) == "idle"
    last = client.robot().last
    assert last is not None
    assert last.outcome.value == "stopped"
    client.dock()
    wait_until(lambda: phase(client) == "docked", DEADLINE, "the robot on its station")


def test_a_whole_clean_is_shown_and_told(client: LiveClient) -> None:
    client.clean(CleanRequest())
    wait_until(lambda: client.robot().last is not None, DEADLINE, "the end of the clean")
    last, layer = client.robot().last, client.layer(LayerName.COVERAGE)
    assert last is not None
    assert layer is not None
    assert last.outcome.value == "completed"
    swept = np.count_nonzero(layer.cells) * layer.resolution**2
    assert swept >= 0.97 * last.covered


def test_the_emergency_stop_holds_until_it_is_released(client: LiveClient) -> None:
    client.clean(CleanRequest())
    client.emergency_stop("a test")
    assert client.robot().held == "a test"
    with pytest.raises(RequestRefusedError, match="emergency"):
        client.drive(0.1, 0.0)
    with pytest.raises(RequestRefusedError):
        client.resume()
    with pytest.raises(RequestRefusedError, match="release it first"):
        client.go_to(*client.home().rooms[0].anchor)
    client.release()
    assert client.robot().held == ""
    assert phase(client) == "paused"
    released = client.robot()
    wait_until(lambda: client.robot().time > released.time + 3.0, DEADLINE, "time to pass")
    assert math.dist(client.robot().pose[:2], released.pose[:2]) < 0.01
    assert client.robot().last is None
    client.resume()
    wait_until(lambda: client.robot().last is not None, DEADLINE, "the end of the clean")
    last = client.robot().last
    assert last is not None
    assert last.outcome.value == "completed"


def test_an_emergency_stop_that_a_busy_robot_did_not_answer_holds_it(
    client: LiveClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    stop_while_busy(client, client.ask, monkeypatch)
    wait_until(lambda: client.robot().held == "the cat", DEADLINE, "it holds")


def lives(stops: Path) -> AbstractContextManager[LiveClient]:
    return living(live_client("studio", seed=1, speed=40.0, knows_map=True), stops)


def test_the_emergency_stop_holds_the_robot_that_is_started_anew(tmp_path: Path) -> None:
    with lives(tmp_path) as client:
        assert client.robot().held == ""
        client.emergency_stop("child in the way")
    with lives(tmp_path) as client:
        assert client.robot().held == "child in the way"
        assert phase(client) == "emergency stop"
        with pytest.raises(RequestRefusedError, match="child in the way"):
            client.clean(CleanRequest())
        client.release()
        assert client.robot().held == ""
    with lives(tmp_path) as client:
        assert client.robot().held == ""
        client.emergency_stop(" ")
    with lives(tmp_path) as client:
        assert client.robot().held == "no reason was given"


def test_a_kept_stop_that_is_damaged_holds_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "studio.txt").write_bytes(b"")
    with lives(tmp_path) as client:
        assert "it counts as held" in client.robot().held
        client.release()
    assert list(tmp_path.iterdir()) == []


def test_a_plan_that_is_due_waits_while_the_kept_stop_holds(tmp_path: Path) -> None:
    assert KeptStop(tmp_path, "studio").keep(lambda: "child in the way") == ""
    now = [dt.datetime(2026, 3, 2, 8, 0, tzinfo=dt.timezone.utc)]
    with lives(tmp_path) as client:
        config = load_config(HouseholdConfig, CONFIGURATION / "household.yaml")
        told: list[str] = []
        household = LiveHousehold(
            client, tmp_path / "household", config, 50.0, told.append, now=lambda: now[0]
        )
        household.set_zone("UTC")
        household.put_plan(Plan(name="all"))
        household.look()
        now[0] += dt.timedelta(hours=1, minutes=1)
        household.look()
        (plan,) = household.plans().plans
        assert plan.reason == "the emergency stop holds the drive"
        assert phase(client) == "emergency stop"
        client.release()
        household.look()
        assert household.plans().running == "all"
        assert told == []


def test_a_disk_that_does_not_keep_the_stop_holds_it_nevertheless_and_is_told(
    tmp_path: Path,
) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"")
    with lives(file) as client:
        client.clean(CleanRequest())
        client.emergency_stop("child in the way")
        held = client.robot().held
        assert held.startswith("child in the way; but it is forgotten if the robot is killed, ")
        assert phase(client) == "emergency stop"
        client.release()
        assert client.robot().held == ""


def test_a_kept_stop_that_cannot_be_removed_is_told_and_the_drive_is_free(tmp_path: Path) -> None:
    (tmp_path / "studio.txt").mkdir()
    with lives(tmp_path) as client:
        with pytest.raises(RequestRefusedError, match="the drive is free; but it holds again"):
            client.release()
        assert client.robot().held == ""


def test_driving_by_hand_ends_with_silence(client: LiveClient) -> None:
    client.clean(CleanRequest())
    wait_until(lambda: phase(client) == "cleaning", DEADLINE, "the clean")
    with pytest.raises(RequestRefusedError, match="pause it"):
        client.drive(0.1, 0.0)
    client.pause()
    before = client.robot()
    client.drive(0.0, 1.0)
    wait_until(lambda: abs(client.robot().pose[2] - before.pose[2]) > 0.2, DEADLINE, "a turn")

    def stands() -> bool:
        one = client.robot()
        wait_until(lambda: client.robot().time > one.time + 1.0, DEADLINE, "time to pass")
        return abs(client.robot().pose[2] - one.pose[2]) < 0.01

    wait_until(stands, DEADLINE, "the robot to stand")


def test_it_goes_where_it_is_sent(client: LiveClient) -> None:
    x, y = client.home().rooms[0].anchor
    client.go_to(x, y)
    wait_until(
        lambda: math.dist(client.robot().pose[:2], (x, y)) < 0.05, DEADLINE, "the robot there"
    )
    with pytest.raises(RequestRefusedError, match=r"\w"):
        client.go_to(500.0, 500.0)


def test_the_emergency_stop_ends_a_walk() -> None:
    # So slow that it is still on its way when that is seen.
    client = live_client("studio", seed=1, speed=3.0, knows_map=True)
    client.start()
    try:
        wait_until(lambda: phase(client) == "docked", DEADLINE, "the robot on its station")
        client.go_to(*client.home().rooms[0].anchor)
        wait_until(lambda: client.robot().speed > 0.1, DEADLINE, "the robot on its way")
        client.emergency_stop("a test")
        client.release()
        held = client.robot()
        wait_until(lambda: client.robot().time > held.time + 3.0, DEADLINE, "time to pass")
        assert math.dist(client.robot().pose[:2], held.pose[:2]) < 0.2
        assert client.robot().speed == 0.0
    finally:
        client.end()


def test_a_full_bin_is_said_and_emptied() -> None:
    client = live_client("studio", seed=1, speed=40.0, knows_map=True, bin_grams=3.0)
    client.start()
    try:
        wait_until(lambda: phase(client) == "docked", DEADLINE, "the robot on its station")
        client.clean(CleanRequest())
        wait_until(lambda: phase(client) == "bin full", DEADLINE, "a full bin")
        assert "empty" in client.robot().vacuum.message
        client.empty_bin()
        wait_until(lambda: phase(client) == "cleaning", DEADLINE, "the clean to go on")
        assert client.robot().dirt < 3.0
    finally:
        client.end()


def test_rooms_and_zones_are_edited(client: LiveClient) -> None:
    first = client.home()
    assert first.rooms
    name = first.rooms[0].name
    client.rename_room(name, "Den")
    assert client.home().rooms[0].name == "Den"
    assert client.home().version > first.version
    client.put_zone(ZoneView("rug", "no-go", ((0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0))))
    assert [zone.name for zone in client.home().zones] == ["rug"]
    client.remove_zone("rug")
    assert client.home().zones == ()


def test_zones_are_offered_of_low_things_taken_or_ignored(client: LiveClient) -> None:
    low = LowThings((LowThing(0.5, 0.5, 0.6, 0.5, 3), LowThing(0.5, -0.5, 0.5, -0.5, 9)))
    first = client.home()
    assert first.low_things == ()
    client.ask(lambda robot: setattr(robot.mission.obstacles, "low", low))
    wait_until(lambda: client.home().low_things, DEADLINE, "offers")
    one, other = client.home().low_things
    assert (one.times, other.times) == (3, 9)
    assert client.home().version > first.version
    assert home_of(client.home())["low_things"][0]["times"] == 3
    client.put_zone(ZoneView("cable", "no-go", one.corners))
    assert client.home().low_things == (other,)
    with pytest.raises(RequestRefusedError, match="was felt"):
        client.ignore_low_thing(2.0, 2.0)
    client.ignore_low_thing(0.5, -0.5)
    assert client.home().low_things == ()
    client.remove_zone("cable")
    assert client.home().low_things == (one,)


def test_carpets_that_it_felt_are_told_with_the_home(client: LiveClient) -> None:
    assert client.home().felt_carpets == ()
    client.clean(CleanRequest())
    wait_until(lambda: client.home().felt_carpets, 60.0, "a carpet")
    first = client.home()
    assert home_of(first)["felt_carpets"] == first.felt_carpets
    wait_until(lambda: client.home().version > first.version, 60.0, "more of it")
    assert home_from(home_of(client.home())).felt_carpets == client.home().felt_carpets


def test_the_newest_edit_of_the_rooms_is_taken_back(client: LiveClient) -> None:
    """Once; what was done to zones since then stays."""
    before = client.home().rooms
    x, y = before[0].anchor
    client.split_room(before[0].name, (x - 20.0, y), (x + 20.0, y))
    assert len(client.home().rooms) > len(before)
    client.put_zone(ZoneView("rug", "no-go", ((0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0))))
    client.undo_rooms()
    assert client.home().rooms == before
    client.remove_zone("rug")
    with pytest.raises(RequestRefusedError, match="an edit of the rooms to take back"):
        client.undo_rooms()


@pytest.mark.parametrize(
    "ask",
    [
        lambda client: client.clean(CleanRequest(CleanMode.ROOMS, ("no such room",))),
        lambda client: client.resume(),
        lambda client: client.explore(),
        lambda client: client.remove_zone("none"),
        lambda client: client.put_zone(ZoneView("x", "no-go", ((0.0, 0.0), (1.0, 1.0)))),
        lambda client: client.put_zone(ZoneView("x", "lava", ((0.0, 0.0), (1.0, 1.0)))),
        lambda client: client.spill_dirt(1e6, 1e6),
    ],
)
def test_what_cannot_be_is_refused_with_a_reason(
    client: LiveClient, ask: Callable[[LiveClient], None]
) -> None:
    before = client.home()
    with pytest.raises(RequestRefusedError, match=r"\w"):
        ask(client)
    assert client.home().zones == before.zones
    assert phase(client) == "docked"


def test_a_robot_that_ended_says_so() -> None:
    client = live_client("studio", seed=1, speed=5.0, knows_map=True)
    client.start()
    client.end()
    with pytest.raises(RobotUnavailableError, match="start it again"):
        client.dock()


def test_what_was_swept_stays_shown_while_the_map_grows() -> None:
    client = live_client("flat", seed=1, speed=200.0, knows_map=False)
    client.start()
    try:
        client.clean(CleanRequest())
        shapes: list[tuple[int, ...]] = []

        def has_grown() -> bool:
            covered, layer = client.robot().vacuum.covered, client.layer(LayerName.COVERAGE)
            assert layer is not None
            shapes.append(layer.cells.shape)
            if covered > 2.0:
                shown = np.count_nonzero(layer.cells) * layer.resolution**2
                assert shown > 0.9 * covered
            return covered > 2.0 and shapes[-1] != shapes[-2]

        wait_until(has_grown, DEADLINE, "a map that grows while it cleans", pause=0.02)
    finally:
        client.end()


def test_without_a_map_it_explores_and_finds_rooms() -> None:
    client = live_client("studio", seed=1, speed=100.0, knows_map=False)
    client.start()
    try:
        assert client.home().rooms == ()
        first = client.layer(LayerName.MAP)
        assert first is not None
        client.put_zone(LINE)
        client.explore()
        wait_until(lambda: client.robot().last is not None, DEADLINE, "the end of the exploration")
        layer = client.layer(LayerName.MAP)
        assert layer is not None
        assert client.home().rooms
        # To be whole the map was turned a little, and the zone with it.
        (line,) = client.home().zones
        assert line.points != LINE.points
        assert np.array(line.points) == pytest.approx(np.array(LINE.points), abs=0.2)
        assert np.count_nonzero(layer.cells == 1) > np.count_nonzero(first.cells == 1)
    finally:
        client.end()


def test_an_exploration_that_was_stopped_leaves_the_rest_to_be_explored() -> None:
    client = live_client("studio", seed=1, speed=10.0, knows_map=False)
    client.start()
    try:
        client.explore()
        wait_until(lambda: phase(client) == "exploring", DEADLINE, "the exploration")
        client.stop()
        last = client.robot().last
        assert last is not None
        assert last.outcome.value == "stopped"
        client.explore()
        assert phase(client) != "idle"
        assert client.home().rooms == ()
    finally:
        client.end()


def test_its_camera_looks_to_both_sides(client: LiveClient) -> None:
    ahead, left = client.picture(0.0), client.picture(30.0)
    assert ahead.shape == left.shape
    assert ahead.shape[2] == 3
    assert ahead.std() > 5.0
    assert np.abs(ahead.astype(int) - left).mean() > 5.0
    with pytest.raises(RequestRefusedError, match="from -30 to 30 degrees"):
        client.picture(90.0)
