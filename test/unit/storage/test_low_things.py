"""What was felt and never seen, kept beside a map."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from roomba.files.kept import unsealed
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.rooms.low_things import LowThing, LowThings
from roomba.storage.low_things import LowThingsError, load_low_things, save_low_things

FLOOR = OccupancyMap(GridFrame(0.05, -1.0, 2.0, 40, 60), np.zeros((40, 60), np.int8))
THINGS = LowThings(
    (LowThing(0.1, 2.2, 0.6, 2.3, 4), LowThing(1.0, 3.0, 1.0, 3.0, 2, is_ignored=True))
)


def test_they_come_back_as_they_were(tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "low_things.yaml"
    save_low_things(THINGS, FLOOR, path)
    assert load_low_things(path, FLOOR) == THINGS
    save_low_things(LowThings(), FLOOR, path)
    assert load_low_things(path, FLOOR) == LowThings()
    assert load_low_things(tmp_path / "none.yaml", FLOOR) == LowThings()


def test_a_damaged_file_is_set_aside_for_the_one_before(tmp_path: Path) -> None:
    path, told = tmp_path / "low_things.yaml", list[str]()
    save_low_things(THINGS, FLOOR, path)
    save_low_things(LowThings(), FLOOR, path)
    path.write_bytes(path.read_bytes()[:-9])
    assert load_low_things(path, FLOOR, told.append) == THINGS
    assert len(told) == 1


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ('"times": 4', '"times": 0', r"low_things\.0\.times"),
        ('"times": 4', '"times": 4.5', r"low_things\.0\.times"),
        ("[0.1, 2.2, 0.6, 2.3]", "[0.1, 2.2, 0.6]", r"low_things\.0\.area"),
        ("[0.1, 2.2, 0.6, 2.3]", "[0.1, 2.2, 0.6, .nan]", r"low_things\.0\.area"),
        ("low_things:", "things:", "low_things: Field required"),
    ],
)
def test_a_file_that_makes_no_sense_is_named_with_the_reason(
    tmp_path: Path, old: str, new: str, reason: str
) -> None:
    path = tmp_path / "low_things.yaml"
    save_low_things(THINGS, FLOOR, path)
    text = unsealed(path.read_bytes()).decode("utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(LowThingsError, match=reason) as error:
        load_low_things(path, FLOOR)
    assert str(path) in str(error.value)


def test_those_of_another_map_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "low_things.yaml"
    save_low_things(THINGS, FLOOR, path)
    other = OccupancyMap(FLOOR.frame, np.ones((40, 60), np.int8))
    with pytest.raises(LowThingsError, match="expected the low things of this map"):
        load_low_things(path, other)
