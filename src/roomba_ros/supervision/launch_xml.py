"""Reads those parts of the launch file that are needed before large modules are imported."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import rospkg

from roomba.errors import RoombaError


def package_folder() -> Path:
    """Return where this package lies."""
    return Path(rospkg.RosPack().get_path("roomba_robot"))


def launch_file() -> Path:
    """Return the file that says which processes the robot has."""
    return package_folder() / "launch" / "roomba_robot.launch"


def elements(path: Path, kind: str) -> list[ElementTree.Element]:
    """Return the elements of a kind at the top of a launch file; raises RoombaError."""
    try:
        return ElementTree.parse(path).getroot().findall(kind)
    except (OSError, ElementTree.ParseError) as error:
        raise RoombaError(f"{path}: expected a launch file: {error}") from error


def environment_of(path: Path) -> dict[str, str]:
    """Return the environment of all processes of a launch file; raises RoombaError."""
    return {element.attrib["name"]: element.attrib["value"] for element in elements(path, "env")}
