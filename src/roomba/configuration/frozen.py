"""What all configuration is made of: frozen, validated models, read from YAML files."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, TypeVar

import yaml
from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    model_validator,
)
from pydantic_core import ErrorDetails

from roomba.errors import ConfigError
from roomba.files.bounded import read_text
from roomba.files.plain_yaml import load_with_nodes
from roomba.files.strict_yaml import repeated_key

_LARGEST: Final = 1e9

Positive = Annotated[float, Field(ge=1.0 / _LARGEST, le=_LARGEST)]
"""Positive numbers that have no type of their own: areas, gains, worths."""
NotNegative = Annotated[float, Field(ge=0.0, le=_LARGEST)]
Ratio = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Degrees = Annotated[float, Field(ge=-180.0, le=180.0)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Length = Annotated[float, Field(ge=1e-9, le=10_000.0)]
"""m; of ways, ranges and tolerances."""
Clearance = Annotated[float, Field(ge=1e-4, le=1.0)]
"""m; between the body and what stands: a home has no more room."""
ShortWay = Annotated[float, Field(ge=1e-4, le=1.0)]
"""m of a path, around one place of it: a longer one would reach across a room: things anywhere
in it would be in the way, and bends would not be where they were planned."""
Side = Annotated[float, Field(ge=0.01, le=2.0)]
"""m; of the robot and its parts."""
Cell = Annotated[float, Field(ge=0.01, le=0.5)]
"""m; side of a grid's cells."""
Duration = Annotated[float, Field(ge=0.001, le=86_400.0)]
"""s, up to a day."""
Wait = Annotated[float, Field(ge=0.001, le=600.0)]
"""s that the robot may stand still for."""
Patience = Annotated[float, Field(ge=1.0, le=86_400.0)]
"""s; in less time a robot that speeds up makes no progress, and would count as held."""
WaitOrNone = Annotated[float, Field(ge=0.0, le=600.0)]
Period = Annotated[float, Field(ge=0.001, le=10.0)]
"""s; of what is done again and again."""
TurningSpeed = Annotated[float, Field(ge=0.001, le=50.0)]
"""rad/s."""
Acceleration = Annotated[float, Field(ge=0.01, le=_LARGEST)]
"""m/s2, or rad/s2; the largest are as good as at once."""
Angle = Annotated[float, Field(ge=1e-4, le=2.0 * math.pi)]
"""rad."""
Acute = Annotated[float, Field(gt=0.0, lt=math.pi / 2)]
"""rad; less than a right angle."""
Count = Annotated[int, Field(ge=0, le=1_000_000)]
AtLeastOne = Annotated[int, Field(ge=1, le=1_000_000)]

_SIGNS: Final = {"<": operator.lt, "<=": operator.le}
_Model = TypeVar("_Model", bound=BaseModel)


class Frozen(BaseModel):
    """A part of a configuration; it refuses keys that it does not know.

    ``in_order`` lists relations that its fields must keep, such as ``low <= middle < high``.
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
    """Return what a YAML file holds, an empty mapping for an empty file.

    Raises ConfigError for what is no YAML, and for a key that is there twice.
    """
    try:
        raw, root = load_with_nodes(read_text(path))
    except UnicodeDecodeError as error:
        raise ConfigError(
            f"{path}: expected UTF-8 text, got other bytes; save it as UTF-8"
        ) from error
    except (OSError, yaml.YAMLError) as error:
        raise ConfigError(f"{path}: cannot be read as YAML: {error}") from error
    if repeated := repeated_key(root):
        raise ConfigError(f"{path}:{repeated.told}")
    return {} if raw is None else raw


def validated(
    model: type[_Model], raw: Any, where: str, unknown: str = "Extra inputs are not permitted"
) -> _Model:
    """Return ``raw`` as a model; raises ConfigError, one line that begins with ``where``.

    ``unknown`` is what the line says of a key that the model does not have.
    """
    try:
        made = model.model_validate(raw)
    except ValidationError as error:
        first = error.errors()[0]
        name = ".".join(str(part) for part in _place_in(raw, first))
        match first["type"]:
            case "value_error":  # raised by a validator of the model, which says what it got
                reason = first["msg"].removeprefix("Value error, ")
            case "extra_forbidden":
                reason = f"{unknown}, got {first['input']!r}"
            case "model_type" | "dict_type":
                reason = f"expected keys and values (`key: value`), got {first['input']!r}"
            case "tuple_type" | "list_type":
                reason = f"expected a list (`[value, value]`), got {first['input']!r}"
            case "missing":
                reason = "expected a value, got nothing; add it"
            case _:
                told = first["msg"].replace("Input should be", "expected")
                reason = f"{told}, got {first['input']!r}"
        raise ConfigError(f"{where}{name}: {reason}" if name else f"{where}{reason}") from error
    for reason in truths_as_numbers(raw, made):
        raise ConfigError(f"{where}{reason}")
    return made


def truths_as_numbers(raw: Any, made: Any, name: str = "") -> Iterator[str]:
    """Yield a fault for each number that pydantic ``made`` of a truth value, which it permits."""
    if isinstance(raw, bool) and isinstance(made, int | float) and not isinstance(made, bool):
        got = "true, which yes and on are too" if raw else "false, which no and off are too"
        yield f"{name}: expected a number, got {got}"
    elif isinstance(raw, Mapping) and isinstance(made, BaseModel):
        for key, value in raw.items():
            part = getattr(made, str(key), None)
            yield from truths_as_numbers(value, part, f"{name}.{key}" if name else str(key))
    elif isinstance(raw, list | tuple) and isinstance(made, list | tuple):
        for value, part in zip(raw, made, strict=False):
            yield from truths_as_numbers(value, part, name)


def _place_in(raw: Any, error: ErrorDetails) -> list[int | str]:
    """Return the keys and indices of a value, without pydantic's names of the types tried on it."""
    place: list[int | str] = []
    for part in error["loc"]:
        held = raw if isinstance(raw, Mapping) else {}
        if isinstance(raw, list | tuple):
            held = dict(enumerate(raw))
        if part in held:
            place.append(part)
            raw = held[part]
    return [*place, error["loc"][-1]] if error["type"] == "missing" else place
