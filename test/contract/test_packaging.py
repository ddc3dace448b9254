"""All files that list Python packages, or give the version, agree."""

from __future__ import annotations

import re
import subprocess
import sys
from datetime import datetime
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from catkin_pkg.changelog import get_changelog_from_path

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


@pytest.mark.parametrize(
    "command",
    [(sys.executable, "setup.py", "--version"), ("./roomba", "version"), ("./roomba", "--version")],
)
def test_the_version_that_is_told_is_that_of_package_xml(command: tuple[str, ...]) -> None:
    done = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, check=True, timeout=60.0
    )
    assert done.stdout.split()[-1] == version()


def test_the_pages_name_that_version() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    install = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    assert citation["version"] == version()
    assert re.findall(r"roomba_robot-([0-9.]+)-py3", install) == [version()]


def test_the_newest_release_of_the_changelog_is_that_version() -> None:
    newest, date, _ = newest_release()
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert newest == version()
    assert date.date() == citation["date-released"]


def test_catkin_reads_each_entry_of_the_newest_release() -> None:
    """It leaves out what is below a heading of its own."""
    newest, date, content = newest_release()
    text = (ROOT / "CHANGELOG.rst").read_text(encoding="utf-8")
    sections = re.split(r"^(.+)\n-{5,}\n", text, flags=re.MULTILINE)
    written = sections[sections.index(f"{newest} ({date:%Y-%m-%d})") + 1]
    read = "\n".join(str(part) for part in content)
    entries = re.compile(r"^\* ", re.MULTILINE)
    assert len(entries.findall(written)) > 1
    assert len(entries.findall(read)) == len(entries.findall(written))


def newest_release() -> tuple[str, datetime, list[object]]:
    """Return version, date and content of the newest release, as catkin reads the changelog."""
    changelog = get_changelog_from_path(str(ROOT))
    release: tuple[str, datetime, list[object]] = next(changelog.foreach_version(reverse=True))
    return release


def version() -> str | None:
    """Return the version that package.xml says."""
    return ElementTree.parse(ROOT / "package.xml").findtext("version")
