"""Lets a made-up robot that people own clean by its plan, and records it for the documents.

``./roomba exec python -m roomba.commands.demonstration neato``: in real time, half an hour or so.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from roomba.commands.demonstration.course import SHOWN, Demonstration, Seen
from roomba.commands.demonstration.film import frames_of
from roomba.commands.demonstration.table import table_of, troubles_of
from roomba.commands.options import HelpfulParser
from roomba.errors import RoombaError
from roomba.plots.canvas import Picture

PROGRAM: Final = "demonstration"
_PICTURES: Final = Path(__file__).parents[4] / "docs" / "pictures"
_COLOURS: Final = 128
"""Of a picture of the page: few, since it is a document's."""
_FRAME: Final = 200
"""ms that a frame of the film is seen."""
_EACH: Final = 20.0
"""s of the clean between two frames."""
_SMALLER: Final = 2.0 / 3.0
"""Size of a frame as a factor of the smart home's picture."""
_QUALITY: Final = 40
"""0 to 100, of WebP: enough for lines and areas."""
_GAP: Final = 12
"""px between two pictures of the page."""


def main(arguments: list[str] | None = None) -> int:
    """Show a robot, and write what was seen; returns the exit status."""
    parser = HelpfulParser(prog=PROGRAM, description=__doc__)
    parser.add_argument("robot", choices=sorted(SHOWN))
    parser.add_argument("--home", default="studio", help="where it lives (default: studio)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=_PICTURES, help="a folder for the pictures")
    wanted = parser.parse_args(arguments)
    began = time.monotonic()

    def tell(text: str) -> None:
        print(f"{time.monotonic() - began:7.1f} s  {text}", flush=True)

    try:
        with tempfile.TemporaryDirectory() as folder:
            seen = Demonstration(SHOWN[wanted.robot], Path(folder), tell).run(
                wanted.home, wanted.seed
            )
        wanted.out.mkdir(parents=True, exist_ok=True)
        for path in written(seen, wanted.out, f"demonstration_{wanted.robot}"):
            print(path)
    except (RoombaError, OSError) as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 1
    return 0


def written(seen: Seen, folder: Path, name: str) -> list[Path]:
    """Write pictures, film and table of what was seen; return the files."""
    table = folder / f"{name}.md"
    table.write_text(text_of(seen), "utf-8")
    page = folder / f"{name}.png"
    _write_picture(tiled(seen.pages), page)
    files = [table, page]
    if seen.report is not None:
        files.append(folder / f"{name}_report.png")
        _write_picture(seen.report, files[-1])
    if seen.maps:
        files.append(folder / f"{name}_map.webp")
        _write_film(frames_of(seen.maps, _EACH), files[-1])
    return files


def text_of(seen: Seen) -> str:
    """Return a text: the table of the clean, the run's figures and the plan's notes."""
    said = table_of(seen.states, seen.said, seen.due.timestamp())
    run = "\n".join(f"- {key}: {value}" for key, value in seen.run.items())
    notes = "\n".join(f"- {note['at']} {note['plan']}: {note['text']}" for note in seen.notes)
    troubles = troubles_of(seen.states)
    heard = f"{len(seen.states)} states, {len(seen.maps)} maps"
    return f"{said}\n{troubles}\n{run}\n\n{notes}\n\n{heard}\n"


def tiled(pages: list[Picture]) -> Picture:
    """Return four pictures of one size as two rows."""
    height, width, _ = pages[0].shape
    paper = np.full((2 * height + _GAP, 2 * width + _GAP, 3), 255, np.uint8)
    for number, page in enumerate(pages):
        down, across = divmod(number, 2)
        top, left = down * (height + _GAP), across * (width + _GAP)
        paper[top : top + height, left : left + width] = page
    return paper


def _write_picture(picture: Picture, path: Path) -> None:
    Image.fromarray(picture).quantize(_COLOURS).save(path, "PNG", optimize=True)


def _write_film(frames: list[Picture], path: Path) -> None:
    images = [Image.fromarray(frame) for frame in frames]
    width, height = (round(_SMALLER * side) for side in images[0].size)
    first, *others = (image.resize((width, height)) for image in images)
    first.save(
        path,
        save_all=True,
        append_images=others,
        duration=_FRAME,
        loop=0,
        quality=_QUALITY,
        method=6,
    )
