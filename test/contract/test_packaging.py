"""pyproject.toml, requirements.txt and setup.py agree about the Python packages."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).parents[2]
OF_THE_DISTRIBUTION = {"numpy", "opencv-python-headless", "pyyaml", "tzdata"}
"""In a checkout with ROS these come from the distribution's packages."""


KEYS = {
    "h11": None,  # uvicorn needs it, so it comes with that
    "tzdata": None,  # Python looks into the system's
    "python-dateutil": "python3-dateutil",
    "opencv-python-headless": "python3-opencv",
    "pillow": "python3-pil",
    "pyserial": "python3-serial",
    "pyyaml": "python3-yaml",
    "rosbags": "python3-rosbags-pip",
    "xacro": "xacro",
}
"""The keys of rosdep that are not python3- and the package's name."""


def names(lines: list[str]) -> dict[str, str]:
    """Return the bounds of each package."""
    found = (re.fullmatch(r"([a-zA-Z][a-zA-Z0-9-]*)(.*)", line.strip()) for line in lines)
    return {match[1].lower(): match[2] for match in found if match}


def test_a_checkout_and_the_wheel_need_the_same() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    table = text.split("\ndependencies = [")[1].split("\n]")[0]
    wheel = names(re.findall(r'"([^"]+)"', table))
    checkout = names((ROOT / "requirements.txt").read_text(encoding="utf-8").splitlines())
    assert len(checkout) >= 7
    assert wheel.keys() - checkout.keys() == OF_THE_DISTRIBUTION
    assert {name: wheel.get(name) for name in checkout} == checkout


def test_package_xml_names_each_python_package() -> None:
    checkout = names((ROOT / "requirements.txt").read_text(encoding="utf-8").splitlines())
    needed = {KEYS.get(name, f"python3-{name}") for name in checkout.keys() | OF_THE_DISTRIBUTION}
    rows = ElementTree.parse(ROOT / "package.xml").iter("exec_depend")
    keys = {row.text for row in rows if row.text}
    python = {key for key in keys if key.startswith("python3-")} | {"xacro"} & keys
    assert python == needed - {None}


def test_the_version_is_that_of_package_xml() -> None:
    done = subprocess.run(
        [sys.executable, "setup.py", "--version"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
        timeout=60.0,
    )
    version = ElementTree.parse(ROOT / "package.xml").findtext("version")
    assert done.stdout.split()[-1] == version
