"""What is missing for the robot to run, and how to mend it: ``./roomba doctor``.

Runs under the distribution's Python with nothing but the standard library, for it has to speak
when nothing is set up. ``./roomba`` hands over the state of each step of the set-up as lines of
``name, state, detail`` between tabs on standard input, where the state is current, missing, or
unavailable on this system; what a step cannot know about itself (do the parts import, may ROS be
reached) is tried here.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import socket
import subprocess
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import Enum
from pathlib import Path
from urllib.parse import urlsplit

from roomba.commands.process_end import quiet_end

SYSTEM_PYTHON = "/usr/bin/python3"
DEFAULT_MASTER = "http://localhost:11311"
MODULE_OF_STEP = {
    "Python packages": ("numba", "numpy", "pydantic", "rich", "shapely"),
    "system packages": ("cv2", "cv_bridge", "rospy", "actionlib"),
}
RUN = "./roomba run"
ELSEWHERE = "run in a container of Debian: docs/install.md; without ROS: ./roomba play, sim, map"
LEAST_FREE_SPACE = 3.0  # GB; a set-up from nothing takes 2 GB, its downloads for a time 0.6 GB


class StepState(Enum):
    """What became of one check."""

    FINE = "fine"
    """Nothing is to be done."""
    NOTE = "note"
    """The robot runs, but something is worth knowing."""
    MISSING = "missing"
    """The robot does not run before this is mended."""


@dataclass(frozen=True)
class Finding:
    """One row of the doctor's table."""

    subject: str
    state: StepState
    detail: str = ""
    mend: str = ""


class BrokenReportError(ValueError):
    """A line about a step is not ``name, state, detail`` between tabs."""


def findings_of_steps(lines: Iterable[str]) -> list[Finding]:
    """Return a finding per line that ``./roomba`` wrote about a step of its set-up.

    Raises BrokenReportError for a line of another form.
    """
    findings, mend = [], RUN
    for line in lines:
        fields = line.rstrip("\n").split("\t")
        if len(fields) != 3 or fields[1] not in ("current", "missing", "unavailable"):
            raise BrokenReportError(
                f"expected 'name<tab>current|missing|unavailable<tab>detail', got {line!r}; "
                "run ./roomba doctor"
            )
        name, state, detail = fields
        if state == "unavailable":  # then no set-up makes what comes after it either
            mend = ELSEWHERE
        if state == "current":
            findings.append(Finding(name, StepState.FINE))
        elif name.endswith("for tests"):
            detail = detail or "not set up, or not up to date"
            findings.append(Finding(name, StepState.NOTE, detail, "./roomba test"))
        elif name == "compiled loops":
            detail = "the first start will be slow"
            findings.append(Finding(name, StepState.NOTE, detail, "./roomba exec true"))
        else:
            detail = detail or "not set up, or not up to date"
            findings.append(Finding(name, StepState.MISSING, detail, mend))
    return findings


def check_modules(
    python: Path, environment: Mapping[str, str], folder_of_messages: Path
) -> list[Finding]:
    """Return whether the Python modules of each step import."""
    findings = []
    for step, modules in MODULE_OF_STEP.items():
        reasons = why_not_all_importable(python, modules, environment)
        failures = [f"{module}: {reason}" for module, reason in reasons.items() if reason]
        subject = f"imports of the {step}"
        if failures:
            mend = f"remove {python.parents[1]}, then ./roomba run"
            findings.append(Finding(subject, StepState.MISSING, "; ".join(failures), mend))
        else:
            findings.append(Finding(subject, StepState.FINE, ", ".join(modules)))
    with_messages = {**environment, "PYTHONPATH": str(folder_of_messages)}
    reason = why_not_importable(python, "roomba_robot.msg", with_messages)
    if reason:
        mend = "remove .workspace, then ./roomba run"
        findings.append(Finding("messages of roomba_robot", StepState.MISSING, reason, mend))
    else:
        findings.append(Finding("messages of roomba_robot", StepState.FINE))
    return findings


