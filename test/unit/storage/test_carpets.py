"""The carpets that were felt, kept beside a map."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from roomba.files.kept import unsealed
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.storage.carpets import CarpetsError, load_carpets, save_carpets

FLOOR = OccupancyMap(GridFrame(0.05, -1.0, 2.0, 40, 60), np.zeros((40, 60), np.int8))
CARPETS = FeltCarpets(
    (((0.1, 2.2), (0.9, 2.2), (0.9, 3.0), (0.1, 3.0)), ((1.5, 2.5), (1.9, 2.5), (1.9, 2.9)))
)


def test_they_come_back_as_they_were(tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "carpets.yaml"
    save_carpets(CARPETS, FLOOR, path)
    assert load_carpets(path, FLOOR) == CARPETS
    save_carpets(FeltCarpets(), FLOOR, path)
    assert load_carpets(path, FLOOR) == FeltCarpets()
    assert load_carpets(tmp_path / "none.yaml", FLOOR) == FeltCarpets()


def test_a_damaged_file_is_set_aside_for_the_one_before(tmp_path: Path) -> None:
    path, told = tmp_path / "carpets.yaml", list[str]()
    save_carpets(CARPETS, FLOOR, path)
    save_carpets(FeltCarpets(), FLOOR, path)
    path.write_bytes(path.read_bytes()[:-9])
    assert load_carpets(path, FLOOR, told.append) == CARPETS
    assert len(told) == 1


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("[1.5, 2.5], [1.9, 2.5], ", "[1.5, 2.5], ", r"carpets\.1\.corners"),
        ("[0.9, 2.2], [0.9, 3.0]", "[0.9, 3.0], [0.9, 2.2]", "does not cross itself"),
        ("[0.1, 2.2]", "[0.1, .nan]", r"carpets\.0\.corners"),
        ("[0.1, 2.2]", "[0.1]", r"carpets\.0\.corners"),
        ("carpets:", "rugs:", "carpets: Field required"),
    ],
)
def test_a_file_that_makes_no_sense_is_named_with_the_reason(
    tmp_path: Path, old: str, new: str, reason: str
) -> None:
    path = tmp_path / "carpets.yaml"
    save_carpets(CARPETS, FLOOR, path)
    text = unsealed(path.read_bytes()).decode("utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(CarpetsError, match=reason) as error:
        load_carpets(path, FLOOR)
    assert str(path) in str(error.value)
