"""Every shipped configuration file is complete, equals the defaults, and gives reasons."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import BaseModel

from roomba.configuration.bumping import BumpingConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.frozen import Frozen, load_config
from roomba.configuration.household import HouseholdConfig
from roomba.configuration.mapping import MappingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.nodes import NodesConfig
from roomba.configuration.robot import RobotConfig
from roomba.configuration.rooms import RoomsConfig
from roomba.configuration.simulation import SimulationConfig
from roomba.configuration.things import ThingConfig
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION

MODELS: dict[str, type[Frozen]] = {
    "bumping": BumpingConfig,
    "docking": DockingConfig,
    "household": HouseholdConfig,
    "mapping": MappingConfig,
    "mission": MissionConfig,
    "nodes": NodesConfig,
    "robot": RobotConfig,
    "rooms": RoomsConfig,
    "simulation": SimulationConfig,
    "things": ThingConfig,
}


def unset(model: BaseModel, name: str = "") -> Iterator[str]:
    """Yield the fields, with those of all parts, that were not in the file."""
    for field in type(model).model_fields:
        if field not in model.model_fields_set:
            yield f"{name}{field}"
        elif isinstance(part := getattr(model, field), BaseModel):
            yield from unset(part, f"{name}{field}.")


def test_every_shipped_file_is_of_a_model() -> None:
    assert {path.stem for path in CONFIGURATION.glob("*.yaml")} == set(MODELS)


@pytest.mark.parametrize("name", MODELS)
def test_the_file_says_what_the_library_takes_without_a_file(name: str) -> None:
    assert load_config(MODELS[name], CONFIGURATION / f"{name}.yaml") == MODELS[name]()


@pytest.mark.parametrize("name", MODELS)
def test_the_file_has_every_number(name: str) -> None:
    found = list(unset(load_config(MODELS[name], CONFIGURATION / f"{name}.yaml")))
    # The lidar's numbers stand in files of their own, lidars/NAME.yaml.
    assert [number for number in found if number.split(".")[0] != "lidar"] == []


@pytest.mark.parametrize("name", MODELS)
def test_every_number_of_the_file_has_a_reason_beside_it(name: str) -> None:
    lines = (CONFIGURATION / f"{name}.yaml").read_text(encoding="utf-8").splitlines()
    values = [line for line in lines if line.strip() and not line.startswith("#")]
    parts = [line for line in values if line.endswith(":")]
    assert len(values) > 8
    assert [line for line in values if "  # " not in line and line not in parts] == []


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("docking", "creep_speed: 0.0"),
        ("docking", "max_attempts: 0"),
        ("docking", "colour: red"),
        ("rooms", "smallest_room: 1000.0"),
        ("rooms", "narrowing: 1.5"),
        ("mapping", "resolution: 0.0"),
        ("mapping", "keyframe_way: -1.0"),
        ("mapping", "link_met: 1.5"),
        ("mapping", "submap_keyframes: 3"),
        ("mapping", "occupied_beams: 0"),
        ("mapping", "drift: .nan"),
        ("mapping", "colour: red"),
        ("things", "gain: 0"),
        ("things", "farthest: .nan"),
    ],
)
def test_a_broken_value_is_refused_by_name(tmp_path: Path, name: str, text: str) -> None:
    path = tmp_path / f"{name}.yaml"
    path.write_text(f"{text}\n", encoding="utf-8")
    with pytest.raises(ConfigError, match=rf"{name}\.yaml: {text.split(':')[0]}"):
        load_config(MODELS[name], path)
