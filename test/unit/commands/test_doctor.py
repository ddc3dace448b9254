"""The doctor: what it makes of the state of the set-up, and what it says to do."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from roomba.commands.doctor import (
    BrokenReportError,
    Finding,
    StepState,
    as_json,
    as_table,
    check_display,
    check_master,
    check_python_on_path,
    check_space,
    findings_of_steps,
    why_not_all_importable,
    why_not_importable,
)


def test_current_step_is_fine() -> None:
    assert findings_of_steps(["catkin workspace\tcurrent\t\n"]) == [
        Finding("catkin workspace", StepState.FINE)
    ]


@pytest.mark.parametrize(
    ("line", "state", "mend"),
    [
        ("system packages\tmissing\tpython3-rospy", StepState.MISSING, "./roomba run"),
        ("Python packages\tmissing\t", StepState.MISSING, "./roomba run"),
        ("compiled loops\tmissing\t", StepState.NOTE, "./roomba exec true"),
        ("Python packages for tests\tmissing\t", StepState.NOTE, "./roomba test"),
    ],
)
def test_missing_step_tells_how_to_mend_it(line: str, state: StepState, mend: str) -> None:
    (finding,) = findings_of_steps([line])
    assert (finding.state, finding.mend) == (state, mend)
    assert finding.detail


def test_what_no_set_up_brings_is_mended_elsewhere() -> None:
    lines = "system packages\tunavailable\tno ROS 1 here", "catkin workspace\tmissing\t"
    findings = findings_of_steps(lines)
    assert [finding.state for finding in findings] == [StepState.MISSING] * 2
    assert all("docs/install.md" in finding.mend for finding in findings)
    assert not any("./roomba run" in finding.mend for finding in findings)


def test_missing_packages_are_named() -> None:
    (finding,) = findings_of_steps(["system packages\tmissing\tpython3-rospy rosout"])
    assert finding.detail == "python3-rospy rosout"


@pytest.mark.parametrize("line", ["", "system packages", "a\tb\tc", "a\tcurrent\tb\tc"])
def test_report_of_another_form_is_refused(line: str) -> None:
    with pytest.raises(BrokenReportError, match="expected"):
        findings_of_steps([line])


@pytest.mark.parametrize(
    ("path", "state"),
    [
        ("/usr/bin/python3", StepState.FINE),
        ("/bin/python3", StepState.FINE),
        ("/home/user/.pyenv/shims/python3", StepState.NOTE),
        (None, StepState.NOTE),
    ],
)
def test_foreign_python_is_noted(path: str | None, state: StepState) -> None:
    assert check_python_on_path(path).state is state


@pytest.mark.parametrize("is_open", [True, False])
def test_master_is_asked_at_its_host_and_port(is_open: bool) -> None:
    asked = []

    def answer(host: str, port: int) -> bool:
        asked.append((host, port))
        return is_open

    finding = check_master("http://robot:11322/", answer)
    assert asked == [("robot", 11322)]
    assert finding.state is (StepState.FINE if is_open else StepState.NOTE)


@pytest.mark.parametrize(
    "uri", ["", "localhost:11311", "http://localhost", "http://localhost:many", "http://[::1"]
)
def test_broken_master_uri_is_told(uri: str) -> None:
    finding = check_master(uri, lambda host, port: True)
    assert finding.state is StepState.MISSING
    assert repr(uri) in finding.detail


def test_little_space_is_noted() -> None:
    assert check_space(100.0).state is StepState.FINE
    assert check_space(0.5).state is StepState.NOTE


def test_no_display_is_noted() -> None:
    assert check_display({"DISPLAY": ":0"}).state is StepState.FINE
    assert check_display({}).state is StepState.NOTE


def test_reason_why_a_module_does_not_import() -> None:
    python = Path(sys.executable)
    assert why_not_importable(python, "json", {}) == ""
    assert "no_such_module" in why_not_importable(python, "no_such_module", {})


def test_of_several_modules_each_has_its_reason() -> None:
    python = Path(sys.executable)
    assert why_not_all_importable(python, ("json", "ast"), {}) == {"json": "", "ast": ""}
    reasons = why_not_all_importable(python, ("json", "no_such_module", "ast"), {})
    assert "no_such_module" in reasons["no_such_module"]
    assert reasons["json"] == reasons["ast"] == ""


def test_python_that_is_not_there_is_a_reason(tmp_path: Path) -> None:
    assert why_not_importable(tmp_path / "python3", "json", {})


def test_table_has_the_state_first_and_the_remedy_below() -> None:
    findings = [
        Finding("disk", StepState.FINE, "9.0 GB free"),
        Finding("system packages", StepState.MISSING, "rosout", "./roomba run"),
    ]
    assert as_table(findings).splitlines() == [
        "fine    disk: 9.0 GB free",
        "missing system packages: rosout",
        "            to mend it: ./roomba run",
    ]


def test_json_holds_the_same() -> None:
    (row,) = json.loads(as_json([Finding("disk", StepState.NOTE, "0.5 GB free", "make room")]))
    assert row == {
        "subject": "disk",
        "state": "note",
        "detail": "0.5 GB free",
        "mend": "make room",
    }
