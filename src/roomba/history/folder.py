"""Where the history lives."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path


def history_folder(environment: Mapping[str, str] | None = None) -> Path:
    """Return the folder of the history, which need not be there yet.

    ``$ROOMBA_HISTORY``; else ``roomba_robot/history`` of ``$ROS_HOME``, or of the state folder of
    the XDG base directories (``$XDG_STATE_HOME``, by default ``~/.local/state``). Paths that are
    not absolute count as unset, as XDG says.
    """
    given = os.environ if environment is None else environment
    own = Path(given.get("ROOMBA_HISTORY", ""))
    if own.is_absolute():
        return own
    for name in ("ROS_HOME", "XDG_STATE_HOME"):
        home = Path(given.get(name, ""))
        if home.is_absolute():
            return home / "roomba_robot" / "history"
    return Path.home() / ".local" / "state" / "roomba_robot" / "history"
