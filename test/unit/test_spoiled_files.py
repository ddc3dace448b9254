"""Whatever a file holds, its reader takes it or raises its own error, soon, and in bounded memory.

``ROOMBA_EXAMPLES=5000`` tries so many files of each kind, others each time.
"""

from __future__ import annotations

import functools
import io
import json
import os
import resource
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import PIL.Image
import pytest
import shapely
from fixtures.drives.made_logs import drive, write_bag, write_bag_2, write_carmen
from fixtures.homes.rooms import room_home
from fixtures.spoiled import spoiled
from hypothesis import HealthCheck, given, settings
from rosbags.rosbag2 import StoragePlugin

from roomba.client.protocol import MissedFloor
from roomba.configuration.frozen import load_config
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.errors import ConfigError, HomeError, RoomsError
from roomba.files.home_layer import read_layer
from roomba.files.kept import unsealed
from roomba.files.occupancy_map import load_map, save_map
from roomba.files.shipped import HOMES
from roomba.files.valetudo import ValetudoError, ValetudoHome, compose, parse
from roomba.geometry import Pose
from roomba.history.run import TRACE, CellLayer, RunFigures, RunRecording, RunSource, Word
from roomba.history.run_file import RunFileError, packed, unpacked
from roomba.perception.calibration.calibration import Calibration
from roomba.perception.matching.mounts import Mount
from roomba.perception.rooms.rooms import Rooms
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones, ZonesError
from roomba.recordings.opening import open_log
from roomba.recordings.readings import LogError
from roomba.storage.calibration import CalibrationError, load_calibration, save_calibration
from roomba.storage.checkpoint import (
    Checkpoint,
    CheckpointFileError,
    load_checkpoint,
    load_dirt,
    save_checkpoint,
    save_dirt,
)
from roomba.storage.rooms import load_rooms, save_rooms
from roomba.storage.zones import load_zones, save_zones

MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
FUZZ: Final = settings(
    max_examples=MORE or 40,
    derandomize=not MORE,
    deadline=None,
    database=None,
    suppress_health_check=list(HealthCheck),
)
SOON: Final = 5.0
"""s of processor time; the largest file that is read takes about one."""
MEMORY: Final = 1_500_000_000
"""Bytes by which the process may grow over all files."""
HOME: Final = room_home()
PGM: Final = b"P5\n3 2\n255\n\0\xfe\xcd\0\0\0"
FLOOR: Final = HOME.map


class Kind(NamedTuple):
    """A kind of file: its name, one that is whole, its reader, and what that may raise."""

    name: str
    whole: Callable[[], bytes]
    read: Callable[[Path], object]
    errors: type[Exception] | tuple[type[Exception], ...]


def written(save: Callable[[Path], object], name: str = "file") -> Callable[[], bytes]:
    """Return what makes the content of a file without its seal, once."""

    @functools.cache
    def whole() -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            made = save(path)
            return unsealed((made if isinstance(made, Path) else path).read_bytes())

    return whole


def rooms() -> Rooms:
    return Rooms.from_outlines(
        FLOOR.frame, ~FLOOR.solid, [("hall", shapely.box(-1.0, -1.0, 9.0, 9.0))]
    )


def picture(form: str) -> bytes:
    packed_picture = io.BytesIO()
    PIL.Image.fromarray(np.full((9, 7), 254, np.uint8)).save(packed_picture, form)
    return packed_picture.getvalue()


def map_of(path: Path) -> object:
    """Read a map whose picture is whole."""
    path.with_name("map.pgm").write_bytes(PGM)
    return load_map(path)


def map_with(picture_path: Path) -> object:
    """Read a map of which this is the picture."""
    path = picture_path.with_suffix(".yaml")
    path.write_text(f"image: {picture_path.name}\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\n")
    return load_map(path)


def silent(_: str) -> None:
    """Hear that a file was set aside."""


MISSED: Final = MissedFloor(1.0, 3.5, 2.5, "hall", "a thing stood in the way")


def run_file() -> bytes:
    """Return a run with all kinds of content."""
    source = RunSource("sim", "box", 7)
    figures = RunFigures(
        source, "clean", 1.7e9, "completed", "", 60.0, 11.0, 12.0, 24.0, 6.5, 3.25, 1.0, (MISSED,)
    )
    layer = CellLayer(0.05, 0.0, 0.0, np.zeros((4, 5), np.uint8))
    words = (Word(0.0, "cleaning", "cleaning"),)
    trace = np.zeros((9, len(TRACE)), np.float32)
    return packed(figures, RunRecording(trace, words, {"name": "box"}, {"map": layer}))


