"""Where the robot keeps what belongs to this user: its history, and the token of its page."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path


def state_folder(environment: Mapping[str, str]) -> Path:
    """Return the folder, which need not be there yet.

    ``roomba_robot`` of ``$ROS_HOME``, or of the state folder of the XDG base directories
    (``$XDG_STATE_HOME``, by default ``~/.local/state``). Paths that are not absolute count as
    unset, as XDG says.
    """
    for name in ("ROS_HOME", "XDG_STATE_HOME"):
        home = Path(environment.get(name, ""))
        if home.is_absolute():
            return home / "roomba_robot"
    return Path.home() / ".local" / "state" / "roomba_robot"
