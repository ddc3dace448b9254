"""``./roomba localize`` of made logs: table, files, starts, what happens on the way, refusals."""

from __future__ import annotations

import csv
import gzip
import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fixtures.drives.made_logs import (
    BEGAN,
    LASER,
    Item,
    changed,
    drive,
    held,
    pose_at,
    ranges_from,
    room_map,
    write_bag,
    write_bag_2,
    write_carmen,
)
from PIL import Image as Picture
from PIL import ImageColor
from rosbags.rosbag1 import Reader
from rosbags.rosbag2 import StoragePlugin

from roomba.commands.localize.command import main
from roomba.files.occupancy_map import save_map
from roomba.geometry import Pose
from roomba.plots.style import BLUE
from roomba.recordings.message_types import known_types
from roomba.recordings.readings import Lifted, OwnPose, ToldPose

SECONDS = 14.0
START = pose_at(0.0)
OFFSET = 0.1
"""m; how far what the robot said of its place is from the truth."""


def said(items: list[Item], topic: str) -> list[Item]:
    """Return a drive on which the robot said on a topic where it was, ten times a second."""
    told = []
    for item in items:
        if item.topic == "/odom":
            here = pose_at(item.stamp - BEGAN)
            beside = OwnPose(replace(here, x=here.x + OFFSET))
            told.append(replace(item, topic=topic, value=beside))
    return sorted([*items, *told], key=lambda item: item.arrival)


