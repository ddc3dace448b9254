"""Validated, frozen configuration of making maps: ``configuration/mapping.yaml``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field

from roomba.configuration.frozen import Frozen, Positive, Ratio, load_config


class MappingConfig(Frozen):
    """Keyframes, submaps and their links: m, rad; the drawing: shares 0..1."""

    resolution: Positive = 0.05
    keyframe_way: Positive = 0.15
    keyframe_turn: Positive = 0.35
    submap_way: Positive = 3.0
    submap_keyframes: Annotated[int, Field(ge=4)] = 40
    point_deviation: Positive = 0.03
    least_met: Ratio = 0.35
    least_close: Ratio = 0.6
    link_radius: Positive = 5.0
    link_met: Ratio = 0.3
    link_close: Ratio = 0.8
    link_points: Annotated[int, Field(ge=50)] = 150
    drift: Positive = 0.03
    least_link_deviation: Positive = 0.004
    least_link_turn: Positive = 0.0015
    occupied_share: Ratio = 0.3
    occupied_beams: Annotated[int, Field(ge=1)] = 2
    redrawn_shift: Positive = 0.01


def load_mapping_config(path: Path) -> MappingConfig:
    """Read ``configuration/mapping.yaml`` or a file like it; raises ConfigError with the reason."""
    return load_config(MappingConfig, path)
