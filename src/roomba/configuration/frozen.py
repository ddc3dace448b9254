"""What all configuration is made of: frozen, validated models, read from YAML files."""

from __future__ import annotations

import math
import operator
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from roomba.errors import ConfigError
from roomba.files.bounded import read_text
from roomba.files.plain_yaml import load_yaml

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Ratio = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Degrees = Annotated[float, Field(ge=-180.0, le=180.0)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Acute = Annotated[float, Field(gt=0.0, lt=math.pi / 2)]
"""rad; less than a right angle."""
Count = Annotated[int, Field(ge=0)]
AtLeastOne = Annotated[int, Field(ge=1)]

_SIGNS: Final = {"<": operator.lt, "<=": operator.le}
_Model = TypeVar("_Model", bound=BaseModel)


class Frozen(BaseModel):
    """A part of a configuration: what it does not know it refuses.

    ``in_order`` has relations that its fields must keep, such as ``low <= middle < high``.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)
    in_order: ClassVar[tuple[str, ...]] = ()

    @model_validator(mode="after")
    def _fields_in_order(self) -> Frozen:
        for relation in self.in_order:
            names, signs = relation.split()[::2], relation.split()[1::2]
            values = [getattr(self, name) for name in names]
            pairs = zip(signs, pairwise(values), strict=True)
            if not all(_SIGNS[sign](*pair) for sign, pair in pairs):
                raise ValueError(f"expected {relation}, got {', '.join(map(str, values))}")
        return self


def load_config(model: type[_Model], path: Path) -> _Model:
    """Read a file of some configuration; raises :class:`ConfigError` with the reason."""
    return validated(model, read_yaml(path), f"{path}: ")


def read_yaml(path: Path) -> Any:
    """Return what a YAML file holds, an empty mapping for an empty file; raises ConfigError."""
    try:
        raw = load_yaml(read_text(path))
    except UnicodeDecodeError as error:
        raise ConfigError(
            f"{path}: expected UTF-8 text, got other bytes; save it as UTF-8"
        ) from error
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
        match first["type"]:
            case "value_error":  # raised by a validator of the model, which says what it got
                reason = first["msg"].removeprefix("Value error, ")
            case "extra_forbidden":
                reason = f"{unknown}, got {first['input']!r}"
            case "model_type" | "dict_type":
                reason = f"expected keys and values (`key: value`), got {first['input']!r}"
            case "missing":
                reason = "expected a value, got nothing; add it"
            case _:
                told = first["msg"].replace("Input should be", "expected")
                reason = f"{told}, got {first['input']!r}"
        raise ConfigError(f"{where}{name}: {reason}" if name else f"{where}{reason}") from error
