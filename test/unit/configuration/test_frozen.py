"""What every part of the configuration refuses, and how it says so."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, ClassVar

import pytest
from pydantic import ValidationError

from roomba.configuration.body import FanConfig
from roomba.configuration.bumping import BumpingConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.frozen import Frozen, load_config, read_yaml, validated
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.loops import LookingAroundConfig, TrackingConfig, WalkConfig
from roomba.configuration.mapping import WindowsConfig
from roomba.configuration.rooms import RoomsConfig
from roomba.configuration.seed import SeedParameters
from roomba.configuration.sensors import LidarConfig
from roomba.errors import ConfigError


class Ordered(Frozen):
    """Three numbers, the first two of which may be alike."""

    low: float = 1.0
    middle: float = 2.0
    high: float = 3.0

    in_order: ClassVar[tuple[str, ...]] = ("low <= middle < high",)


class Whole(Frozen):
    """A part of a whole."""

    part: Ordered = Ordered()
    places: tuple[float, ...] = ()
    is_whole: bool = True


@pytest.mark.parametrize("values", [(1.0, 2.0, 3.0), (2.0, 2.0, 3.0)])
def test_fields_in_order_are_taken(values: tuple[float, float, float]) -> None:
    low, middle, high = values
    assert Ordered(low=low, middle=middle, high=high).low == low


@pytest.mark.parametrize("values", [(2.1, 2.0, 3.0), (1.0, 3.0, 3.0), (1.0, 4.0, 3.0)])
def test_fields_out_of_order_are_refused(values: tuple[float, float, float]) -> None:
    low, middle, high = values
    said = f"expected low <= middle < high, got {low}, {middle}, {high}"
    with pytest.raises(ValidationError, match=said):
        Ordered(low=low, middle=middle, high=high)


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        ({"part": {"low": 5}}, "part: expected low <= middle < high, got 5.0, 2.0, 3.0"),
        ({"part": {"low": "x"}}, "part.low: expected a valid number, unable to parse"),
        (
            {"part": {"low": True}},
            "part.low: expected a number, got true, which yes and on are too",
        ),
        ({"places": [1, False]}, "places: expected a number, got false, which no and off are too"),
        ({"part": {"wings": 2}}, "part.wings: no such key, got 2"),
        ([1, 2], "expected keys and values (`key: value`), got [1, 2]"),
        ({"part": 3}, "part: expected keys and values (`key: value`), got 3"),
    ],
)
def test_a_refusal_is_one_line_that_names_the_key_once(raw: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        validated(Whole, raw, "a.yaml: ", "no such key")
    message = str(refusal.value)
    assert message.startswith(f"a.yaml: {said}")
    assert message.count("got") == 1
    assert "\n" not in message


def test_what_may_be_true_is_taken() -> None:
    assert not validated(Whole, {"is_whole": False}, "").is_whole


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("part:\n  low: 1\npart:\n  low: 2\n", 3),
        ("part:\n  low: 1\n  high: 9\n  low: 2\n", 4),
        ("- low: 1\n  low: 2\n", 2),
    ],
)
def test_a_key_that_is_there_twice_is_refused(tmp_path: Path, text: str, line: int) -> None:
    path = tmp_path / "twice.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=rf"twice\.yaml:{line}: expected each key once, got '"):
        load_config(Whole, path)


@pytest.mark.parametrize("text", ["", "# nothing\n", "{}\n"])
def test_an_empty_file_means_the_usual(tmp_path: Path, text: str) -> None:
    path = tmp_path / "empty.yaml"
    path.write_text(text, encoding="utf-8")
    assert read_yaml(path) == {}


@pytest.mark.parametrize("text", ["[]", "0", "false", "''"])
def test_what_holds_no_keys_is_no_empty_file(tmp_path: Path, text: str) -> None:
    path = tmp_path / "list.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=r"list\.yaml: expected keys and values"):
        load_config(Whole, path)


@pytest.mark.parametrize(
    ("model", "values"),
    [
        (FanConfig, {"standard": 0.2}),
        (LidarConfig, {"min_range": 12.0}),
        (LocalizationConfig, {"known_deviation": 1.0}),
        (LookingAroundConfig, {"shortest_leg": 1.6}),
        (LookingAroundConfig, {"tight_clearance": 0.1}),
        (TrackingConfig, {"slowest": 0.5}),
        (WalkConfig, {"tight_clearance": 0.05}),
        (RoomsConfig, {"widest_door": 0.5}),
        (RoomsConfig, {"tightest_passage": 0.6}),
        (SeedParameters, {"min_cordinate": 100.0}),
    ],
)
def test_the_order_of_sizes_is_kept(model: type[Frozen], values: dict[str, float]) -> None:
    with pytest.raises(ValidationError, match=f"expected .*{next(iter(values))}"):
        model.model_validate(values)


@pytest.mark.parametrize("value", [0.0, -1.0, 1e-12, 1e12, math.inf, math.nan])
@pytest.mark.parametrize(
    ("model", "name"),
    [
        (DockingConfig, "settle_time"),
        (DockingConfig, "staging_distance"),
        (DockingConfig, "creep_speed"),
        (DockingConfig, "turning_speed"),
        (BumpingConfig, "cell"),
        (WalkConfig, "braking"),
        (WalkConfig, "astray_timeout"),
        (LookingAroundConfig, "aimed"),
        (WindowsConfig, "widest"),
    ],
)
def test_what_no_robot_can_have_is_refused(model: type[Frozen], name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=rf"a\.yaml: {name}: expected .*, got"):
        validated(model, {name: value}, "a.yaml: ")
