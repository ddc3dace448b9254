"""Which floor it is: the right one, or none, or not sure; never a wrong one."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
import pytest
from fixtures.robots.located import (
    CONFIG,
    FURNISHED,
    LIDAR,
    MOVED,
    SQUARE,
    TWO_ROOMS,
    Eye,
    Ranges,
    free_poses,
)
from fixtures.thoroughness import core_first

from roomba.configuration.mapping import FloorsConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose, Twist, wrap_angle
from roomba.perception.floors.recognition import (
    FloorPlace,
    FloorRecognition,
    FloorRecord,
    FloorVerdict,
)
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

RECKONED = Pose(-3.0, 7.0, 2.0)
"""Dead reckoning's frame lies anywhere."""
STORED = ("flat", "studio", "family", "apartment")
TURNS = (0.0, 0.8, -0.8)
"""rad; looks around, on the spot."""


@cache
def shipped(name: str) -> Home:
    return load_home(name, HOMES)


def floor_of(home: Home) -> FloorRecord:
    return FloorRecord(home.map, home.station)


@cache
def stored(*names: str) -> Mapping[str, FloorRecord]:
    return {name: floor_of(shipped(name)) for name in names}


def shown(recognition: FloorRecognition, ranges: Ranges, reckoned: Pose) -> FloorVerdict:
    """Show a scan, and let it work until all is compared."""
    recognition.see(LIDAR.view(ranges), reckoned)
    for _ in range(1000):
        if recognition.verdict is not FloorVerdict.SEARCHING:
            return recognition.verdict
        assert recognition.place is None
        recognition.advance()
    raise AssertionError("the search does not end")


def recognised(
    floors: Mapping[str, FloorRecord], home: Home, pose: Pose, seed: int = 0
) -> FloorRecognition:
    """Look around in a home, with noise, until it is decided or all is seen."""
    recognition = FloorRecognition(floors, CONFIG.localization, FloorsConfig(), CONFIG.body.radius)
    eye, random = Eye(home), np.random.default_rng(seed)
    for turn in TURNS:
        move = Pose(0.0, 0.0, turn)
        if shown(recognition, eye.scan(pose.compose(move), random), RECKONED.compose(move)) in (
            FloorVerdict.KNOWN,
            FloorVerdict.NEW,
        ):
            break
    return recognition


def is_at(place: FloorPlace | None, floor: str, pose: Pose, turn: float = 0.0) -> bool:
    if place is None or place.floor != floor:
        return False
    off = abs(wrap_angle(place.pose.theta - pose.theta - turn))
    return place.pose.distance_to(pose.x, pose.y) < 0.05 and off < 0.03


@pytest.mark.parametrize("name", STORED)
def test_it_wakes_on_the_station_of_one_of_several_floors(name: str) -> None:
    home = shipped(name)
    recognition = recognised(stored(*STORED), home, home.station)
    assert recognition.verdict is FloorVerdict.KNOWN
    assert recognition.views == 1
    assert is_at(recognition.place, name, home.station)


@pytest.mark.parametrize("name", core_first(STORED, {"flat"}))
def test_it_wakes_anywhere(name: str) -> None:
    home = shipped(name)
    found = 0
    for seed, pose in enumerate(free_poses(home, 10, np.random.default_rng(7))):
        recognition = recognised(stored(*STORED), home, pose, seed)
        place = recognition.place
        assert place is None or place.floor == name
        assert recognition.verdict is not FloorVerdict.NEW
        if place is not None:
            turn = TURNS[recognition.views - 1]
            found += is_at(place, name, pose, turn)
    assert found >= 9


@pytest.mark.parametrize("name", core_first(STORED, {"flat"}))
def test_a_home_that_is_not_stored_is_a_new_floor(name: str) -> None:
    home = shipped(name)
    others = stored(*(each for each in STORED if each != name))
    poses = [home.station, *free_poses(home, 10, np.random.default_rng(8))]
    verdicts = [recognised(others, home, pose, seed).verdict for seed, pose in enumerate(poses)]
    assert FloorVerdict.KNOWN not in verdicts
    assert verdicts.count(FloorVerdict.NEW) >= 10
    assert verdicts[0] is FloorVerdict.NEW


