"""A run as bytes, in a file or in the database: an archive of arrays, and of JSON."""

from __future__ import annotations

import io
import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np

from roomba.client.protocol import MissedFloor
from roomba.errors import RoombaError
from roomba.files.atomic import UNREADABLE, write_whole
from roomba.history.run import (
    CELL_LAYERS,
    TRACE,
    CellLayer,
    RunFigures,
    RunRecording,
    RunSource,
    Word,
)

VERSION: Final = 1
_LARGEST: Final = 256 * 1024 * 1024
"""Bytes of a file that is read."""


class RunFileError(RoombaError):
    """A file of a run that cannot be used; the message names it and says why."""


def write_run(figures: RunFigures, recording: RunRecording, path: Path) -> None:
    """Write a run into a file; raises RunFileError when the disk refuses."""
    try:
        write_whole(path, packed(figures, recording))
    except OSError as error:
        raise RunFileError(f"{path}: cannot be written: {error.strerror}") from error


def read_run(path: Path) -> tuple[RunFigures, RunRecording]:
    """Return the run of a file; raises RunFileError."""
    try:
        if path.stat().st_size > _LARGEST:
            raise RunFileError(f"{path}: expected at most {_LARGEST} bytes; this is no run")
        return unpacked(path.read_bytes())
    except OSError as error:
        raise RunFileError(f"{path}: cannot be read: {error.strerror}") from error
    except RunFileError as error:
        raise RunFileError(f"{path}: {error}") from error


def packed(figures: RunFigures, recording: RunRecording) -> bytes:
    """Return a run as bytes."""
    about = {
        "version": VERSION,
        "figures": _plain(asdict(figures)),
        "words": [asdict(word) for word in recording.words],
        "home": recording.home,
        "columns": TRACE,
        "layers": {
            name: [layer.resolution, layer.origin_x, layer.origin_y]
            for name, layer in recording.layers.items()
        },
    }
    arrays: dict[str, Any] = {name: layer.cells for name, layer in recording.layers.items()}
    arrays["trace"] = recording.trace
    arrays["about"] = np.frombuffer(json.dumps(about, allow_nan=False).encode(), np.uint8)
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


def unpacked(content: bytes) -> tuple[RunFigures, RunRecording]:
    """Return the run of some bytes; raises RunFileError."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
            about = json.loads(arrays["about"].tobytes())
            if about["version"] != VERSION or tuple(about["columns"]) != TRACE:
                raise RunFileError(
                    f"expected a run of version {VERSION}, got version {about['version']}; "
                    "read it with the program that wrote it"
                )
            trace = np.asarray(arrays["trace"], np.float32)
            if trace.ndim != 2 or trace.shape[1] != len(TRACE) or not np.isfinite(trace).all():
                raise RunFileError(f"expected a trace of {len(TRACE)} finite columns")
            layers = {
                name: _layer(about["layers"][name], arrays[name])
                for name in CELL_LAYERS
                if name in about["layers"]
            }
            words = tuple(Word(**word) for word in about["words"])
            return _figures(about["figures"]), RunRecording(trace, words, about["home"], layers)
    except UNREADABLE as error:
        raise RunFileError(
            "expected a recorded run, as ./roomba report --recording writes it, got a file that "
            f"is damaged, or something else ({type(error).__name__})"
        ) from error


def _layer(place: list[float], array: Any) -> CellLayer:
    cells = np.asarray(array, np.uint8)
    if cells.ndim != 2:
        raise RunFileError(f"expected rows and columns of cells, got shape {cells.shape}")
    resolution, x, y = map(float, place)
    return CellLayer(resolution, x, y, cells)


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """Return values as JSON has them: what is not finite is null."""
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value
        for name, value in values.items()
    }


def _figures(values: dict[str, Any]) -> RunFigures:
    known: dict[str, Any] = {
        name: math.nan if value is None else value for name, value in values.items()
    }
    known["source"] = RunSource(**known["source"])
    known["missed"] = tuple(MissedFloor(**miss) for miss in known["missed"])
    return RunFigures(**known)
