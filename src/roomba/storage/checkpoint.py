"""Checkpoints on disk: the robot's present errand, and where it was dirty.

Each file is replaced atomically, and sealed: a node that was killed finds the old checkpoint or the
new one, and one that finds a damaged file goes on with the one before.
"""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from roomba.arrays import Floats32
from roomba.errors import RoombaError
from roomba.files.arrays import read_arrays
from roomba.files.kept import KeptFileError, read_kept, remove_kept, write_kept
from roomba.files.plain_json import load_json

Values = dict[str, Any]
Goal = tuple[str, str, int, int]
"""A client's goal: its action, its id, and its time, s and ns."""


class CheckpointFileError(RoombaError):
    """A file that cannot be used; the message names it and says why."""


class Checkpoint(NamedTuple):
    """What a mission must remember, how often it was resumed without progress, and for which goal.

    ``goal`` is what tells the goal of a client from all others; None without one.
    """

    values: Values
    taken_up: int = 0
    goal: Goal | None = None


def save_checkpoint(checkpoint: Checkpoint, run: str, path: Path) -> None:
    """Write a checkpoint; ``run`` names this launch of the robot.

    Raises OSError when the disk refuses, and ValueError for a value that JSON does not have.
    """
    values, taken_up, goal = checkpoint
    kept = {"run": run, "taken_up": taken_up, "goal": goal, "mission": values}
    write_kept(path, json.dumps(kept, allow_nan=False).encode("utf-8"))


def load_checkpoint(path: Path, run: str, tell: Callable[[str], object]) -> Checkpoint | None:
    """Return what was saved in this run; None without a file.

    A checkpoint of another run is ignored: after a launch the robot must not begin to drive by
    itself. A damaged file is set aside, the one before it is used, and ``tell`` is told so.
    Raises CheckpointFileError if there is none that can be used.
    """
    try:
        found = read_kept(path, _checkpoint_of, tell)
    except KeptFileError as error:
        raise CheckpointFileError(str(error)) from error
    if found is None or found[1] != run:
        return None
    return found[0]


def _checkpoint_of(content: bytes) -> tuple[Checkpoint, object]:
    """Return a checkpoint, and its run."""
    try:
        read = load_json(content.decode("utf-8"))
        values, run, taken_up = read["mission"], read["run"], int(read["taken_up"])
        goal = read["goal"]
        if goal is not None:
            action, identity, seconds, nanoseconds = goal
            goal = (str(action), str(identity), int(seconds), int(nanoseconds))
    except (ValueError, KeyError, TypeError, OverflowError) as error:
        raise CheckpointFileError(f"expected a checkpoint in JSON ({error!r})") from error
    if not isinstance(values, dict):
        raise CheckpointFileError(f"expected a mission's values, got {str(values)[:80]}")
    return Checkpoint(values, taken_up, goal), run


def remove_checkpoint(path: Path) -> None:
    """Forget the errand; raises OSError when the disk refuses."""
    remove_kept(path)


def save_dirt(learned: Floats32, path: Path) -> None:
    """Write where it was dirty, float32 [rows, columns], NaN where the robot never was.

    Raises OSError when the disk refuses.
    """
    packed = io.BytesIO()
    np.savez_compressed(packed, learned=learned)
    write_kept(path, packed.getvalue())


def load_dirt(path: Path, shape: tuple[int, int], tell: Callable[[str], object]) -> Floats32 | None:
    """Return where it was dirty, or None if that was never saved.

    A file that is damaged, or of another grid, is set aside, the one before it is used, and
    ``tell`` is told so. Raises CheckpointFileError if there is none that can be used.
    """

    def parse(content: bytes) -> Floats32:
        learned: Floats32 = np.asarray(read_arrays(content)["learned"], np.float32)
        if learned.shape != shape:
            raise CheckpointFileError(f"expected a dirt map of shape {shape}, got {learned.shape}")
        return learned

    try:
        return read_kept(path, parse, tell)
    except KeptFileError as error:
        raise CheckpointFileError(f"expected a dirt map: {error}") from error
