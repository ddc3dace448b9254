"""Where the files lie that come with the package: homes, the configuration's defaults, a model."""

from __future__ import annotations

from pathlib import Path
from typing import Final

_DATA: Final = Path(__file__).parents[1] / "data"
HOMES: Final = _DATA / "homes"
"""A folder for each home that comes along."""
CONFIGURATION: Final = _DATA / "configuration"
"""A YAML file for each part of the configuration, with every number's default."""
MODEL: Final = _DATA / "model"
"""The robot's model, for programs that draw it."""
