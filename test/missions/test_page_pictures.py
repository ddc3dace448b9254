"""The pictures of the page are made by the command."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import cv2
from PIL import Image


def test_the_page_is_drawn_in_both_sizes_and_a_report(tmp_path: Path) -> None:
    command = (sys.executable, "-m", "roomba.commands.pictures", str(tmp_path))
    wanted = {
        "page_phone": 390,
        "page_way": 3 * 390 + 2 * 24,
        "replay": 1280,
        "report": 1100,
        "top": 1200,
    }
    subprocess.run((*command, "--only", *wanted), check=True, timeout=300.0)
    for name, width in wanted.items():
        picture = cv2.imread(str(tmp_path / f"{name}.png"))
        assert picture is not None
        assert picture.shape[1] == width
        assert len({tuple(colour) for colour in picture[::7, ::7].reshape(-1, 3)}) > 20


def test_a_short_film_shows_the_robot_clean(tmp_path: Path) -> None:
    command = (sys.executable, "-m", "roomba.commands.pictures", str(tmp_path))
    subprocess.run((*command, "--only", "page_animation"), check=True, timeout=300.0)
    file = tmp_path / "page_animation.webp"
    assert file.stat().st_size <= 2_000_000
    with Image.open(file) as film:
        frames = getattr(film, "n_frames", 1)
        assert frames > 20
        seen = []
        for number in (0, frames // 2, frames - 1):
            film.seek(number)
            seen.append(film.convert("RGB").tobytes())
    assert len(set(seen)) == 3
