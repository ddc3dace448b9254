"""The topic of recorded drives, on made logs."""

from __future__ import annotations

import lzma
import math
from pathlib import Path

import numpy as np
import pytest
from fixtures.drives.made_logs import (
    BEGAN,
    drive,
    poor,
    pose_at,
    room_map,
    write_bag,
    write_bag_2,
    write_carmen,
)
from PIL import Image

from roomba.files.occupancy_map import save_map
from roomba.grid import OCCUPIED
from roomba_bench import __main__ as command
from roomba_bench.bench import Bench
from roomba_bench.record import Record
from roomba_bench.rounds import QUICK
from roomba_bench.slam.localized import Followed, coarsened, square_of
from roomba_bench.slam.peers import aims_of, peers_of
from roomba_bench.topics.slam import measure, measured

SECONDS = 12.0


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a packed bag that has relations, a log without, a broken one, other files."""
    folder = tmp_path_factory.mktemp("logs")
    items = poor(drive(SECONDS))
    plain = write_bag(folder / "intel_made.bag", items)
    (folder / "intel_made.bag.xz").write_bytes(lzma.compress(plain.read_bytes(), preset=0))
    plain.unlink()
    lines = []
    for first, second in ((0.0, 2.0), (1.0, 9.0), (3.0, 11.0), (0.0, 999.0)):
        step = pose_at(first).inverse().compose(pose_at(second))
        lines.append(f"{BEGAN + first} {BEGAN + second} {step.x} {step.y} 0 0 0 {step.theta}\n")
    (folder / "intel_made.relations.xz").write_bytes(lzma.compress("".join(lines).encode()))
    write_carmen(folder / "text.log", items)
    write_bag_2(folder / "second", items)
    (folder / "broken.bag").write_bytes(b"#ROSBAG V2.0\n" + bytes(200))
    (folder / "README.md").write_text("not a log\n", "utf-8")
    (folder / "map.yaml").write_text("image: none\n", "utf-8")
    save_map(room_map(), folder / "intel_map.yaml")
    return folder


@pytest.fixture(scope="module")
def done(logs: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Record], Path]:
    """The rows of the folder, and the folder of pictures."""
    pictures = tmp_path_factory.mktemp("pictures")
    return measured(Bench(QUICK, pictures, logs=logs), logs, pictures), pictures


def of(records: list[Record], case: str) -> dict[str, Record]:
    return {record.figure: record for record in records if record.case == case}


def test_each_log_has_its_rows_and_nothing_else_is_one(
    done: tuple[list[Record], Path],
) -> None:
    records, _ = done
    assert list(dict.fromkeys(record.case.partition(",")[0] for record in records)) == [
        "broken",
        "intel_made",
        "second",
        "text",
    ]
    for case in ("intel_made", "second", "text"):
        rows = of(records, case)
        assert rows["times real time"].aim == 100.0
        assert 0.0 <= (rows["scans that fitted nothing seen before"].value or 0.0) < 30.0


def test_errors_are_those_of_the_relations_beside_published_ones(
    done: tuple[list[Record], Path],
) -> None:
    rows = of(done[0], "intel_made")
    mean = rows["translation error, mean, of 3 relations"]
    assert mean.value is not None
    assert mean.value < 0.02
    assert mean.aim == 0.023
    peers = {peer.name: peer.value for peer in mean.peers}
    assert peers["Cartographer 2016"] == 0.0229
    assert peers["odometry alone"] is not None
    assert peers["odometry alone"] > 3.0 * mean.value
    deviation = rows["translation error, deviation, of 3 relations"]
    assert [peer.name for peer in deviation.peers][1:] == [
        "gmapping, 30 particles",
        "Karto",
        "Cartographer 2016",
    ]
    largest = rows["translation error, largest, of 3 relations"]
    assert largest.value is not None
    assert mean.value <= largest.value < 0.03
    assert largest.aim == 0.10
    turn = rows["rotation error, mean, of 3 relations"]
    assert turn.unit == "degrees"
    assert turn.aim == 0.45
    assert turn.value is not None
    assert turn.value < math.degrees(0.01)


def test_without_relations_there_are_no_errors(done: tuple[list[Record], Path]) -> None:
    assert not [figure for figure in of(done[0], "text") if "error" in figure]


def test_a_log_that_cannot_be_read_is_a_row_with_the_reason(
    done: tuple[list[Record], Path],
) -> None:
    [row] = of(done[0], "broken").values()
    assert row.value is None
    assert "expected a whole bag, it cannot be opened" in row.error


@pytest.mark.parametrize("cells", ["5 cm cells", "10 cm cells"])
@pytest.mark.parametrize("start", ["a given start", "no start"])
def test_each_drive_is_followed_on_its_own_map_beside_others(
    done: tuple[list[Record], Path], cells: str, start: str
) -> None:
    rows = of(done[0], f"intel_made, on its own map, {cells}, from {start}")
    median, far = rows["error of the place, median"], rows["poses more than 0.5 m off"]
    assert median.value is not None
    assert median.value < (0.02 if cells == "5 cm cells" else 0.05)
    assert (far.value, far.aim) == (0.0, 0.0)
    assert [peer.value for peer in far.peers] == [92.0, 0.0]
    held = rows["errors in the region that should hold 95 %"]
    assert held.value is not None
    assert held.value > 85.0
    found = rows["way until its place was known"].value
    assert found is not None
    assert found < 2.0


def test_a_map_of_another_day_beside_a_log_is_known_by_its_name(
    done: tuple[list[Record], Path],
) -> None:
    rows = of(done[0], "intel_made, on intel_map, from no start")
    found = rows["way until its place was known"]
    assert found.value is not None
    assert found.value < 2.0
    assert found.aim == 40.0
    at_walls = rows["beams of the last scans within 0.2 m of walls"].value
    assert at_walls is not None
    assert at_walls > 95.0


def test_regions_hold_the_share_of_errors_that_they_are_drawn_for() -> None:
    off = np.random.default_rng(1).standard_normal((20_000, 2))
    squares = (off**2).sum(axis=1)
    for share in (0.1, 0.5, 0.95):
        assert np.mean(squares < square_of(share)) == pytest.approx(share, abs=0.01)
        each = Followed("5 cm cells", True, np.sqrt(squares), squares, 0.0)
    assert each.held == pytest.approx(0.95, abs=0.01)


def test_a_coarse_map_has_every_wall_of_the_fine_one() -> None:
    fine = room_map()
    coarse = coarsened(fine, 3)
    assert coarse.frame.resolution == pytest.approx(0.15)
    rows, columns = np.nonzero(fine.values == OCCUPIED)
    assert (coarse.values[rows // 3, columns // 3] == OCCUPIED).all()
    assert (coarse.values == OCCUPIED).sum() < len(rows) / 3


def test_each_map_has_a_small_picture(done: tuple[list[Record], Path]) -> None:
    _, pictures = done
    names = sorted(path.name for path in pictures.glob("slam-*.png"))
    assert names == [
        "slam-covariances.png",
        "slam-intel_made.png",
        "slam-second.png",
        "slam-text.png",
    ]
    for name in names[1:]:
        assert (pictures / name).stat().st_size < 100_000
        assert max(Image.open(pictures / name).size) in range(900, 930)


def test_without_a_folder_nothing_is_measured_and_that_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert measure(Bench(QUICK, tmp_path)) == []
    assert "--logs FOLDER" in capsys.readouterr().err


def test_a_folder_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        command.main(["slam", "--logs", str(tmp_path / "none")])
    assert "--logs: expected a folder of recorded drives" in capsys.readouterr().err


def test_others_are_known_by_a_word_of_the_name() -> None:
    assert peers_of("Intel_Dense") == peers_of("intel")
    assert next(peer.name for peer in peers_of("aces3")) == "Cartographer 2016"
    assert peers_of("kitchen") == ()
    assert aims_of("kitchen").translation is None