@pytest.fixture(scope="module")
def room(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The room's map."""
    path = tmp_path_factory.mktemp("room") / "room.yaml"
    save_map(room_map(), path)
    return path


@dataclass
class Localized:
    """What one run of the program said and wrote."""

    status: int
    output: str
    error: str
    figures: dict[str, Any]
    rows: list[dict[str, str]]

    def off(self, true: Callable[[float], Pose] = pose_at) -> float:
        """Return how far the last row is from the truth, m."""
        last = self.rows[-1]
        here = true(float(last["t"]) - BEGAN)
        return here.distance_to(float(last["x"]), float(last["y"]))

    @property
    def is_at_the_end(self) -> bool:
        """Whether the last row is known, and right."""
        last = self.rows[-1]
        here = pose_at(float(last["t"]) - BEGAN)
        turn = abs(math.remainder(float(last["theta"]) - here.theta, math.tau))
        is_last = abs(float(last["t"]) - BEGAN - SECONDS) < 0.3
        return last["state"] == "known" and self.off() < 0.05 and turn < 0.05 and is_last


Localize = Callable[..., Localized]


@pytest.fixture
def localize(room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Localize:
    """Run the program on logs, with more arguments."""

    def run(*words: object, map_: Path = room) -> Localized:
        figures, rows = tmp_path / "figures.json", tmp_path / "rows.csv"
        given = ["--map", map_, "--json", figures, "--csv", rows, "--bag", *words]
        status = main(list(map(str, given)))
        told = capsys.readouterr()
        if status:
            return Localized(status, told.out, told.err, {}, [])
        with rows.open(encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        values = json.loads(figures.read_text("utf-8"))
        return Localized(status, told.out, told.err, values, table)

    return run


def at_start() -> list[object]:
    return ["--start", START.x, START.y, START.theta]


def test_a_drive_with_a_scan_a_second_is_known(localize: Localize, tmp_path: Path) -> None:
    scans = [item for item in drive(SECONDS) if item.topic == "/scan"][::5]
    odometry = [item for item in drive(SECONDS) if item.topic != "/scan"]
    items = sorted([*scans, *odometry], key=lambda item: item.arrival)
    done = localize(write_bag(tmp_path / "rare.bag", items), *at_start())
    assert done.figures["shares"]["known"] > 0.95
    assert done.off() < 0.05


def test_a_drive_is_followed_from_a_given_start(localize: Localize, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "made.bag", said(drive(SECONDS), "/pose"))
    plot, output, way = tmp_path / "a.png", tmp_path / "out.bag", tmp_path / "way.txt"
    files = ["--plot", plot, "--out", output, "--trajectory", way]
    done = localize(bag, *at_start(), *files)
    assert done.status == 0
    assert done.is_at_the_end
    assert done.figures["start"] == "given"
    assert done.figures["logs"] == [str(bag)]
    assert done.figures["shares"]["known"] > 0.98
    assert done.figures["scans"] == 5 * SECONDS
    assert done.figures["seconds"] == pytest.approx(SECONDS, abs=0.2)
    assert done.figures["way"] == pytest.approx(0.3 * SECONDS, abs=0.1)
    assert done.figures["stamps"]["messages"] == 25 * SECONDS
    [difference] = done.figures["differences"]
    assert difference["topic"] == "/pose"
    assert difference["median"] == pytest.approx(OFFSET, abs=0.02)
    assert "place      known 99." in done.output
    assert "\x1b" not in done.output + done.error
    rows = np.loadtxt(way)
    assert rows[:, 0] == pytest.approx([float(row["t"]) for row in done.rows])
    assert rows[:, 1] == pytest.approx([float(row["x"]) for row in done.rows], abs=1e-5)
    assert rows[:, 3] == pytest.approx([float(row["theta"]) for row in done.rows], abs=1e-5)
    with Picture.open(plot) as picture:
        assert picture.width >= 800
        counted = picture.convert("RGB").getcolors(1_000_000)
    colours = {colour: count for count, colour in counted or []}
    assert colours[ImageColor.getrgb(BLUE)] > 500
    with Reader(output) as written:
        counts = {topic: info.msgcount for topic, info in written.topics.items()}
        times = [1e-9 * time for _, time, _ in written.messages()]
    assert counts["/pose"] == len(done.rows)
    assert counts["/tf"] == counts["/amcl_pose"] == (len(done.rows) + 1) // 2
    assert SECONDS <= counts["/localization"] <= SECONDS + 3
    # As it was recorded: 20 ms after its stamp.
    assert (times[0], times[-1]) == pytest.approx((rows[0, 0] + 0.02, rows[-1, 0] + 0.02), abs=1e-4)


@pytest.mark.parametrize("form", ["bag", "bag.gz", "folder", "mcap", "log", "two"])
def test_each_form_of_a_recording_is_followed_without_a_start(
    localize: Localize, tmp_path: Path, form: str
) -> None:
    items = drive(SECONDS)
    if form in ("folder", "mcap"):
        storage = StoragePlugin.MCAP if form == "mcap" else StoragePlugin.SQLITE3
        given = [write_bag_2(tmp_path / "made", items, storage)]
    elif form == "log":
        given = [write_carmen(tmp_path / "made.log", items)]
    elif form == "two":
        half = len(items) // 2
        given = [
            write_bag(tmp_path / "b.bag", items[half:]),
            write_bag(tmp_path / "a.bag", items[:half]),
        ]
    else:
        given = [write_bag(tmp_path / "made.bag", items)]
    if form == "bag.gz":
        given = [tmp_path / "made.bag.gz"]
        given[0].write_bytes(gzip.compress((tmp_path / "made.bag").read_bytes()))
    done = localize(*given)
    assert done.is_at_the_end
    # Files begin when the place is first known: before that there is no pose to write.
    assert done.rows[0]["state"] == "known"
    assert done.figures["found_after"] < 8.0
    assert done.figures["differences"] == []
    assert "searched for in the whole map" in done.output


@pytest.mark.parametrize("topic", ["/initialpose", "/amcl_pose"])
def test_a_recorded_pose_is_the_start(localize: Localize, tmp_path: Path, topic: str) -> None:
    told = Item(topic, ToldPose(START, (0.0, 0.0)), 0.0, BEGAN + 0.05)
    late = Item(topic, ToldPose(pose_at(9.0), (0.2, 0.2)), BEGAN + 3.0, BEGAN + 3.02)
    done = localize(write_bag(tmp_path / "made.bag", [told, *drive(SECONDS), late]))
    assert done.figures["start"] == f"as recorded on {topic}"
    assert done.figures["found_after"] < 0.3
    assert done.is_at_the_end
    topics = [each["topic"] for each in done.figures["differences"]]
    assert topics == (["/amcl_pose"] if topic == "/amcl_pose" else [])


def test_a_told_start_that_is_no_place_on_the_map_is_told(
    localize: Localize, tmp_path: Path
) -> None:
    told = Item("/initialpose", ToldPose(Pose(math.nan, 0.0), (0.1, 0.1)), BEGAN, BEGAN)
    done = localize(write_bag(tmp_path / "made.bag", [told, *drive(SECONDS)]))
    assert done.figures["start"] == "searched for in the whole map"
    assert any("1 told poses: left out" in note for note in done.figures["notes"])


def test_a_given_start_counts_more_than_a_recorded_one(localize: Localize, tmp_path: Path) -> None:
    told = Item("/initialpose", ToldPose(Pose(5.0, 1.0, 2.0), (0.1, 0.1)), BEGAN, BEGAN)
    done = localize(write_bag(tmp_path / "made.bag", [told, *drive(SECONDS)]), *at_start())
    assert done.figures["start"] == "given"
    assert done.figures["shares"]["known"] > 0.98


@pytest.mark.parametrize("topic", ["/kitchen/pose", "/kitchen/position"])
def test_a_robot_with_other_names_for_its_topics(
    localize: Localize, tmp_path: Path, topic: str
) -> None:
    items = said(drive(SECONDS), topic)
    names = {"/scan": "/kitchen/base_scan", "/odom": "/kitchen/odom"}
    items = [replace(item, topic=names.get(item.topic, item.topic)) for item in items]
    bag = write_bag(tmp_path / "made.bag", items)
    wrong = localize(bag, "--scan-topic", "/scan")
    assert wrong.status == 1
    assert "try --scan /kitchen/base_scan" in wrong.error
    assert wrong.error.count("\n") == 1
    given = ("--scan-topic", "/kitchen/base_scan", "--odom-topic", "kitchen/odom", *at_start())
    for words in (given, at_start()):
        done = localize(bag, *words)
        assert done.is_at_the_end
        assert done.figures["differences"][0]["topic"] == topic
        assert done.figures["differences"][0]["median"] == pytest.approx(OFFSET, abs=0.02)


def test_a_drive_without_odometry_is_followed(localize: Localize, tmp_path: Path) -> None:
    items = [item for item in drive(SECONDS) if item.topic == "/scan"]
    output = tmp_path / "out.bag"
    done = localize(write_bag(tmp_path / "made.bag", items), *at_start(), "--out", output)
    assert done.is_at_the_end
    assert done.figures["shares"]["known"] > 0.95
    assert "no odometry was recorded: it goes by scans alone" in done.figures["notes"]
    with Reader(output) as written:
        store = known_types(is_first=True)
        moved = [
            store.deserialize_ros1(raw, each.msgtype).transforms[0]
            for each, _, raw in written.messages()
            if each.topic == "/tf"
        ]
    # No frame of odometry: the robot's own lies where it is.
    assert {each.child_frame_id for each in moved} == {"base_link"}
    assert moved[-1].transform.translation.x == pytest.approx(float(done.rows[-1]["x"]), abs=0.1)


@pytest.mark.parametrize("goes_on_there", [True, False])
def test_odometry_that_stands_still_for_a_while_loses_nothing(
    localize: Localize, tmp_path: Path, goes_on_there: bool
) -> None:
    items = changed(drive(SECONDS), "/odom", held(4.0, 10.0, goes_on_there=goes_on_there))
    done = localize(write_bag(tmp_path / "made.bag", items), *at_start())
    assert done.is_at_the_end
    assert done.figures["losses"] == []
    assert any("stands still or is missing for 6 s" in note for note in done.figures["notes"])


def test_where_the_lidar_is_may_be_told(localize: Localize, tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "made.bag", drive(SECONDS), with_mount=False)
    done = localize(bag, *at_start(), "--laser", f"{LASER.x},0,0")
    assert done.is_at_the_end
    assert not any("no transform" in note for note in done.figures["notes"])
    assert any("no transform" in note for note in localize(bag, *at_start()).figures["notes"])


def test_a_lidar_that_looks_back_is_noticed(localize: Localize, tmp_path: Path) -> None:
    def turned_round(number: int, item: Item) -> Item:
        back = pose_at(item.stamp - BEGAN).compose(LASER).compose(Pose(theta=math.pi))
        seen = ranges_from(back.compose(LASER.inverse()), np.random.default_rng(number))
        return replace(item, value=seen)

    items = changed(drive(SECONDS), "/scan", turned_round)
    done = localize(write_bag(tmp_path / "made.bag", items, with_mount=False), *at_start())
    assert any("degrees to the" in note for note in done.figures["notes"])


def test_a_lidar_of_few_beams(localize: Localize, tmp_path: Path) -> None:
    def thinned(number: int, item: Item) -> Item:
        assert isinstance(item.value, np.ndarray)
        return replace(item, value=item.value[::3])

    bag = write_bag(tmp_path / "made.bag", changed(drive(SECONDS), "/scan", thinned))
    done = localize(bag, *at_start())
    assert done.is_at_the_end
    assert done.figures["shares"]["known"] > 0.95


def test_where_the_place_is_lost_for_most_of_a_drive_it_asks_for_the_right_map(
    localize: Localize, tmp_path: Path
) -> None:
    """After 4 s it is in a hall that the map does not have."""

    def elsewhere(_: int, item: Item) -> Item:
        seen = np.linspace(3.0, 9.0, 180) + np.arange(180) % 7 if item.stamp > BEGAN + 4.0 else None
        return item if seen is None else replace(item, value=seen)

    whole = drive(SECONDS)
    for items, is_asked in ((whole, False), (changed(whole, "/scan", elsewhere), True)):
        done = localize(write_bag(tmp_path / f"{is_asked}.bag", items), *at_start())
        notes = done.figures["notes"]
        assert any("is this the map of the drive" in note for note in notes) is is_asked


def test_it_says_where_and_why_a_robot_was_lost(localize: Localize, tmp_path: Path) -> None:
    """After 5 s it is slid by half of its circle, without lifting its wheels."""
    random = np.random.default_rng(2)

    def true(seconds: float) -> Pose:
        return pose_at(seconds + 8.0 if seconds > 5.0 else seconds)

    def slid(number: int, item: Item) -> Item:
        return replace(item, value=ranges_from(true(item.stamp - BEGAN), random))

    bag = write_bag(tmp_path / "made.bag", changed(drive(20.0), "/scan", slid))
    done = localize(bag, *at_start(), "--plot", tmp_path / "a.png")
    assert done.rows[-1]["state"] == "known"
    assert done.off(true) < 0.05
    [loss] = done.figures["losses"]
    assert 5.0 < loss["elapsed"] < 7.0
    here = pose_at(5.0)
    assert math.dist((loss["x"], loss["y"]), (here.x, here.y)) < 0.5
    assert "does not fit the map" in loss["reason"]
    assert "does not fit the map" in done.output


def test_wheels_that_hang_make_it_search(localize: Localize, tmp_path: Path) -> None:
    held = [
        Item("/wheel_drop", Lifted(6.0 < at < 8.0), BEGAN + at, BEGAN + at)
        for at in np.arange(0.03, SECONDS, 0.1).tolist()
    ]
    items = sorted([*drive(SECONDS), *held], key=lambda item: item.arrival)
    done = localize(write_bag(tmp_path / "made.bag", items), *at_start())
    [loss] = done.figures["losses"]
    assert loss["elapsed"] == pytest.approx(6.1, abs=0.2)
    assert loss["seconds"] > 1.8
    assert "wheels" in loss["reason"]


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        ("{bag} --start nan 0 0", 2, "expected finite numbers (m, rad), got 'nan'"),
        ("{bag} --start -inf 0 0", 2, "expected finite numbers (m, rad), got '-inf'"),
        ("{bag} --start -1e9 0 0", 2, "expected a place on the map, x -0.1 to 6.1"),
        ("{bag} --start 1 1", 2, "expected 3 arguments"),
        ("{bag} --plot drive.gif", 2, "ends with .png"),
        ("{bag} --output /no/such/folder/a.bag", 2, "--out: expected a file in a folder"),
        ("{bag} --trajectory /no/such/folder/a", 2, "--trajectory: expected a file in a folder"),
        ("{bag} --out {bag}", 2, "is the file of --bag already"),
        ("{bag} --out {link}", 2, "is the file of --bag already"),
        ("{bag} --colour red", 2, "unrecognized arguments"),
        ("no.bag", 1, "no.bag: no such file"),
        ("{bag} --odom /none", 1, "expected nav_msgs/Odometry on /none, there is none"),
    ],
)
def test_what_cannot_be_done_is_refused_in_a_line(
    localize: Localize, tmp_path: Path, words: str, status: int, said: str
) -> None:
    bag, link = write_bag(tmp_path / "made.bag", drive(1.0)), tmp_path / "link.bag"
    before = bag.read_bytes()
    link.symlink_to(bag)
    refused = localize(*words.format(bag=bag, link=link).split())
    assert refused.status == status
    assert refused.output == ""
    assert refused.error.startswith("./roomba localize: ")
    assert said in refused.error
    assert refused.error.count("\n") == 1
    assert bag.read_bytes() == before


def test_a_map_that_cannot_be_read_is_refused_in_a_line(localize: Localize, tmp_path: Path) -> None:
    bag, broken = write_bag(tmp_path / "made.bag", drive(1.0)), tmp_path / "broken.yaml"
    for text in ("image: [", "image: none.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"):
        broken.write_text(text, encoding="utf-8")
        refused = localize(bag, map_=broken)
        assert refused.status == 1
        assert str(broken) in refused.error
        assert refused.error.count("\n") == 1
    assert localize(bag, map_=tmp_path / "none.yaml").status == 1


def test_a_start_in_a_wall_is_told(localize: Localize, tmp_path: Path) -> None:
    done = localize(write_bag(tmp_path / "made.bag", drive(1.0)), "--start", 4.6, 2.9, 0)
    assert any("(4.6, 2.9) is not on free floor" in note for note in done.figures["notes"])


def test_figures_alone_go_to_standard_output(
    room: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(tmp_path / "made.bag", drive(3.0))
    words = ["--map", room, "--bag", bag, *at_start(), "--json", "--quiet"]
    assert main(list(map(str, words))) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["shares"]["known"] > 0.9
    assert told.err == ""
    assert main(list(map(str, words[:-1]))) == 0
    told = capsys.readouterr()
    assert "known" in told.err
    assert json.loads(told.out)["map"] == str(room)
