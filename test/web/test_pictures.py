"""The pictures of the page are made by the command."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import cv2


def test_the_page_is_drawn_in_both_sizes_and_a_report(tmp_path: Path) -> None:
    command = (sys.executable, "-m", "roomba.commands.pictures", str(tmp_path))
    wanted = {"page": 1280, "page_phone": 390, "replay": 1280, "report": 1100}
    subprocess.run((*command, "--only", *wanted), check=True, timeout=300.0)
    for name, width in wanted.items():
        picture = cv2.imread(str(tmp_path / f"{name}.png"))
        assert picture is not None
        assert picture.shape[1] == width
        assert len({tuple(colour) for colour in picture[::7, ::7].reshape(-1, 3)}) > 20
