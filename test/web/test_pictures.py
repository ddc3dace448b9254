"""The pictures of the page are made by the command."""

from __future__ import annotations

from pathlib import Path

import cv2

from roomba.commands.pictures.__main__ import main


def test_the_page_is_drawn_in_both_sizes(tmp_path: Path) -> None:
    assert main([str(tmp_path), "--only", "page", "page_phone"]) == 0
    for name, width in (("page", 1280), ("page_phone", 390)):
        picture = cv2.imread(str(tmp_path / f"{name}.png"))
        assert picture is not None
        assert picture.shape[1] == width
        assert len({tuple(colour) for colour in picture[::7, ::7].reshape(-1, 3)}) > 20
