"""Truth, score, baseline and picture of the rooms' benchmark."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from roomba.files.occupancy_map import save_map
from roomba.grid import FREE, OCCUPIED, GridFrame, OccupancyMap
from roomba_bench.rooms.baseline import distance_split
from roomba_bench.rooms.furniture import furnished
from roomba_bench.rooms.picture import write_picture
from roomba_bench.rooms.truth import KnownRooms, known_homes, known_maps, score, without_specks


def two_rooms() -> KnownRooms:
    """Two rooms of 20 x 20 cells beside each other, and a door of 6 between them."""
    frame = GridFrame(0.1, 0.0, 0.0, 22, 43)
    values = np.full(frame.shape, OCCUPIED, np.int8)
    values[1:-1, 1:-1] = FREE
    values[:, 21] = OCCUPIED
    values[8:14, 21] = FREE
    labels = np.zeros(frame.shape, np.int32)
    labels[1:-1, 1:21], labels[1:-1, 22:-1] = 1, 2
    return KnownRooms("two rooms", OccupancyMap(frame, values), labels)


def test_the_truth_itself_is_perfect() -> None:
    known = two_rooms()
    found = score(known, known.labels)
    assert (found.recall, found.precision, found.segments, found.told_apart) == (1.0, 1.0, 2, 2)


def test_one_segment_for_all_costs_precision_and_halves_cost_recall() -> None:
    known = two_rooms()
    whole = score(known, (known.labels > 0).astype(np.int32))
    assert whole.recall == 1.0
    assert whole.precision == pytest.approx(0.5)
    assert (whole.segments, whole.told_apart) == (1, 0)
    halves = known.labels.copy()
    halves[11:] = np.where(halves[11:] > 0, halves[11:] + 2, 0)
    cut = score(known, halves)
    assert cut.recall == pytest.approx(0.5)
    assert cut.precision == 1.0
    assert (cut.segments, cut.told_apart) == (4, 0)


def test_only_free_cells_of_true_rooms_count() -> None:
    known = two_rooms()
    found = known.labels.copy()
    found[known.labels == 0] = 3
    known.map.values[2:6, 2:6] = OCCUPIED
    found[2:6, 2:6] = 2
    assert score(known, found).precision == 1.0
    nothing = score(known, np.zeros_like(found))
    assert (nothing.recall, nothing.precision, nothing.segments) == (0.0, 0.0, 0)


def test_the_baseline_parts_at_a_door() -> None:
    known = two_rooms()
    found = score(known, distance_split(known.map))
    assert found.told_apart == 2


def test_specks_of_a_drawing_are_no_rooms() -> None:
    white = np.zeros((30, 30), np.bool_)
    white[1:12, 1:12] = white[15:18, 2:4] = white[15:28, 10:25] = True
    labels = without_specks(white, 0.1)
    assert np.unique(labels).tolist() == [0, 1, 2]
    assert labels[16, 3] == 0


def test_drawn_rooms_are_read_beside_their_maps(tmp_path: Path) -> None:
    known = two_rooms()
    save_map(known.map, tmp_path / "house.yaml")
    save_map(known.map, tmp_path / "other.yaml")
    known.labels[1:3] = 0
    drawing = np.where(known.labels > 0, 254, 0).astype(np.uint8)[::-1]
    Image.fromarray(drawing).save(tmp_path / "house_rooms.png")
    [read] = known_maps(tmp_path)
    assert read.name == "house"
    assert np.array_equal(read.labels, known.labels)
    Image.fromarray(drawing[1:]).save(tmp_path / "house_rooms.png")
    with pytest.raises(ValueError, match="expected a picture of"):
        list(known_maps(tmp_path))


def test_rooms_may_have_a_grey_value_each_and_touch(tmp_path: Path) -> None:
    known = two_rooms()
    save_map(known.map, tmp_path / "house.yaml")
    known.labels[:, 21] = 2
    Image.fromarray((40 * known.labels).astype(np.uint8)[::-1]).save(tmp_path / "house_rooms.png")
    [read] = known_maps(tmp_path)
    assert np.array_equal(read.labels, known.labels)


def test_the_shipped_homes_have_rooms() -> None:
    counts = {known.name: known.count for known in known_homes()}
    assert counts["flat"] == 5
    assert counts["apartment"] == 6


def test_a_picture_has_a_panel_of_each(tmp_path: Path) -> None:
    known = two_rooms()
    whole = (known.labels > 0).astype(np.int32)
    write_picture(tmp_path / "new" / "two.png", known, {"ours": known.labels, "other": whole})
    with Image.open(tmp_path / "new" / "two.png") as picture:
        pixels = np.asarray(picture)
    panels = np.split(pixels, 3)
    assert np.array_equal(panels[0][18:], panels[1][18:])
    assert not np.array_equal(panels[0][18:], panels[2][18:])


def test_furniture_stands_in_rooms_and_not_in_doorways() -> None:
    known = two_rooms()
    more = furnished(known, 1)
    added = more.map.solid & ~known.map.solid
    assert added.any()
    assert known.labels[added].all()
    assert not added[8:14, 14:29].any()
    assert np.array_equal(more.map.values, furnished(known, 1).map.values)
    assert not np.array_equal(more.map.values, furnished(known, 2).map.values)
    assert not (known.map.solid & ~more.map.solid).any()
