"""docs/sensors.md is complete: every topic, fault, number and picture."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from roomba.commands.pictures.__main__ import FILMS, IN_BROWSER, IN_RVIZ, PICTURES
from roomba.configuration.simulation import load_simulated_config
from roomba.files.shipped import CONFIGURATION
from roomba.world.engine.state.arrays import Fault

ROOT = Path(__file__).parents[4]
INTERFACE = (ROOT / "docs" / "ros_interface.md").read_text(encoding="utf-8")
PAGE = (ROOT / "docs" / "sensors.md").read_text(encoding="utf-8")
SECTIONS = ("body", "brush", "fan", "battery", "lidar", "wheels", "wear", "gyro", "cliff",
            "station", "dirt_sensor", "camera", "surroundings", "health")  # fmt: skip


def names_of_faults() -> set[str]:
    text = (ROOT / "srv" / "InjectFault.srv").read_text(encoding="utf-8").split("float32 value")[0]
    return set(re.findall(r"[a-z]+(?:_[a-z]+)*(?=[,;\n (])", text.split("string fault")[1])) - {
        "or",
        "unit",
        "no",
    }


def numbers() -> list[tuple[str, str, object]]:
    config = load_simulated_config(CONFIGURATION / "robot.yaml", CONFIGURATION / "simulation.yaml")
    return [
        (section, name, value)
        for numbers in (config, config.simulation)
        for section in SECTIONS
        if hasattr(numbers, section)
        for name, value in getattr(numbers, section).model_dump().items()
        if not isinstance(value, str)
    ]


def test_every_topic_of_the_simulator_is_there() -> None:
    row = next(line for line in INTERFACE.splitlines() if line.startswith("| `home_sim_node`"))
    topics = set(re.findall(r"`(/[a-z_/]+)`", row)) - {"/cmd_vel_out", "/emergency_stop", "/pose"}
    topics -= {topic for topic in topics if topic.endswith("/progress")}
    assert len(topics) > 25
    assert topics - set(re.findall(r"`(/[a-z_/]+)`", PAGE)) == set()


def test_every_fault_is_there() -> None:
    wanted = {fault.name.lower() for fault in Fault} | names_of_faults()
    assert {"slip", "put", "obstacle", "dirt_sensor_blocked"} <= wanted
    assert {name for name in wanted if f"`{name}`" not in PAGE} == set()


@pytest.mark.parametrize(("section", "name", "value"), numbers())
def test_every_number_of_the_robot_is_there_as_it_is(
    section: str, name: str, value: object
) -> None:
    lines = [line for line in PAGE.splitlines() if re.search(rf"[`.]{name}`", line)]
    assert lines, f"{section}.{name} is not on the page"
    for part in value if isinstance(value, tuple) else (value,):
        assert isinstance(part, int | float)
        number = f"{part:f}".rstrip("0").rstrip(".")
        shown = str(part).lower() if isinstance(part, bool) else number
        assert any(shown in line for line in lines), f"{section}.{name} is {shown}; {lines}"


def test_every_picture_of_the_documents_exists_and_is_made_by_the_command() -> None:
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    for folder in ("algorithms", "tutorials"):
        pages += (ROOT / "docs" / folder).glob("*.md")
    linked = {
        (page.parent / link).resolve()
        for page in pages
        for link in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8"))
    }
    assert {path for path in linked if not path.is_file()} == set()
    files = [f"{name}.png" for name in (*PICTURES, *IN_BROWSER, IN_RVIZ)]
    files += [f"{name}.webp" for name in FILMS]
    made = {(ROOT / "docs" / "pictures" / file).resolve() for file in files}
    # Made of drives and maps of real robots, which the repository does not hold; and by a campaign,
    # with the line that stands below its picture. Demonstrations take as long as the runs that they
    # show, by a command of their own.
    drives = (f"drive_{name}.png" for name in ("intel", "fr079", "breezy", "wean"))
    shown = [
        f"demonstration_{robot}{what}"
        for robot in ("neato", "create2")
        for what in (".png", "_map.webp", "_report.png")
    ]
    others = {
        (ROOT / "docs" / "pictures" / name).resolve()
        for name in (
            *drives, *shown, "covariances.png", "rooms_beside_truth.png", "campaign.png",
        )
    }  # fmt: skip
    assert linked - made == others
    # Two rooms are made, but not shown.
    assert {path.stem for path in made - linked} == {"bathroom", "bedroom"}


def test_every_link_within_the_page_leads_somewhere() -> None:
    headings = re.findall(r"^#+ (.+)$", PAGE, re.MULTILINE)
    anchors = {
        re.sub(r"[^a-z0-9 -]", "", heading.lower()).replace(" ", "-") for heading in headings
    }
    assert set(re.findall(r"\]\(#([^)]+)\)", PAGE)) - anchors == set()
