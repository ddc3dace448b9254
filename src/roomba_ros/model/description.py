"""The robot as a URDF: xacro puts the numbers of a ``robot.yaml`` into the model."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import xacro

from roomba.errors import RoombaError
from roomba.files.shipped import CONFIGURATION, MODEL


def description(configuration: Path = CONFIGURATION / "robot.yaml") -> str:
    """Return the model as URDF; raises RoombaError for a file without the numbers it needs."""
    try:
        document = xacro.process_file(
            str(MODEL / "robot.urdf.xacro"),
            mappings={"configuration": str(configuration.resolve())},
        )
    except xacro.XacroException as error:
        raise RoombaError(
            f"{configuration}: expected a robot.yaml with all of body, brush, camera, cliff and "
            f"lidar, got: {error}"
        ) from error
    return str(document.toprettyxml(indent=" "))


def main(arguments: list[str] | None = None) -> int:
    """Print the model; returns 0, or 1 when there is none."""
    parser = argparse.ArgumentParser(prog="python3 -m roomba_ros.model", description=__doc__)
    parser.add_argument(
        "--config",
        "--configuration",
        type=Path,
        default=CONFIGURATION / "robot.yaml",
        metavar="FILE.yaml",
        help="the robot's numbers (default: those that come along)",
    )
    try:
        sys.stdout.write(description(parser.parse_args(arguments).config))
    except RoombaError as error:
        print(error, file=sys.stderr)
        return 1
    return 0
