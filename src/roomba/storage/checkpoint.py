"""Checkpoints on disk: the robot's present errand, and where it was dirty.

Each file is replaced atomically: a node that was killed finds the old checkpoint or the new one.
"""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.files.atomic import UNREADABLE, write_whole
from roomba.files.bounded import read_bytes, read_text
from roomba.files.damaged import set_aside
from roomba.files.plain_json import load_json

Values = dict[str, Any]
Floats = NDArray[np.float32]
Goal = tuple[str, str, int, int]
"""Of a client: its action, its id, and its time, s and ns."""


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
    write_whole(path, json.dumps(kept, allow_nan=False).encode("utf-8"))


def load_checkpoint(path: Path, run: str) -> Checkpoint | None:
    """Return what was saved in this run; None without a file.

    A checkpoint of another run is ignored: after a launch the robot must not begin to drive by
    itself. A damaged file is set aside: raises CheckpointFileError.
    """
    try:
        read = load_json(read_text(path))
        values, its_run, taken_up = read["mission"], read["run"], int(read["taken_up"])
        goal = read["goal"]
        if goal is not None:
            action, identity, seconds, nanoseconds = goal
            goal = (str(action), str(identity), int(seconds), int(nanoseconds))
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise _damaged(path, f"expected a checkpoint in JSON ({error!r})") from error
    if not isinstance(values, dict):
        raise _damaged(path, f"expected a mission's values, got {str(values)[:80]}")
    return Checkpoint(values, taken_up, goal) if its_run == run else None


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

    A file that is damaged, or of another grid, is set aside: raises CheckpointFileError.
    """
    if not path.exists():
        return None
    try:
        with np.load(io.BytesIO(read_bytes(path)), allow_pickle=False) as file:
            learned: Floats = np.asarray(file["learned"], np.float32)
    except UNREADABLE as error:
        raise _damaged(path, f"expected a dirt map ({error!r})") from error
    if learned.shape != shape:
        raise _damaged(path, f"expected a dirt map of shape {shape}, got {learned.shape}")
    return learned


def _damaged(path: Path, why: str) -> CheckpointFileError:
    return CheckpointFileError(f"{path}: {why}; {set_aside(path)}")
