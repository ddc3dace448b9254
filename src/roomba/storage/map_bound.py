"""YAML files that belong to one map: each names its map by a digest."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from roomba.errors import RoombaError
from roomba.files.bounded import read_bytes
from roomba.files.kept import KeptFileError, read_kept, unsealed, write_kept
from roomba.files.plain_yaml import load_with_nodes
from roomba.files.strict_yaml import repeated_key
from roomba.geometry import FARTHEST
from roomba.grid import OccupancyMap

Tell = Callable[[str], object]
"""A callback that is told in a sentence when a damaged file was set aside."""
Number = Annotated[float, Field(ge=-FARTHEST, le=FARTHEST)]
"""m."""


class Entry(BaseModel):
    """A part of such a file; unknown keys are ignored."""

    model_config = ConfigDict(extra="ignore", frozen=True)


class MapBound(Entry):
    """Such a file: ``map`` is the digest of its map."""

    map: str


_File = TypeVar("_File", bound=MapBound)


def yaml_text(value: dict[str, object]) -> str:
    """Return a value of plain Python as YAML for people to read; printable text comes back."""
    return yaml.safe_dump(
        value,
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=None,
        width=100,
    )


def map_digest(occupancy: OccupancyMap) -> str:
    """Return a map's digest: the SHA-256 of its frame and values, hexadecimal."""
    frame = occupancy.frame
    place = f"{frame.resolution:.6f} {frame.origin_x:.6f} {frame.origin_y:.6f} {frame.shape}"
    return hashlib.sha256(place.encode() + occupancy.values.tobytes()).hexdigest()


def map_file_name(digest: str) -> str:
    """Return by what name files of a map lie in a folder: the first digits of its digest."""
    return digest[:16]


def save_map_bound(
    path: Path, digest: str, key: str, entries: list[dict[str, object]], comment: str
) -> None:
    """Write the entries of the map of a ``digest`` under ``key``, atomically.

    Raises OSError when the disk refuses.
    """
    # JSON is YAML, and 30 times as fast to write; one entry a line is as good to read.
    lines = [f"- {json.dumps(entry, ensure_ascii=False)}" for entry in entries]
    head = [f"# {comment}", f"map: {json.dumps(digest)}", f"{key}:" if lines else f"{key}: []"]
    write_kept(path, "\n".join([*head, *lines, ""]).encode())


def load_map_bound(
    path: Path,
    digest: str,
    kind: type[_File],
    what: str,
    error: type[RoombaError],
    tell: Tell | None = None,
) -> _File | None:
    """Return the file of the map of a ``digest``, None if there is none.

    ``what`` names for people, in the plural, what the file holds.

    With ``tell`` a damaged file is set aside, the one before it is used, and ``tell`` is told so.
    Raises ``error``, which names the file and the reason, for one that cannot be read or is of
    another map.
    """

    def parse(content: bytes) -> _File:
        try:
            values, root = load_with_nodes(content.decode("utf-8"))
            if repeated := repeated_key(root):
                raise error(f"line {repeated.told}")
            return kind.model_validate(values)
        except (UnicodeDecodeError, yaml.YAMLError) as cause:
            raise error(f"expected a file of {what} in YAML: {cause}") from cause
        except ValidationError as cause:
            first = cause.errors()[0]
            where = ".".join(str(part) for part in first["loc"])
            raise error(f"{where}: {first['msg']}, got {first['input']!r}") from cause

    try:
        file = read_kept(path, parse, tell) if tell else parse(unsealed(read_bytes(path)))
    except KeptFileError as cause:
        raise error(str(cause)) from cause
    except FileNotFoundError:
        return None
    except OSError as cause:
        raise error(f"{path}: expected a file of {what} in YAML: {cause}") from cause
    except RoombaError as cause:
        raise error(f"{path}: {cause}") from cause
    if file is None:
        return None
    if file.map != digest:
        raise error(
            f"{path}: expected the {what} of this map, got those of another; remove the file, or "
            "bring its map back"
        )
    return file
