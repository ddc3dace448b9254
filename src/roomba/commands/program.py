"""The program ``roomba`` of the installed library: the commands that need no ROS.

``./roomba`` of a checkout runs them by this program, too, and has further commands that need ROS.
"""

from __future__ import annotations

import importlib
import os
import re
import sys
import textwrap
from pathlib import Path
from types import ModuleType
from typing import Final

from roomba.commands.process_end import quiet_end, quiet_loading

_IS_WINDOWS: Final = os.name == "nt"

_COMMANDS: Final = {
    "sim": "roomba.commands.sim.command",
    "campaign": "roomba.commands.campaign.command",
    "map": "roomba.commands.map.command",
    "localize": "roomba.commands.localize.command",
    "play": "roomba.commands.play.command",
    "replay": "roomba.commands.play.replay",
    "emulate": "roomba.commands.emulate.command",
    "status": "roomba.commands.status.command",
    "top": "roomba.commands.top.command",
    "report": "roomba.commands.report.command",
    "import": "roomba.commands.valetudo.import_command",
    "export": "roomba.commands.export.command",
    "pictures": "roomba.commands.pictures.__main__",
    "bench": "roomba_bench.__main__",
    "doctor": "roomba.commands.installed_doctor",
}
"""By command, the module whose ``main`` runs it; each is loaded when it is needed."""
_OF_RECORDINGS: Final = {"map": "roomba.commands.map.drive.command"}
"""The same for commands with ``--bag``."""
_OF_VALETUDO: Final = {"export": "roomba.commands.valetudo.export_command"}
"""The same of a command whose first word is valetudo."""
_DEMOS: Final = {"control": "roomba.commands.control.command"}
"""The same for commands that need ROS, unless they have ``--demo``."""
_ON_WINDOWS: Final = ("sim", "doctor")
"""The commands that save nothing in a folder of this program."""
_NEED_ROS: Final = ("run", "control", "camera", "exec", "record", "service")
_NEED_CHECKOUT: Final = ("test", "soak", "fuzz", "sbom", "exercise", "docs")
_USAGE: Final = Path(__file__).with_name("usage.txt")
"""The text of ``./roomba help``, of which this program prints a part."""


def program() -> int:
    """Run the command of the command line; returns the exit status, 2 for an unknown command."""
    with quiet_end():
        return _run()


def _run() -> int:
    command, *arguments = sys.argv[1:] or ["help"]
    if command in ("help", "-h", "--help"):
        print(_usage(), end="")
        return 0
    if command in ("version", "--version"):
        from importlib.metadata import version  # 10 ms, which others need not wait for

        print(f"roomba_robot {version('roomba_robot')}")
        return 0
    if command in _DEMOS and "--demo" in arguments:
        return int(_loaded(_DEMOS[command]).main(arguments))
    if _IS_WINDOWS and command not in _ON_WINDOWS:
        here = ", ".join(_ON_WINDOWS)
        return _refused(
            f"{command}: expected Linux or macOS, got Windows, where {here} work, and the library "
            "with its simulator, robot and Gymnasium environment; in WSL 2 all does"
        )
    if command in _NEED_ROS:
        demo = f"; without it: roomba {command} --demo" if command in _DEMOS else ""
        why = "needs ROS, which only a checkout sets up"
        return _refused(f"{command}: {why}: ./roomba {command}{demo}")
    if command in _NEED_CHECKOUT:
        return _refused(f"{command}: needs the sources; in a checkout: ./roomba {command}")
    if command not in _COMMANDS:
        return _refused(f"expected a command of `roomba help`, got {command!r}")
    has_recording = any(word.split("=")[0] == "--bag" for word in arguments)
    modules = {**_COMMANDS, **(_OF_RECORDINGS if has_recording else {})}
    if arguments[:1] == ["valetudo"]:
        modules |= _OF_VALETUDO
    return int(_loaded(modules[command]).main(arguments))


def _loaded(module: str) -> ModuleType:
    with quiet_loading():
        return importlib.import_module(module)


def _usage() -> str:
    """Return the usage entries of the commands that this program has."""
    _, listed, _ = _USAGE.read_text(encoding="utf-8").split("\n\n", 2)
    entries = re.split(r"\n(?=  \w)", listed)
    here = {*_COMMANDS, *_DEMOS, "version", "help"}
    kept = "\n".join(entry for entry in entries if entry.split()[0] in here)
    return f"usage: roomba COMMAND ...\n\n{kept.replace('./roomba', 'roomba')}\n\n{_elsewhere()}"


def _elsewhere() -> str:
    """Return a text about the other commands: where they are."""
    with_demo = " and ".join(_DEMOS)
    need_ros = ", ".join(name for name in _NEED_ROS if name not in _DEMOS)
    told = (
        f"The commands {need_ros}, and {with_demo} without --demo, need ROS; "
        f"{', '.join(_NEED_CHECKOUT)} need the checkout: there it is ./roomba COMMAND."
    )
    return textwrap.fill(told, 100, break_on_hyphens=False) + "\n"


def _refused(reason: str) -> int:
    print(f"roomba: {reason}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(program())
