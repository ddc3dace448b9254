"""``./roomba map --bag`` of made logs: table, files, progress, and what is refused."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from fixtures.drives.made_logs import (
    BEAMS,
    BEGAN,
    LASER,
    NO_ECHO,
    changed,
    drive,
    poor,
    pose_at,
    write_bag,
    write_bag_2,
    write_carmen,
)

from roomba.commands.map.drive.command import main
from roomba.commands.map.drive.options import options_of
from roomba.files.occupancy_map import load_map
from roomba.geometry import Pose

SECONDS = 20.0


def off(rows: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> float:
    """Return the largest distance of rows t, x, y, theta from the true way, m."""
    begin = pose_at(0.0).inverse()
    true = [begin.compose(pose_at(stamp - BEGAN)) for stamp in rows[:, 0].tolist()]
    return float(max(np.hypot(rows[:, 1] - [p.x for p in true], rows[:, 2] - [p.y for p in true])))


def test_all_that_is_asked_for_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = write_bag(tmp_path / "made.bag", drive(SECONDS))
    names = ("end.txt", "online.txt", "map.png", "map.json", "home")
    end, online, plot, figures, home = (tmp_path / name for name in names)
    words = ["--bag", bag, "--trajectory", end, "--online", online, "--plot", plot]
    assert main([*map(str, words), "--json", str(figures), "--out", str(home)]) == 0
    told = capsys.readouterr().out
    assert "100 used, " in told
    assert "0 refused" in told
    assert "300 messages: all in order" in told
    assert "180 beams over 179 degrees" in told
    values = json.loads(figures.read_text("utf-8"))
    assert values["scans"] == 100
    assert values["scans_refused"] == {}
    assert values["range_noise_m"] == pytest.approx(0.005, rel=0.4)
    assert values["latency_s"] == 0.0
    assert values["times_real_time"] == pytest.approx(values["seconds"] / values["core_seconds"])
    assert values["core_seconds"] <= 1.1 * values["processing_seconds"]
    for path in (end, online):
        rows = np.loadtxt(path)
        assert rows[:, 0] == pytest.approx(BEGAN + 0.2 * np.arange(100), abs=1e-5)
        assert off(rows) < 0.03
    assert cv2.imread(str(plot)) is not None
    assert load_map(home / "map.yaml").values.size > 1000


def test_a_bag_of_ros_2_and_a_log_make_the_same_map_as_a_bag(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    items = drive(SECONDS)
    paths = [
        write_bag(tmp_path / "made.bag", items),
        write_bag_2(tmp_path / "made", items),
        write_carmen(tmp_path / "made.log", items),
    ]
    ways = []
    for path in paths:
        words = ["--bag", str(path), "--quiet", "--trajectory", str(tmp_path / "end.txt")]
        assert main(words) == 0
        ways.append(np.loadtxt(tmp_path / "end.txt"))
    assert ways[1] == pytest.approx(ways[0], abs=1e-9)
    # A log has ranges to the centimetre, and odometry with the scans alone.
    assert np.abs(ways[2][:, 1:3] - ways[0][:, 1:3]).max() < 0.02
    assert capsys.readouterr().out == ""


def test_where_the_lidar_is_matters(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = write_bag(tmp_path / "made.bag", poor(drive(SECONDS)), with_mount=False)
    errors = []
    for mount in (f"{LASER.x},0,0", "-0.2,0,0"):
        end = str(tmp_path / "end.txt")
        assert main(["--bag", str(bag), "--laser", mount, "--trajectory", end]) == 0
        errors.append(off(np.loadtxt(end)))
    assert errors[0] < 0.05 < errors[1]
    assert "taken to be in the middle" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "hangs"), [("", None), (",upside-down", True), (", upright", False)]
)
def test_how_the_lidar_hangs_may_be_said(words: str, hangs: bool | None) -> None:
    wanted = options_of(["--bag", "made.bag", "--laser", f"0.1,-0.2,3{words}"]).wanted
    assert (wanted.laser, wanted.laser_is_upside_down) == (Pose(0.1, -0.2, 3.0), hangs)
    unsaid = options_of(["--bag", "made.bag"]).wanted
    assert (unsaid.laser, unsaid.laser_is_upside_down) == (None, None)


def test_poor_odometry_and_several_logs_are_corrected(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    items = poor(drive(SECONDS))
    half = len(items) // 2
    parts = [
        write_bag(tmp_path / f"{name}.bag", part)
        for name, part in (("b", items[half:]), ("a", items[:half]))
    ]
    assert main(["--bag", *map(str, parts), "--json", "--trajectory", str(tmp_path / "t")]) == 0
    values = json.loads(capsys.readouterr().out)
    assert off(np.loadtxt(tmp_path / "t")) < 0.05 < values["corrected_m"]
    assert values["logs"] == list(map(str, parts))


def test_what_was_not_used_is_told_with_the_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    items = changed(
        drive(SECONDS),
        "/scan",
        lambda n, item: replace(item, value=np.empty(0)) if n % 10 == 5 else item,
    )
    # A recording that was paused, but for a few scans, and went on.
    items = [i for i in items if not 4.0 < i.stamp - BEGAN < (9.0 if i.topic == "/odom" else 7.0)]
    assert main(["--bag", str(write_bag(tmp_path / "made.bag", items)), "--json"]) == 0
    refused = json.loads(capsys.readouterr().out)["scans_refused"]
    assert len(refused) == 2
    assert refused["scans of times without odometry"] in range(7, 11)
    assert [
        n for what, n in refused.items() if "cannot be used (expected a scan with beams" in what
    ] == [9]


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        ("--bag {log} --laser 1,2", 2, "expected three numbers X,Y,YAW"),
        ("--bag {log} --laser 0,0,nan", 2, "expected three numbers X,Y,YAW"),
        ("--bag {log} --laser 1e6,0,0", 2, "at most 10 m from the robot's middle"),
        ("--bag {log} --laser 0,0,90", 2, "at most 6.29 rad"),
        ("--bag {log} --laser 0,0,0,over", 2, "at most one of upside-down or upright after them"),
        ("--bag {log} --laser upside-down", 2, "expected three numbers X,Y,YAW"),
        ("--bag {log} --trajectory no/folder/a.txt", 2, "--trajectory: expected a file in a"),
        ("--bag {log} --scan /none", 1, "expected sensor_msgs/LaserScan on /none, there is none"),
        ("--bag {log} {log}.relations", 1, "the truth that maps are judged by"),
    ],
)
def test_what_cannot_be_used_is_refused_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: str, status: int, said: str
) -> None:
    log = write_bag(tmp_path / "made.bag", drive(1.0))
    (tmp_path / "made.bag.relations").write_text("1.0 2.0 0.1 0 0 0 0 0.1\n", "utf-8")
    assert main(words.format(log=log).split()) == status
    told = capsys.readouterr()
    assert told.out == ""
    assert said in told.err
    assert told.err.count("\n") == 1


def test_a_drive_without_odometry_goes_by_its_scans_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scans = [item for item in drive(SECONDS) if item.topic == "/scan"]
    end = tmp_path / "end.txt"
    bag = write_bag(tmp_path / "made.bag", scans)
    assert main(["--bag", str(bag), "--trajectory", str(end)]) == 0
    rows = np.loadtxt(end)
    assert len(rows) == len(scans)
    assert off(rows) < 0.05
    assert "no odometry was recorded: it goes by scans alone" in capsys.readouterr().out


def test_odometry_that_is_no_number_is_left_out_and_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = Pose(math.nan, 0.0, 0.0)
    items = changed(
        drive(SECONDS),
        "/odom",
        lambda n, item: replace(item, value=bad) if n % 7 == 3 else item,
    )
    end = tmp_path / "end.txt"
    bag = write_bag(tmp_path / "made.bag", items)
    assert main(["--bag", str(bag), "--trajectory", str(end)]) == 0
    assert off(np.loadtxt(end)) < 0.03
    assert "29 messages of odometry" in " ".join(capsys.readouterr().out.split())


def test_a_single_scan_is_a_map_already(tmp_path: Path) -> None:
    items = drive(0.2)
    assert sum(item.topic == "/scan" for item in items) == 1
    bag, home = write_bag(tmp_path / "made.bag", items), tmp_path / "home"
    assert main(["--bag", str(bag), "--out", str(home), "--quiet"]) == 0
    assert load_map(home / "map.yaml").free_area > 5.0


def test_scans_without_an_echo_are_refused_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    blind = np.full(BEAMS, NO_ECHO)
    items = changed(drive(2.0), "/scan", lambda n, item: replace(item, value=blind))
    assert main(["--bag", str(write_bag(tmp_path / "made.bag", items))]) == 1
    told = capsys.readouterr()
    assert "expected scans that show walls, got 10 with hardly anything in sight" in told.err
    assert (told.out, told.err.count("\n")) == ("", 1)
