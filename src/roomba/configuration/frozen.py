"""What all configuration is made of: frozen, validated models, read from YAML files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from roomba.errors import ConfigError

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Ratio = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Degrees = Annotated[float, Field(ge=-180.0, le=180.0)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]

_Model = TypeVar("_Model", bound=BaseModel)


class Frozen(BaseModel):
    """A part of a configuration: what it does not know it refuses."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


def load_config(model: type[_Model], path: Path) -> _Model:
    """Read a file of some configuration; raises :class:`ConfigError` with the reason."""
    return validated(model, read_yaml(path), f"{path}: ")


def read_yaml(path: Path) -> Any:
    """Return what a YAML file holds, an empty mapping for an empty file; raises ConfigError."""
    try:
        raw = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise ConfigError(f"{path}: cannot be read as YAML: {error}") from error
    return raw or {}


def validated(
    model: type[_Model], raw: Any, where: str, unknown: str = "Extra inputs are not permitted"
) -> _Model:
    """Return ``raw`` as a model; raises ConfigError, one line that begins with ``where``.

    ``unknown`` is what the line says of a key that the model does not have.
    """
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        first = error.errors()[0]
        name = ".".join(str(part) for part in first["loc"])
        reason = first["msg"].removeprefix("Value error, ")
        if first["type"] == "extra_forbidden":
            reason = unknown
        got = f", got {first['input']!r}" if name else ""
        raise ConfigError(f"{where}{name}: {reason}{got}".replace(": :", ":")) from error
