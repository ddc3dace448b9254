"""The service: how it is written, installed and removed, and how little it may do."""

import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

from roomba.commands.service import UNITS, ServiceError, main, units

REPOSITORY = Path(__file__).resolve().parents[3]
MOST_EXPOSED = 20
"""Tenths of what `systemd-analyze security` calls exposure: 2.0 of 10."""


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the units as they are installed."""
    folder = tmp_path_factory.mktemp("units")
    for name, text in units(REPOSITORY, 8400, ["home:=studio", "speed:=1.5"]).items():
        (folder / name).write_text(text, "utf-8")
    return folder


def analyzed(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["systemd-analyze", *arguments], check=False, capture_output=True, text=True, timeout=60.0
    )


def test_it_is_exposed_to_little(filled: Path) -> None:
    done = analyzed("security", "--offline=true", f"--threshold={MOST_EXPOSED}", filled / UNITS[0])
    told = re.search(r"Overall exposure level for roomba\.service: ([\d.]+)", done.stdout)
    assert told, done.stdout + done.stderr
    assert float(told[1]) <= MOST_EXPOSED / 10
    assert done.returncode == 0


def test_systemd_understands_it(filled: Path) -> None:
    done = analyzed("verify", *(filled / name for name in UNITS))
    assert (done.returncode, done.stderr) == (0, "")


def test_it_runs_this_checkout_with_what_was_asked_for(filled: Path) -> None:
    text = (filled / UNITS[0]).read_text("utf-8")
    assert f"\nExecStart={REPOSITORY}/roomba run --isolated home:=studio speed:=1.5\n" in text
    assert "ListenStream=127.0.0.1:8400\n" in (filled / UNITS[1]).read_text("utf-8")
    for named in re.findall(rf"{REPOSITORY}/([\w./]+)", text):
        assert (REPOSITORY / named).exists() or named.startswith(".cache"), named


@pytest.mark.parametrize(
    "argument", ["home", "home:=a b", "x:=$(id)", "a:=%n", 'a:="', "a:=b\nUser=root"]
)
def test_what_a_unit_would_read_otherwise_is_refused(argument: str) -> None:
    with pytest.raises(ServiceError, match="expected arguments"):
        units(REPOSITORY, 8400, [argument])
    with pytest.raises(ServiceError, match="expected a checkout"):
        units(Path("/a folder"), 8400, [])


def test_it_is_installed_and_removed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    done: list[Sequence[str]] = []

    def run(command: Sequence[str]) -> None:
        done.append((*command, str(sorted(file.name for file in tmp_path.iterdir()))))

    given = ["--repository", str(REPOSITORY), "--units", str(tmp_path)]
    there = str(sorted(UNITS))
    assert main(["install", "home:=studio", *given], run) == 0
    assert "http://127.0.0.1:8400/" in capsys.readouterr().out
    assert main(["remove", *given], run) == 0
    assert done == [
        ("systemctl", "daemon-reload", there),
        ("systemctl", "enable", "--now", *UNITS, there),
        ("systemctl", "disable", "--now", *UNITS, there),
        ("systemctl", "daemon-reload", "[]"),
    ]
    assert main(["remove", *given], run) == 1
    assert "nothing to remove" in capsys.readouterr().err
    assert main(["show", "home:=studio", *given], run) == 0
    assert "ExecStart=" in capsys.readouterr().out


def test_a_port_that_no_machine_has_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["show", "--port", "99999", "--repository", "/nowhere"])
    assert "--port: expected a whole number from 1 to 65535" in capsys.readouterr().err