ZONES: Final = Zones(
    (
        Zone("bowl", ZoneKind.NO_GO, ((1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0))),
        Zone("stairs", ZoneKind.WALL, ((0.5, 0.5), (1.0, 0.5))),
    )
)
CALIBRATION: Final = Calibration(
    np.linspace(-0.02, 0.02, 7),
    np.diag(np.linspace(1e-6, 1e-4, 7)),
    np.array([0.0, 0.01, 0.05, 0.0, 0.0, 0.006, -0.01]),
    321,
    0.235,
)


def read_log(path: Path) -> object:
    """Read all of a log."""
    log = open_log(path)
    try:
        arrivals = list(log.entries(log.channels))
        return arrivals, list(log.values(log.channels, np.ones(len(arrivals), np.bool_), _ahead))
    finally:
        log.close()


def _ahead(*_: object) -> Mount:
    """Return a mount for any lidar."""
    return Mount()


KINDS: Final = (
    Kind("map.yaml", written(lambda path: save_map(FLOOR, path), "map.yaml"), map_of, HomeError),
    Kind("map.pgm", lambda: PGM, map_with, HomeError),
    Kind("ascii.pgm", lambda: b"P2\n3 2\n# grey\n255\n0 1 2 3 4 5\n", map_with, HomeError),
    Kind("map.png", lambda: picture("PNG"), map_with, HomeError),
    Kind("map.bmp", lambda: picture("BMP"), map_with, HomeError),
    Kind("home.yaml", lambda: (HOMES / "family" / "home.yaml").read_bytes(), read_layer, HomeError),
    Kind(
        "rooms.yaml",
        written(lambda path: save_rooms(rooms(), FLOOR, path)),
        lambda path: load_rooms(path, FLOOR, silent),
        RoomsError,
    ),
    Kind(
        "zones.yaml",
        written(lambda path: save_zones(ZONES, FLOOR, path)),
        lambda path: load_zones(path, FLOOR, silent),
        ZonesError,
    ),
    Kind(
        "calibration.yaml",
        written(lambda path: save_calibration(CALIBRATION, path)),
        lambda path: load_calibration(path, silent),
        CalibrationError,
    ),
    Kind(
        "errand.json",
        written(
            lambda path: save_checkpoint(
                Checkpoint({"phase": "CLEANING", "ledger": [1.5]}, 1, ("a", "b", 1, 2)), "run", path
            )
        ),
        lambda path: load_checkpoint(path, "run", silent),
        CheckpointFileError,
    ),
    Kind(
        "dirt.npz",
        written(lambda path: save_dirt(np.ones((4, 5), np.float32), path)),
        lambda path: load_dirt(path, (4, 5), silent),
        CheckpointFileError,
    ),
    Kind("run.npz", run_file, lambda path: unpacked(path.read_bytes()), RunFileError),
    *(
        Kind(
            f"{model.__name__}.yaml",
            functools.partial((HOMES.parent / "configuration" / name).read_bytes),
            functools.partial(load_config, model),
            ConfigError,
        )
        for model, name in ((RobotConfig, "robot.yaml"), (MissionConfig, "mission.yaml"))
    ),
    Kind(
        "valetudo.json",
        lambda: json.dumps(
            compose(
                ValetudoHome(
                    FLOOR,
                    (("hall", ~FLOOR.solid),),
                    Pose(1.0, 1.0, 0.0),
                    (((1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)),),
                )
            )
        ).encode(),
        lambda path: parse(path.read_text(encoding="utf-8", errors="replace")),
        ValetudoError,
    ),
    Kind("drive.log", written(lambda path: write_carmen(path, drive(1.0))), read_log, LogError),
    Kind(
        "drive.bag",
        written(lambda path: write_bag(path, drive(1.0)), "drive.bag"),
        read_log,
        LogError,
    ),
    Kind(
        "drive.mcap",
        written(
            lambda path: next(write_bag_2(path, drive(1.0), StoragePlugin.MCAP).glob("*.mcap"))
        ),
        read_log,
        LogError,
    ),
)


@pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])
def test_a_spoiled_file_is_read_or_refused_by_its_own_error(kind: Kind, tmp_path: Path) -> None:
    path, whole = tmp_path / kind.name, kind.whole()
    path.write_bytes(whole)
    kind.read(path)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    @FUZZ
    @given(spoiled(whole))
    def try_one(content: bytes) -> None:
        for left in tmp_path.iterdir():
            left.unlink()
        path.write_bytes(content)
        began, refusal = time.process_time(), "none"
        try:
            kind.read(path)
        except kind.errors as error:
            refusal = str(error)
        assert refusal
        assert time.process_time() - began < SOON

    try_one()
    grown = 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
    assert grown < MEMORY
