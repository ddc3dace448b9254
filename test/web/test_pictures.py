"""The pictures of the page are made by the command."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import cv2


def test_the_page_is_drawn_in_both_sizes(tmp_path: Path) -> None:
    command = (sys.executable, "-m", "roomba.commands.pictures", str(tmp_path))
    subprocess.run((*command, "--only", "page", "page_phone"), check=True, timeout=240.0)
    for name, width in (("page", 1280), ("page_phone", 390)):
        picture = cv2.imread(str(tmp_path / f"{name}.png"))
        assert picture is not None
        assert picture.shape[1] == width
        assert len({tuple(colour) for colour in picture[::7, ::7].reshape(-1, 3)}) > 20
