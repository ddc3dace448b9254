"""Pictures of floor plans in the kinds that drawing programs save."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from roomba.errors import HomeError
from roomba.files.image import read_image

GREYS = np.array([[0, 51, 255]], np.uint8)


@pytest.mark.parametrize("mode", ["L", "P", "RGB", "RGBA", "LA"])
def test_grey_is_the_same_in_every_mode(tmp_path: Path, mode: str) -> None:
    Image.fromarray(GREYS).convert(mode).save(tmp_path / "plan.png")
    image = read_image(tmp_path / "plan.png")
    assert image.grey.tolist() == [[0.0, 51.0, 255.0]]
    assert not image.transparent.any()


def test_two_colours_are_black_and_white(tmp_path: Path) -> None:
    Image.fromarray(GREYS > 0).save(tmp_path / "plan.png")
    assert read_image(tmp_path / "plan.png").grey.tolist() == [[0.0, 255.0, 255.0]]


def test_sixteen_bits_are_scaled(tmp_path: Path) -> None:
    Image.fromarray(GREYS.astype(np.uint16) * 257).save(tmp_path / "plan.png")
    assert read_image(tmp_path / "plan.png").grey == pytest.approx(GREYS)


@pytest.mark.parametrize("white", [1, 100, 127, 254, 255])
def test_greys_of_another_white_are_those_of_sdl_image(tmp_path: Path, white: int) -> None:
    """They are ``value * 255 / white`` in whole numbers (``IMG_pnm.c``)."""
    values = range(white + 1)
    head = f"P5\n# white is {white}\n{len(values)} 1\n{white}\n"
    (tmp_path / "plan.pgm").write_bytes(head.encode() + bytes(values))
    expected = [float(value * 255 // white) for value in values]
    assert read_image(tmp_path / "plan.pgm").grey.tolist() == [expected]


def test_a_clear_colour_of_a_palette_is_transparent(tmp_path: Path) -> None:
    Image.fromarray(GREYS).convert("P").save(tmp_path / "plan.png", transparency=51)
    assert read_image(tmp_path / "plan.png").transparent.tolist() == [[False, True, False]]


def test_greys_of_more_than_sixteen_bits_are_refused(tmp_path: Path) -> None:
    Image.fromarray(GREYS.astype(np.float32)).save(tmp_path / "plan.tiff")
    with pytest.raises(HomeError, match=r"PGM or PNG.*16 bits"):
        read_image(tmp_path / "plan.tiff")


def test_broken_pixels_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "plan.png"
    Image.fromarray(np.arange(256, dtype=np.uint8).reshape(16, 16)).save(path)
    content = bytearray(path.read_bytes())
    content[60:70] = bytes(10)
    path.write_bytes(content)
    with pytest.raises(HomeError, match="PGM or PNG"):
        read_image(path)


def test_a_pointer_of_git_lfs_is_told_by_its_name(tmp_path: Path) -> None:
    path = tmp_path / "plan.pgm"
    path.write_text("version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n")
    with pytest.raises(HomeError, match=r"got a pointer of Git LFS.*git lfs pull"):
        read_image(path)


def test_what_is_no_picture_is_refused_without_words_of_the_program(tmp_path: Path) -> None:
    path = tmp_path / "plan.pgm"
    path.write_text("Once upon a time")
    with pytest.raises(HomeError) as refused:
        read_image(path)
    assert str(refused.value) == (
        f"{path}: expected a PGM or PNG picture, got something else; convert it"
    )
