"""Checkpoints on disk: the robot's present errand, and where it was dirty.

Each file is replaced atomically: a node that was killed finds the old checkpoint or the new one.
"""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.files.atomic import UNREADABLE, write_whole

Values = dict[str, Any]
Floats = NDArray[np.float32]


class CheckpointFileError(RoombaError):
    """A file that cannot be used; the message names it and says why."""


def save_checkpoint(values: Values, run: str, path: Path, taken_up: int = 0) -> None:
    """Write what a mission must remember; ``run`` names this launch of the robot.

    ``taken_up`` is how often it was resumed without progress. Raises OSError when the disk
    refuses, and ValueError for a value that JSON does not have.
    """
    text = json.dumps({"run": run, "taken_up": taken_up, "mission": values}, allow_nan=False)
    write_whole(path, text.encode("utf-8"))


def load_checkpoint(path: Path, run: str) -> tuple[Values, int] | None:
    """Return what was saved in this run, and how often it was resumed; None without a file.

    A checkpoint of another run is ignored: after a launch the robot must not begin to drive by
    itself. Raises CheckpointFileError for a file that cannot be read.
    """
    try:
        read = json.loads(path.read_text(encoding="utf-8"))
        values, its_run, taken_up = read["mission"], read["run"], int(read["taken_up"])
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise CheckpointFileError(f"{path}: expected a checkpoint in JSON: {error!r}") from error
    if not isinstance(values, dict):
        raise CheckpointFileError(f"{path}: expected a mission's values, got {values!r}")
    return (values, taken_up) if its_run == run else None


def remove_checkpoint(path: Path) -> None:
    """Forget the errand; raises OSError when the disk refuses."""
    path.unlink(missing_ok=True)


def save_dirt(learned: Floats, path: Path) -> None:
    """Write where it was dirty, float32 [rows, columns], NaN where the robot never was.

    Raises OSError when the disk refuses.
    """
    packed = io.BytesIO()
    np.savez_compressed(packed, learned=learned)
    write_whole(path, packed.getvalue())


def load_dirt(path: Path, shape: tuple[int, int]) -> Floats | None:
    """Return where it was dirty, or None if that was never saved.

    Raises CheckpointFileError for a file that cannot be read or is of another grid.
    """
    if not path.exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as file:
            learned: Floats = np.asarray(file["learned"], np.float32)
    except UNREADABLE as error:
        raise CheckpointFileError(f"{path}: expected a dirt map: {error!r}") from error
    if learned.shape != shape:
        raise CheckpointFileError(
            f"{path}: expected a dirt map of shape {shape}, got {learned.shape}; remove the file"
        )
    return learned
