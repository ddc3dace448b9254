"""Reads a launch file into a table of processes, with the launch arguments checked.

roslaunch's own reader runs in a process of its own: it registers YAML constructors that run code,
and no node shall have these.
"""

from __future__ import annotations

import contextlib
import json
import os
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from roomba.errors import RoombaError
from roomba.files.strict_yaml import suggestion
from roomba_ros.supervision.fork import fork
from roomba_ros.supervision.launch_xml import elements

_PACKAGE: Final = "roomba_robot"


@dataclass(frozen=True, slots=True)
class ProcessEntry:
    """One node of the table: its ``script`` in the package's folder ``scripts``.

    If it ``is_required``, its end ends all; otherwise it is restarted, if it ``is_respawned``. A
    program of another package has a ``command`` with arguments, and no script.
    """

    name: str
    namespace: str
    script: str
    is_required: bool
    is_respawned: bool = True
    command: tuple[str, ...] = ()

    @property
    def path(self) -> str:
        """Its full name on the graph."""
        return f"{self.namespace}{self.name}"


@dataclass(frozen=True, slots=True)
class Launch:
    """The content of a launch file: processes, and parameters by full name."""

    processes: tuple[ProcessEntry, ...]
    parameters: dict[str, Any]


def described(path: Path) -> str:
    """Return a line for each argument of a launch file: name, default, and purpose."""
    return "\n".join(
        f"  {argument.get('name')}:={argument.get('default', '')}".ljust(34)
        + argument.get("doc", "")
        for argument in elements(path, "arg")
    )


def check_arguments(path: Path, arguments: Sequence[str]) -> None:
    """Raise RoombaError for an argument that is no ``name:=value``, or that the file lacks."""
    known = [str(argument.get("name")) for argument in elements(path, "arg")]
    for argument in arguments:
        name, sign, _ = argument.partition(":=")
        if not sign or not name:
            raise RoombaError(f"expected arguments like home:=flat, got {argument!r}")
        if name == "robot":
            _check_body(path, argument.partition(":=")[2])
        # Two underscores: a remapping of ROS, such as __name.
        if name not in known and not name.startswith("__"):
            raise RoombaError(f"expected a known argument, got {name!r}; {suggestion(name, known)}")


def _check_body(path: Path, body: str) -> None:
    """Raise RoombaError for a robot without a file in the folder ``bodies``."""
    known = sorted(file.stem for file in (path.parent / "bodies").glob("*.launch"))
    if body not in known:
        raise RoombaError(f"robot: expected one of {', '.join(known)}, got {body!r}")


def read_launch(path: Path, arguments: Sequence[str]) -> Launch:
    """Return what a launch file says; raises RoombaError with the reason."""
    check_arguments(path, arguments)
    reading, writing = os.pipe()
    child = fork(partial(_tell, path, arguments, writing))
    os.close(writing)
    with open(reading, encoding="utf-8") as pipe:
        told = pipe.read()
    os.waitpid(child, 0)
    if not told:
        raise RoombaError(f"{path}: expected a launch file, got one that cannot be read")
    found = json.loads(told)
    if "error" in found:
        raise RoombaError(f"{path}: {found['error']}")
    processes = tuple(
        ProcessEntry(**{**entry, "command": tuple(entry["command"])})
        for entry in found["processes"]
    )
    return Launch(processes, found["parameters"])


def _tell(path: Path, arguments: Sequence[str], pipe: int) -> None:
    """Read the launch file, and write its content into a pipe as JSON."""
    try:
        text = json.dumps(_loaded(path, arguments))
    except Exception as error:  # it raises many kinds, and this process ends with each
        text = json.dumps({"error": str(error)})
    with open(pipe, "w", encoding="utf-8") as writing:
        writing.write(text)


def _loaded(path: Path, arguments: Sequence[str]) -> dict[str, Any]:
    from roslaunch.config import ROSLaunchConfig
    from roslaunch.xmlloader import XmlLoader

    config: Any = ROSLaunchConfig()
    XmlLoader().load(str(path), config, argv=list(arguments), verbose=False)
    return {
        "processes": [_entry(node) for node in config.nodes],
        "parameters": {parameter.key: parameter.value for parameter in config.params.values()},
    }


def _entry(node: Any) -> dict[str, Any]:
    is_ours = node.package == _PACKAGE
    return {
        "name": node.name,
        "namespace": node.namespace,
        "script": node.type if is_ours else "",
        "is_required": bool(node.required),
        "is_respawned": bool(node.respawn),
        "command": [] if is_ours else [_program(node.package, node.type), *shlex.split(node.args)],
    }


def _program(package: str, name: str) -> str:
    """Return the path of a program of another package; raises RoombaError."""
    from rospkg import ResourceNotFound

    with contextlib.suppress(ResourceNotFound):
        from roslib.packages import find_node

        for path in find_node(package, name):
            return str(path)
    raise RoombaError(
        f"expected the program {name} of the package {package}, there is none; install that "
        f"package: ./roomba run installs what it launches if it may, and names it if not"
    )
