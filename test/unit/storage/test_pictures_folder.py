import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.errors import PictureError
from roomba.storage.pictures_folder import ANGLES, PictureFolder, nearest_angle

PICTURE = np.random.default_rng(1).integers(0, 255, (48, 64, 3), np.uint8)


@given(st.floats(-180.0, 180.0))
def test_the_nearest_angle_is_nearer_than_every_other(degrees: float) -> None:
    chosen = nearest_angle(degrees)
    assert all(abs(chosen - degrees) <= abs(angle - degrees) for angle in ANGLES)


@pytest.mark.parametrize("degrees", [math.nan, math.inf, -math.inf, 1e30, 180.1])
def test_what_is_no_angle_is_refused(degrees: float) -> None:
    with pytest.raises(PictureError, match="expected an angle from -180 to 180"):
        nearest_angle(degrees)


def test_what_was_written_is_read_and_nothing_unfinished_stays(tmp_path: Path) -> None:
    folder = PictureFolder(tmp_path / "a" / "Images")
    assert not folder.has(15)
    folder.write(15, PICTURE)
    assert folder.has(15)
    assert np.array_equal(folder.read(15), PICTURE)
    assert [path.name for path in folder.folder.iterdir()] == ["15.png"]


def test_the_old_picture_stays_when_the_new_one_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = PictureFolder(tmp_path)
    folder.write(0, PICTURE)

    def full_disk(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full_disk)
    with pytest.raises(PictureError, match=r"0\.png: cannot be written: No space left"):
        folder.write(0, np.invert(PICTURE))
    assert np.array_equal(folder.read(0), PICTURE)


@pytest.mark.parametrize("content", [b"", b"not a picture", b"\x89PNG\r\n\x1a\nbroken"])
def test_a_corrupt_file_is_named(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "30.png").write_bytes(content)
    with pytest.raises(PictureError, match=r"30\.png"):
        PictureFolder(tmp_path).read(30)


def test_a_picture_cut_short_is_named(tmp_path: Path) -> None:
    folder = PictureFolder(tmp_path)
    folder.write(30, PICTURE)
    whole = folder.path(30).read_bytes()
    folder.path(30).write_bytes(whole[: len(whole) // 2])
    with pytest.raises(PictureError, match=r"30\.png"):
        folder.read(30)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(PictureError, match=r"-15\.png: cannot be read"):
        PictureFolder(tmp_path).read(-15)