def test_of_two_copies_of_a_floor_neither_is_believed() -> None:
    home = shipped("studio")
    copies = {"one": floor_of(home), "other": floor_of(home)}
    for seed, pose in enumerate([home.station, *free_poses(home, 3, np.random.default_rng(9))]):
        recognition = recognised(copies, home, pose, seed)
        assert recognition.verdict is FloorVerdict.UNSURE
        assert recognition.views == len(TURNS)
        assert recognition.place is None
        assert {place.floor for place in recognition.places[:2]} == {"one", "other"}


def test_a_copy_whose_station_is_elsewhere_is_not_ruled_out_by_that() -> None:
    """Where the robot stands is a guess; both fit as well."""
    home = shipped("studio")
    moved = free_poses(home, 1, np.random.default_rng(9))[0]
    copies = {"one": floor_of(home), "other": FloorRecord(home.map, moved)}
    recognition = recognised(copies, home, home.station)
    assert recognition.verdict is FloorVerdict.UNSURE
    assert recognition.places[0].floor == "one"


@pytest.mark.parametrize("order", [STORED, STORED[::-1]])
def test_the_order_of_floors_is_of_no_account(order: tuple[str, ...]) -> None:
    home = shipped("family")
    pose = free_poses(home, 1, np.random.default_rng(2))[0]
    recognition = recognised(stored(*order), home, pose)
    assert is_at(recognition.place, "family", pose, TURNS[recognition.views - 1])


def test_some_furniture_was_moved_since() -> None:
    floors = {"one": floor_of(FURNISHED), "other": floor_of(TWO_ROOMS)}
    recognition = recognised(floors, MOVED, MOVED.station)
    assert is_at(recognition.place, "one", MOVED.station, TURNS[recognition.views - 1])
    assert recognition.places[0].fit.agree < 0.95


def test_a_room_that_looks_the_same_from_four_sides_is_no_place() -> None:
    recognition = recognised({"square": floor_of(SQUARE)}, SQUARE, Pose(1.0, 1.2, 0.3))
    assert recognition.verdict is FloorVerdict.UNSURE


def test_without_floors_every_floor_is_new() -> None:
    recognition = FloorRecognition({}, CONFIG.localization, FloorsConfig(), CONFIG.body.radius)
    assert recognition.verdict is FloorVerdict.NEW
    recognition.see(LIDAR.view(Eye(SQUARE).scan(Pose(1.0, 1.2, 0.3))), RECKONED)
    recognition.advance()
    assert recognition.verdict is FloorVerdict.NEW
    assert recognition.places == ()


def test_a_scan_with_next_to_nothing_in_it_says_nothing() -> None:
    recognition = FloorRecognition(
        {"room": floor_of(FURNISHED)}, CONFIG.localization, FloorsConfig(), CONFIG.body.radius
    )
    ranges = np.full(LIDAR.beams, np.inf, np.float32)
    ranges[: CONFIG.localization.least_beams - 1] = 1.0
    recognition.see(LIDAR.view(ranges), RECKONED)
    recognition.advance()
    assert recognition.verdict is FloorVerdict.SEARCHING
    assert recognition.views == 0


def test_the_same_scan_again_is_no_more_evidence() -> None:
    recognition = recognised({"square": floor_of(SQUARE)}, SQUARE, Pose(1.0, 1.2, 0.3))
    before = recognition.places
    turned = RECKONED.compose(Pose(0.0, 0.0, TURNS[-1]))
    shown(recognition, Eye(SQUARE).scan(Pose(1.0, 1.2, 0.3 + TURNS[-1])), turned)
    assert recognition.places == before
    assert recognition.views == len(TURNS)


def test_driving_off_the_station_it_stays_known_and_its_pose_follows() -> None:
    """In the simulator, by the wheels' odometry."""
    home = shipped("flat")
    world = Simulator(home, CONFIG, seed=3)
    recognition = FloorRecognition(
        stored(*STORED), CONFIG.localization, FloorsConfig(), CONFIG.body.radius
    )
    now = world.step(Twist(), 0.1)
    for _ in range(8):
        assert shown(recognition, world.ranges, now.odometry) is FloorVerdict.KNOWN
        at = now.pose
        place = recognition.place
        assert place is not None
        assert place.pose.distance_to(at.x, at.y) < 0.05
        for _ in range(20):
            now = world.step(Twist(-0.15, 0.3), 0.05)
    assert recognition.views == 8
