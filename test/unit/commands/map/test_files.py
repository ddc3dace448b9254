"""The files of a map: a map with too many rooms is written without rooms."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.robots.located import TWO_ROOMS

from roomba.commands.map.files import write_files
from roomba.files import plain_yaml
from roomba.geometry import Pose
from roomba.storage.map_folder import read_map


def test_a_map_is_written_with_its_rooms(tmp_path: Path) -> None:
    write_files(tmp_path / "new", TWO_ROOMS.map, Pose(1.0, 1.0, 0.0))
    stored = read_map(tmp_path / "new")
    assert stored.station == Pose(1.0, 1.0, 0.0)
    assert stored.rooms is not None
    assert len(stored.rooms.names) == 2


def test_a_map_with_more_rooms_than_a_file_may_hold_is_written_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of a large map, which was torn to pieces, have half a million corners."""
    monkeypatch.setattr(plain_yaml, "MOST_VALUES", 30)
    write_files(tmp_path / "new", TWO_ROOMS.map, Pose(1.0, 1.0, 0.0))
    stored = read_map(tmp_path / "new")
    assert stored.rooms is None
    assert (stored.occupancy.values == TWO_ROOMS.map.values).all()
