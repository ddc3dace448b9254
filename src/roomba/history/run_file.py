"""A run as bytes, in a file or in the database: an archive of arrays, and of JSON."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np
from pydantic import TypeAdapter

from roomba.errors import RoombaError
from roomba.files.arrays import read_arrays
from roomba.files.atomic import UNREADABLE, write_output
from roomba.files.bounded import read_bytes
from roomba.files.plain_json import load_json
from roomba.history.run import CELL_LAYERS, TRACE, CellLayer, RunFigures, RunRecording, Word

VERSION: Final = 1
_WORDS: Final = TypeAdapter(tuple[Word, ...])
_FIGURES: Final = TypeAdapter(RunFigures)
_LARGEST: Final = 256 * 1024 * 1024
"""Bytes of a file that is read, and of what it holds when it is unpacked."""


class RunFileError(RoombaError):
    """A file of a run that cannot be used; the message names it and says why."""


def write_run(figures: RunFigures, recording: RunRecording, path: Path) -> None:
    """Write a run into a file; raises RunFileError, also for what :func:`packed` refuses."""
    try:
        write_output(path, packed(figures, recording))
    except OSError as error:
        raise RunFileError(f"{path}: cannot be written: {error.strerror}") from error


def read_run(path: Path) -> tuple[RunFigures, RunRecording]:
    """Return the run of a file; raises RunFileError."""
    try:
        return unpacked(read_bytes(path, _LARGEST))
    except OSError as error:
        raise RunFileError(f"{path}: cannot be read: {error.strerror}") from error
    except RunFileError as error:
        raise RunFileError(f"{path}: {error}") from error


def packed(figures: RunFigures, recording: RunRecording) -> bytes:
    """Return a run as bytes; raises RunFileError for what could not be read again."""
    if not np.isfinite(recording.trace).all():
        raise RunFileError("expected a trace of finite numbers, got one with others")
    try:
        about = json.dumps(_about(figures, recording), allow_nan=False)
    except (ValueError, TypeError) as error:
        raise RunFileError(f"expected plain values and finite numbers: {error}") from error
    arrays: dict[str, Any] = {name: layer.cells for name, layer in recording.layers.items()}
    arrays["trace"] = recording.trace
    arrays["about"] = np.frombuffer(about.encode(), np.uint8)
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


def _about(figures: RunFigures, recording: RunRecording) -> dict[str, Any]:
    """Return all of a run that is no array."""
    return {
        "version": VERSION,
        "figures": plain_of(figures),
        "words": [asdict(word) for word in recording.words],
        "home": recording.home,
        "columns": TRACE,
        "layers": {
            name: [layer.resolution, layer.origin_x, layer.origin_y]
            for name, layer in recording.layers.items()
        },
    }


def unpacked(content: bytes) -> tuple[RunFigures, RunRecording]:
    """Return the run of some bytes; raises RunFileError."""
    try:
        arrays = read_arrays(content, _LARGEST)
        about = load_json(arrays["about"].tobytes().decode())
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
        words = _WORDS.validate_python(about["words"])
        return figures_from(about["figures"]), RunRecording(
            trace, words, dict(about["home"]), layers
        )
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


def plain_of(figures: RunFigures) -> dict[str, Any]:
    """Return figures as values that JSON has: what is not known is None."""
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value
        for name, value in asdict(figures).items()
    }


def figures_from(values: Mapping[str, Any]) -> RunFigures:
    """Return the figures of plain values; raises ValueError for others."""
    known = {name: math.nan if value is None else value for name, value in dict(values).items()}
    return _FIGURES.validate_python(known)
