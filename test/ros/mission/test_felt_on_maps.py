"""Felt carpets and low things come back with their map, and with no other; without a graph."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rospy
from fixtures.robots.missions import HOME, TWO_ROOMS

from roomba.configuration.docking import DockingConfig
from roomba.configuration.mission import MissionConfig
from roomba.configuration.robot import RobotConfig
from roomba.mission.inputs.planning_context import PlanningContext
from roomba.perception.matching.surface_field import SurfaceField
from roomba.perception.rooms.felt_carpets import FeltCarpets
from roomba.perception.rooms.low_things import LowThing, LowThings
from roomba.perception.rooms.zones import Zones
from roomba.storage.map_bound import map_digest
from roomba.world.home.home import Home
from roomba_ros.mission.felt_on_maps import CARPETS, LOW_THINGS, FeltKind, FeltOnMaps
from roomba_ros.mission.known_home import GROWING, KnownHome
from roomba_ros.runtime.background import Background

CARPET = FeltCarpets((((1.0, 1.0), (1.5, 1.0), (1.5, 1.5)),))
THING = LowThings((LowThing(0.6, 0.6, 0.9, 0.6, 3),))
BOTH = pytest.mark.parametrize(("kind", "felt"), [(CARPETS, CARPET), (LOW_THINGS, THING)])


def known(home: Home, digest: str = "") -> KnownHome:
    """A home whose map is known, or one of which a map is being made."""
    configs = RobotConfig(), MissionConfig(), DockingConfig()
    context = PlanningContext(home.map, home.station, *configs, None, Zones())
    return KnownHome(context, SurfaceField.unknown(), digest or map_digest(home.map))


@pytest.fixture
def background() -> Background:
    return Background()


@pytest.fixture
def warnings(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    told = list[str]()
    monkeypatch.setattr(rospy, "logwarn", lambda line, *parts: told.append(line % parts))
    return told


@BOTH
def test_it_comes_back_with_its_map_alone(
    kind: FeltKind[Any], felt: Any, background: Background, tmp_path: Path
) -> None:
    home, memory = known(HOME), FeltOnMaps(kind, background, tmp_path)
    assert memory.recalled(home) == kind.nothing
    memory.keep(home, felt)
    background.work_off()
    assert memory.recalled(home) == felt
    assert memory.recalled(known(TWO_ROOMS)) == kind.nothing


@BOTH
def test_of_a_map_that_is_being_made_nothing_is_remembered(
    kind: FeltKind[Any], felt: Any, background: Background, tmp_path: Path
) -> None:
    home, memory = known(HOME, GROWING), FeltOnMaps(kind, background, tmp_path)
    memory.keep(home, felt)
    background.work_off()
    assert memory.recalled(home) == kind.nothing
    assert list(tmp_path.iterdir()) == []


@BOTH
@pytest.mark.parametrize("spoil", [lambda _: b"\0 no text", lambda whole: whole[: len(whole) // 2]])
def test_what_cannot_be_read_is_felt_anew_and_told(
    kind: FeltKind[Any],
    felt: Any,
    spoil: Callable[[bytes], bytes],
    background: Background,
    warnings: list[str],
    tmp_path: Path,
) -> None:
    home, memory = known(HOME), FeltOnMaps(kind, background, tmp_path)
    memory.keep(home, felt)
    background.work_off()
    (path,) = tmp_path.iterdir()
    path.write_bytes(spoil(path.read_bytes()))
    assert memory.recalled(home) == kind.nothing
    (line,) = warnings
    assert line.startswith(f"{kind.words} are felt anew: {path}: ")
