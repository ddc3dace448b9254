"""Set-up of what needs no ROS, on a machine without it: no apt, an environment of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
FILES = (
    "install_dependencies.sh", "set_up.sh", "roomba", "constraints.txt", "requirements.txt",
    "requirements-library.txt", "requirements-dev.txt", "requirements-smart-home.txt",
    "requirements-campaign.txt",
)  # fmt: skip
DEADLINE = 900.0
"""s; the packages come from the network."""


class Checkout:
    """The files of the set-up, on a machine where dpkg knows no package and apt leaves a trace."""

    def __init__(self, folder: Path) -> None:
        """Copy the files."""
        self.folder, self.programs = folder / "checkout", folder / "programs"
        self.apt_was_called = folder / "apt-was-called"
        self.folder.mkdir()
        self.programs.mkdir()
        for name in FILES:
            shutil.copy2(REPOSITORY / name, self.folder)
        for name, body in (
            ("dpkg-query", "exit 1"),
            ("apt-get", f"touch {self.apt_was_called}; exit 1"),
        ):
            program = self.programs / name
            program.write_text(f"#!/bin/sh\n{body}\n")
            program.chmod(0o755)

    def run(self, *command: str) -> subprocess.CompletedProcess[str]:
        """Run a command in the checkout."""
        return subprocess.run(
            command,
            cwd=self.folder,
            env={
                "HOME": os.environ["HOME"],
                "LANG": "C.UTF-8",
                "PATH": f"{self.programs}:/usr/bin:/bin",
            },
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=DEADLINE,
            check=False,
        )


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Checkout:
    checkout = Checkout(tmp_path_factory.mktemp("library"))
    done = checkout.run("./install_dependencies.sh", "--library")
    assert done.returncode == 0, done.stdout + done.stderr
    return checkout


def test_apt_is_not_called_and_the_library_has_what_it_imports(checkout: Checkout) -> None:
    assert not checkout.apt_was_called.exists()
    program = "import cv2, numba, numpy, pydantic, yaml; print(cv2.__file__, numpy.__file__)"
    done = checkout.run(".venv/bin/python3", "-c", program)
    assert done.returncode == 0, done.stderr
    environment = checkout.folder / ".venv"
    assert all(Path(path).is_relative_to(environment) for path in done.stdout.split())


def test_the_environment_knows_no_package_of_the_distribution(checkout: Checkout) -> None:
    text = (checkout.folder / ".venv/pyvenv.cfg").read_text(encoding="utf-8")
    assert "include-system-site-packages = false" in text


def test_it_is_complete_for_the_library_and_not_for_the_robot(checkout: Checkout) -> None:
    script = """. ./install_dependencies.sh
for level in library runtime; do python_is_current $level && echo "$level is current"; done
library_is_current && echo done"""
    done = checkout.run("bash", "-c", script)
    assert done.stdout.splitlines() == ["library is current", "done"], done.stderr


def test_once_complete_nothing_is_installed(checkout: Checkout) -> None:
    done = checkout.run("./install_dependencies.sh", "--library")
    assert done.returncode == 0, done.stderr
    assert "Installing" not in done.stderr


def test_the_robot_still_asks_for_its_packages(checkout: Checkout) -> None:
    done = checkout.run("./install_dependencies.sh")
    assert done.returncode != 0
    assert checkout.apt_was_called.exists()
    assert (checkout.folder / ".venv/.stamp-library").exists()
