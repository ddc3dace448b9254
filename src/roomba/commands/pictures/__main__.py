"""Makes the pictures of the documents: those of the README, and one of each sensor.

``./roomba pictures [FOLDER] [--only NAME ...]``; no ROS, no screen, the same pictures each time.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

import cv2
from PIL import Image

from roomba.commands.options import HelpfulParser
from roomba.commands.pictures.cleaning import picture_of_cleaning
from roomba.commands.pictures.household import picture_of_household
from roomba.commands.pictures.layers import picture_of_layers
from roomba.commands.pictures.localization import picture_of_localization, picture_of_relocation
from roomba.commands.pictures.mapping import picture_of_map_errors, picture_of_mapping
from roomba.commands.pictures.page import (
    frames_of_page,
    picture_of_phone,
    picture_of_replay,
    picture_of_report,
    picture_of_way,
)
from roomba.commands.pictures.rooms import picture_of_rooms
from roomba.commands.pictures.sensors.battery import picture_of_battery, picture_of_levels
from roomba.commands.pictures.sensors.bumper import picture_of_bumper
from roomba.commands.pictures.sensors.camera import picture_of_depth
from roomba.commands.pictures.sensors.dirt import picture_of_dirt
from roomba.commands.pictures.sensors.edge import picture_of_edge
from roomba.commands.pictures.sensors.faults import picture_of_faults
from roomba.commands.pictures.sensors.lidar import picture_of_lidar
from roomba.commands.pictures.sensors.motion import picture_of_motion
from roomba.commands.pictures.sensors.moving import picture_of_moving
from roomba.commands.pictures.sensors.odometry import picture_of_odometry
from roomba.commands.pictures.sensors.station import picture_of_station
from roomba.commands.pictures.smart_home import picture_of_smart_home
from roomba.commands.pictures.teaching.belief import picture_of_belief
from roomba.commands.pictures.teaching.bends import picture_of_bends
from roomba.commands.pictures.teaching.floor_plan import picture_of_floor_plan
from roomba.commands.pictures.teaching.loop import picture_of_loop_closing
from roomba.commands.pictures.teaching.matching import picture_of_matching
from roomba.commands.pictures.teaching.mirror import picture_of_a_mirror
from roomba.commands.pictures.teaching.paths import picture_of_paths
from roomba.commands.pictures.teaching.stages import picture_of_stages
from roomba.commands.pictures.teaching.things import picture_of_things
from roomba.commands.pictures.terminal import picture_of_top
from roomba.commands.pictures.tour import VIEWS, picture_of_home, picture_of_view, picture_of_walk
from roomba.commands.process_end import quiet_end
from roomba.commands.program_name import spelled
from roomba.errors import RoombaError
from roomba.files.shipped import HOMES
from roomba.plots.canvas import Picture
from roomba.plots.png import write_png
from roomba.world.home.home import Home
from roomba.world.layers.layer import load_home

_CHECKOUT = Path(__file__).parents[4] / "docs" / "pictures"
_DOCUMENTS = _CHECKOUT if _CHECKOUT.is_dir() else Path("pictures")
"""Where the documents have their pictures; without documents a folder of the current one."""

PICTURES: dict[str, tuple[str, Callable[[Home], Picture]]] = {
    "home": ("flat", picture_of_home),
    "bay": ("bay", picture_of_home),
    "walk": ("flat", picture_of_walk),
    **{name: ("flat", functools.partial(picture_of_view, pose=VIEWS[name])) for name in VIEWS},
    "lidar": ("flat", picture_of_lidar),
    "odometry": ("apartment", picture_of_odometry),
    "motion": ("apartment", picture_of_motion),
    "bumper": ("empty", picture_of_bumper),
    "edge": ("family", picture_of_edge),
    "station": ("flat", picture_of_station),
    "dirt": ("flat", picture_of_dirt),
    "battery": ("flat", picture_of_battery),
    "levels": ("flat", picture_of_levels),
    "moving": ("family", picture_of_moving),
    "depth": ("family", picture_of_depth),
    "faults": ("empty", picture_of_faults),
    "localization": ("flat", picture_of_localization),
    "relocation": ("empty", picture_of_relocation),
    "rooms": ("family", picture_of_rooms),
    "cleaning": ("flat", picture_of_cleaning),
    "mapping": ("flat", picture_of_mapping),
    "map_errors": ("flat", picture_of_map_errors),
    "layers": ("empty", picture_of_layers),
    "floor_plan": ("flat", picture_of_floor_plan),
    "matching": ("studio", picture_of_matching),
    "mirror": ("loft", picture_of_a_mirror),
    "belief": ("flat", picture_of_belief),
    "things": ("studio", picture_of_things),
    "stages": ("studio", picture_of_stages),
    "bends": ("empty", picture_of_bends),
    "paths": ("apartment", picture_of_paths),
    "loop_closing": ("empty", picture_of_loop_closing),
}
"""Each picture by the name of its file: the home that it is of, and what makes it."""
IN_BROWSER: dict[str, tuple[str, Callable[[Home], Picture]]] = {
    "household": ("flat", picture_of_household),
    "page_phone": ("flat", picture_of_phone),
    "page_way": ("flat", picture_of_way),
    "replay": ("flat", picture_of_replay),
    "report": ("flat", picture_of_report),
    "smart_home_map": ("flat", picture_of_smart_home),
    "top": ("flat", picture_of_top),
}
"""Pictures that need a browser, or a robot that lives meanwhile: made when they are named."""
FILMS: dict[str, tuple[str, Callable[[Home], list[Picture]]]] = {
    "page_animation": ("flat", frames_of_page),
}
"""Short films that need a browser: made when they are named."""
FRAME_TIME: Final = 120
"""ms that a frame of a film is seen."""
MOST_BYTES: Final = 2_000_000
"""Of a film."""
IN_RVIZ = "rviz"
"""The picture that ``./roomba`` lets :mod:`roomba_ros.model.picture` make, as it needs ROS."""


def main(arguments: list[str] | None = None) -> int:
    """Write all pictures; returns the exit status."""
    parser = HelpfulParser(prog=spelled("pictures"), description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=_DOCUMENTS)
    parser.add_argument(
        "--only",
        nargs="+",
        choices=[*PICTURES, *IN_BROWSER, *FILMS, IN_RVIZ],
        default=list(PICTURES),
    )
    wanted = parser.parse_args(arguments)
    try:
        if IN_RVIZ in wanted.only:
            raise RoombaError("that of RViz needs ROS: ./roomba pictures --only rviz, by itself")
        wanted.folder.mkdir(parents=True, exist_ok=True)
        for name in wanted.only:
            if name in FILMS:
                home, frames_of = FILMS[name]
                _write_film(wanted.folder / f"{name}.webp", frames_of(load_home(home, HOMES)))
                continue
            home, picture_of = (PICTURES | IN_BROWSER)[name]
            _write(wanted.folder / f"{name}.png", picture_of(load_home(home, HOMES)))
    except (RoombaError, OSError) as error:
        print(f"{spelled('pictures')}: {error}", file=sys.stderr)
        return 1
    return 0


def _write(path: Path, picture: Picture) -> None:
    write_png(path, picture, [cv2.IMWRITE_PNG_COMPRESSION, 9])
    print(path)


def _write_film(path: Path, frames: list[Picture]) -> None:
    """Write an animated WebP that goes on for ever; OSError if it is too large for a document."""
    first, *others = (Image.fromarray(frame) for frame in frames)
    first.save(
        path,
        save_all=True,
        append_images=others,
        duration=FRAME_TIME,
        loop=0,
        quality=70,
        method=4,
    )
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise OSError(f"{path}: expected a film of at most {MOST_BYTES} bytes, got {size}")
    print(path)


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
