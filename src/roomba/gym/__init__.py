"""The robot as a Gymnasium environment, ``RoombaClean-v0``; needs the extra ``gym``.

Importing this registers it: ``gymnasium.make`` and ``gymnasium.make_vec`` know it from then on.
"""

from __future__ import annotations

try:
    import gymnasium
except ImportError as error:
    raise ImportError(
        "roomba.gym: expected the package gymnasium, which is not installed; install it with: "
        "pip install 'gymnasium>=1.1' (or 'roomba_robot[gym]')"
    ) from error

from roomba.gym.single import RoombaClean
from roomba.gym.task import Task
from roomba.gym.vector import RoombaCleanVector

ENVIRONMENT = "RoombaClean-v0"

gymnasium.register(
    ENVIRONMENT,
    entry_point="roomba.gym.single:RoombaClean",
    vector_entry_point="roomba.gym.vector:RoombaCleanVector",
)

__all__ = ["ENVIRONMENT", "RoombaClean", "RoombaCleanVector", "Task"]
