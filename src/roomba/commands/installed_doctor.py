"""``roomba doctor`` of the installed library: whether all that it needs can be imported."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Final

from roomba.commands.doctor import (
    Finding,
    StepState,
    as_json,
    as_table,
    why_not_all_importable,
)
from roomba.commands.program_name import spelled

_MODULES: Final = (
    "cv2", "fastapi", "matplotlib", "numba", "numpy", "pebble", "PIL", "pydantic", "rich",
    "rosbags", "scipy", "serial", "shapely", "textual", "uvicorn", "websockets", "yaml",
)  # fmt: skip
_EXTRAS: Final = {
    "distributed": "campaign",
    "gymnasium": "gym",
    "paho": "smart-home",
    "prometheus_client": "smart-home",
    "pyarrow": "campaign",
}


def main(arguments: list[str] | None = None) -> int:
    """Tell whether all that the library needs can be imported; returns 1 if something cannot."""
    parser = argparse.ArgumentParser(
        prog=spelled("doctor"), description="Tell what is missing and how to mend it."
    )
    parser.add_argument("--json", action="store_true", help="for a program to read")
    wanted = parser.parse_args(arguments)
    modules = (*_MODULES, *_EXTRAS)
    reasons = why_not_all_importable(Path(sys.executable), modules, {"PATH": ""})
    findings = [_imported(module, reason) for module, reason in reasons.items()]
    print(as_json(findings) if wanted.json else as_table(findings))
    return 1 if any(finding.state is StepState.MISSING for finding in findings) else 0


def _imported(module: str, reason: str) -> Finding:
    if not reason:
        return Finding(module, StepState.FINE)
    if module in _EXTRAS:
        mend = f"pip install 'roomba_robot[{_EXTRAS[module]}]', if you want it"
        return Finding(module, StepState.NOTE, reason, mend)
    return Finding(module, StepState.MISSING, reason, "install roomba_robot anew with pip")
