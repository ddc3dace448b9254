"""Pictures as PNG files."""

from __future__ import annotations

import io
import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from roomba.plots.png import write_png

PICTURE = np.zeros((2, 3, 3), np.uint8)
PICTURE[0, 1] = (250, 20, 3)


@pytest.mark.parametrize("name", [b"one.png", b"K\xfcche.png"], ids=["plain", "no UTF-8"])
def test_a_picture_is_read_back_as_it_was_written(tmp_path: Path, name: bytes) -> None:
    path = tmp_path / os.fsdecode(name)
    write_png(path, PICTURE)
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(path.read_bytes()))), PICTURE)


def test_a_file_that_cannot_be_written_is_told_by_its_name(tmp_path: Path) -> None:
    with pytest.raises(OSError, match=r"nowhere/one\.png: cannot be written"):
        write_png(tmp_path / "nowhere" / "one.png", PICTURE)
    assert not (tmp_path / "nowhere").exists()