def why_not_importable(python: Path, module: str, environment: Mapping[str, str]) -> str:
    """Return the last line of what Python says when it imports ``module``, or "" if it can."""
    try:
        done = subprocess.run(
            [str(python), "-c", f"import {module}"],
            capture_output=True,
            check=False,
            env=dict(environment),
            text=True,
            timeout=60.0,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    if done.returncode == 0:
        return ""
    lines = done.stderr.strip().splitlines()
    return lines[-1] if lines else f"ended with status {done.returncode}"


def why_not_all_importable(
    python: Path, modules: Sequence[str], environment: Mapping[str, str]
) -> dict[str, str]:
    """Return the same of each module.

    One process tries all, which is quicker; if that fails each is tried in a process of its own.
    """
    if not why_not_importable(python, ", ".join(modules), environment):
        return dict.fromkeys(modules, "")
    return {module: why_not_importable(python, module, environment) for module in modules}


def check_python_on_path(path: str | None) -> Finding:
    """Return whether ``path``, which ``python3`` means in the user's shell, is the one of ROS."""
    subject = "python3 on PATH"
    if path in (SYSTEM_PYTHON, "/bin/python3"):
        return Finding(subject, StepState.FINE, path)
    detail = f"{path or 'there is none'}; ROS belongs to {SYSTEM_PYTHON}"
    mend = f"nothing for ./roomba; for catkin_make: -DPYTHON_EXECUTABLE={SYSTEM_PYTHON}"
    return Finding(subject, StepState.NOTE, detail, mend)


def check_master(uri: str, is_open: Callable[[str, int], bool]) -> Finding:
    """Return whether a ROS master is there; ``is_open`` tells whether a host's port is open."""
    subject = "ROS master"
    try:
        parts = urlsplit(uri)
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if not host or not port or parts.scheme != "http":
        detail = f"ROS_MASTER_URI: expected http://HOST:PORT, got {uri!r}"
        return Finding(
            subject, StepState.MISSING, detail, f"export ROS_MASTER_URI={DEFAULT_MASTER}"
        )
    if is_open(host, port):
        return Finding(subject, StepState.FINE, f"something answers at {uri}")
    return Finding(subject, StepState.NOTE, f"none at {uri}", "./roomba run starts one")


def is_port_open(host: str, port: int) -> bool:
    """Return whether something accepts a connection within a second."""
    try:
        with socket.create_connection((host, port), timeout=1.0):
            return True
    except OSError:
        return False


def check_display(environment: Mapping[str, str]) -> Finding:
    """Return whether windows can be shown."""
    if environment.get("DISPLAY"):
        return Finding("display", StepState.FINE, environment["DISPLAY"])
    detail = "there is none: the camera client saves its pictures and says where"
    return Finding("display", StepState.NOTE, detail)


def check_space(free: float) -> Finding:
    """Return whether the disk has room for a set-up (``free`` in GB)."""
    detail = f"{free:.1f} GB free"
    if free >= LEAST_FREE_SPACE:
        return Finding("disk", StepState.FINE, detail)
    mend = f"make room: a set-up from nothing wants {LEAST_FREE_SPACE:g} GB"
    return Finding("disk", StepState.NOTE, detail, mend)


def as_table(findings: Iterable[Finding]) -> str:
    """Return the findings as lines for a person."""
    lines = []
    for finding in findings:
        line = f"{finding.state.value:8}{finding.subject}"
        lines.append(f"{line}: {finding.detail}" if finding.detail else line)
        if finding.mend:
            lines.append(f"{'':8}    to mend it: {finding.mend}")
    return "\n".join(lines)


def as_json(findings: Iterable[Finding]) -> str:
    """Return the findings as a JSON list for a program."""
    rows = [{**asdict(finding), "state": finding.state.value} for finding in findings]
    return json.dumps(rows, indent=2)


def examine(
    repository: Path, steps: Iterable[str], environment: Mapping[str, str]
) -> list[Finding]:
    """Return all findings about the checkout in ``repository`` and the machine it is on."""
    findings = findings_of_steps(steps)
    if all(finding.state is not StepState.MISSING for finding in findings):
        python = repository / ".venv/bin/python3"
        messages = repository / ".workspace/devel/lib/python3/dist-packages"
        findings += check_modules(python, {**environment, "PYTHONNOUSERSITE": "1"}, messages)
    return [
        *findings,
        check_space(shutil.disk_usage(repository).free / 1e9),
        check_python_on_path(shutil.which("python3", path=environment.get("PATH"))),
        check_master(environment.get("ROS_MASTER_URI", DEFAULT_MASTER), is_port_open),
        check_display(environment),
    ]


def main() -> int:
    """Print the table; return 1 if something is missing, else 0."""
    parser = argparse.ArgumentParser(
        prog="./roomba doctor", description="Tell what is missing and how to mend it."
    )
    parser.add_argument("--repository", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--json", action="store_true", help="for a program to read")
    arguments = parser.parse_args()
    environment = dict(os.environ)
    environment.pop("PYTHONPATH", None)  # set by ./roomba for this program alone
    findings = examine(arguments.repository, sys.stdin, environment)
    print(as_json(findings) if arguments.json else as_table(findings))
    return 1 if any(finding.state is StepState.MISSING for finding in findings) else 0


if __name__ == "__main__":
    with quiet_end():
        sys.exit(main())
