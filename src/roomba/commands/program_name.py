"""How the commands are spelled: ``./roomba`` in a checkout, ``roomba`` where it is installed."""

from __future__ import annotations

import sys
from pathlib import Path


def spelled(command: str) -> str:
    """Return what to type for a command."""
    program = "roomba" if Path(sys.argv[0]).stem == "roomba" else "./roomba"
    return f"{program} {command}"
