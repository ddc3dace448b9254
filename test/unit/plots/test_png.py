"""Pictures as PNG files."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from roomba.plots.png import write_png

PICTURE = np.zeros((2, 3, 3), np.uint8)
PICTURE[0, 1] = (250, 20, 3)


def test_a_picture_is_read_back_as_it_was_written(tmp_path: Path) -> None:
    write_png(tmp_path / "one.png", PICTURE)
    assert np.array_equal(cv2.imread(str(tmp_path / "one.png"))[:, :, ::-1], PICTURE)


def test_a_file_that_cannot_be_written_is_told_by_its_name(tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"nowhere/one\.png: cannot be written"):
        write_png(tmp_path / "nowhere" / "one.png", PICTURE)
