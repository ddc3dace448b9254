"""Without ROS 1, commands that need it say so, with what to do; no other command asks for it."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).resolve().parents[3]
FILES = (
    "roomba",
    "set_up.sh",
    "install_dependencies.sh",
    *(path.name for path in ROOT.glob("*.txt")),
)
NOBLE = 'PRETTY_NAME="Ubuntu 24.04.1 LTS"\nVERSION_CODENAME=noble\nUBUNTU_CODENAME=noble\n'
FEDORA = 'PRETTY_NAME="Fedora Linux 41 (Workstation Edition)"\nVERSION_CODENAME=""\n'
BOOKWORM = 'PRETTY_NAME="Debian GNU/Linux 12 (bookworm)"\nVERSION_CODENAME=bookworm\n'
SYSTEMS = {"noble": NOBLE, "fedora": FEDORA, "bookworm": BOOKWORM}
PROGRAMS = (
    "bash", "basename", "cat", "comm", "cut", "dirname", "env", "find", "flock", "grep", "mkdir",
    "mktemp", "mv", "python3", "readlink", "rm", "sed", "sha256sum", "sort", "tail",
    "tput", "xargs",
)  # fmt: skip


class Machine:
    """A fresh checkout on another system, where apt leaves a trace."""

    def __init__(self, folder: Path, system: str, has_dpkg: bool) -> None:
        """Write what the system says of itself, and the programs that it has."""
        self.folder, programs = folder / "checkout", folder / "programs"
        self.folder.mkdir()
        programs.mkdir()
        for name in FILES:
            shutil.copy2(ROOT / name, self.folder)
        for name in ("src", "test"):
            (self.folder / name).symlink_to(ROOT / name)
        (folder / "os-release").write_text(SYSTEMS[system], encoding="utf-8")
        script = self.folder / "install_dependencies.sh"
        text = script.read_text(encoding="utf-8")
        assert "OS_RELEASE=/etc/os-release" in text
        script.write_text(
            text.replace("OS_RELEASE=/etc/os-release", f"OS_RELEASE={folder / 'os-release'}"),
            encoding="utf-8",
        )
        for name in PROGRAMS:
            found = shutil.which(name)
            assert found is not None, name
            (programs / name).symlink_to(found)
        self.apt_was_called = folder / "apt-was-called"
        made = {"apt-get": f"touch {self.apt_was_called}; exit 1"}
        if has_dpkg:
            made["dpkg-query"] = "exit 1"
        for name, body in made.items():
            (programs / name).write_text(f"#!/bin/sh\n{body}\n", encoding="utf-8")
            (programs / name).chmod(0o755)
        self._path = programs

    def roomba(self, *words: str) -> subprocess.CompletedProcess[str]:
        """Run the one command."""
        return self.bash('./roomba "$@"', *words)

    def bash(self, script: str, *words: str) -> subprocess.CompletedProcess[str]:
        """Run a script in the checkout."""
        return subprocess.run(
            [self._path / "bash", "-c", script, "bash", *words],
            cwd=self.folder,
            env={"HOME": str(self.folder), "LANG": "C.UTF-8", "PATH": str(self._path)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=60.0,
            check=False,
        )


@pytest.mark.parametrize(
    ("system", "has_dpkg", "why"),
    [
        ("noble", True, "this is Ubuntu 24.04.1 LTS"),
        ("fedora", False, "this is Fedora Linux 41"),
        ("bookworm", False, "expected dpkg-query, which tells what packages there are, on Debian"),
    ],
)
@pytest.mark.parametrize(
    "words",
    [
        ("run",),
        ("camera",),
        ("control", "robot:=other"),
        ("exec", "rostopic", "list"),
        ("record",),
        ("sim", "--bag", "a.bag"),
        ("test", "unit"),
    ],
)
def test_what_needs_ros_says_so_before_it_installs_anything(
    tmp_path: Path, system: str, has_dpkg: bool, why: str, words: tuple[str, ...]
) -> None:
    machine = Machine(tmp_path, system, has_dpkg)
    done = machine.roomba(*words)
    assert done.returncode == 1
    assert "error: this needs ROS 1: expected " in done.stderr
    assert why in done.stderr
    assert "In a container of Debian: podman build" in done.stderr
    assert "Without ROS: ./roomba play, sim" in done.stderr
    assert not machine.apt_was_called.exists()
    assert not (machine.folder / ".venv").exists()


@pytest.mark.parametrize(
    ("system", "part"), [("fedora", "library"), ("noble", "library"), ("bookworm", "runtime")]
)
def test_python_is_that_of_the_library_where_there_is_no_ros(
    tmp_path: Path, system: str, part: str
) -> None:
    script = """sed '/^main /d' roomba >parts; source ./parts
        set_up() { echo "set up: $1"; }
        enter_library() { :; }
        enter_environment() { :; }
        main exec python3 -c 'print("it ran")'"""
    done = Machine(tmp_path, system, system == "bookworm").bash(script)
    assert done.stdout.splitlines() == [f"set up: {part}", "it ran"], done.stderr


@pytest.mark.parametrize("system", ["fedora", "noble"])
def test_the_doctor_says_it_too(tmp_path: Path, system: str) -> None:
    done = Machine(tmp_path, system, system == "noble").roomba("doctor")
    assert done.returncode == 1
    (line,) = (line for line in done.stdout.splitlines() if "missing system packages: " in line)
    assert "whose own packages hold ROS 1; this is " in line
    assert "to mend it: run in a container of Debian: docs/install.md" in done.stdout
    lines = [line.strip() for line in done.stdout.splitlines()]
    assert "to mend it: ./roomba run" not in lines


def test_without_dpkg_nothing_counts_as_current(tmp_path: Path) -> None:
    script = "source ./install_dependencies.sh; system_is_current runtime && echo current"
    assert "current" not in Machine(tmp_path, "bookworm", False).bash(script).stdout


def test_the_library_needs_no_ros_anywhere(tmp_path: Path) -> None:
    script = """source ./install_dependencies.sh
        make_library_environment() { echo "the library's environment"; }
        install_dependencies library"""
    done = Machine(tmp_path, "fedora", False).bash(script)
    assert done.returncode == 0, done.stderr
    log = Path(tmp_path / "checkout/.cache/logs/make_library_environment.log")
    assert log.read_text(encoding="utf-8") == "the library's environment\n"


def containerfile() -> str:
    return (ROOT / "Containerfile").read_text(encoding="utf-8")


def test_the_container_is_of_a_system_with_ros() -> None:
    base = re.search(r"^FROM debian:(\d+)", containerfile(), re.MULTILINE)
    script = (ROOT / "install_dependencies.sh").read_text(encoding="utf-8")
    assert base is not None
    assert f"Debian {base[1]} (" in script


def test_the_container_starts_the_robot_with_arguments_that_there_are() -> None:
    words = re.findall(r'"([^"]+)"', containerfile())
    assert words[:2] == ["./roomba", "run"]
    launch = ElementTree.parse(ROOT / "launch" / "roomba_robot.launch").getroot()
    known = {arg.get("name") for arg in launch.iter("arg")}
    assert {word.partition(":=")[0] for word in words[2:]} <= known
    port = re.search(r"^EXPOSE (\d+)$", containerfile(), re.MULTILINE)
    assert port is not None
    assert f"page_port:={port[1]}" in words
    assert f":{port[1]} " in (ROOT / "docs" / "install.md").read_text(encoding="utf-8")


def test_a_change_of_the_sources_or_of_the_tests_requirements_installs_nothing_again() -> None:
    text = containerfile()
    assert text.index("&& ./install_dependencies.sh") < text.index("\nCOPY . .")
    copied = re.search(r"^COPY (.+) \./$", text, re.MULTILINE)
    assert copied is not None
    assert copied[1].split() == ["install_dependencies.sh", "constraints.txt", "requirements.txt"]


def test_the_container_takes_nothing_that_was_made_on_this_machine() -> None:
    ignored = (ROOT / ".dockerignore").read_text(encoding="utf-8").split()
    assert {".cache", ".git", ".venv*", ".workspace"} <= set(ignored)
