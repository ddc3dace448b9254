"""A map that is being made, on disk: plain arrays in one file, replaced atomically."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from roomba.errors import RoombaError
from roomba.files.arrays import read_arrays
from roomba.files.kept import KeptFileError, read_kept, remove_kept, write_kept
from roomba.geometry import Pose
from roomba.perception.slam.mapper_state import LidarNumbers, MapperState
from roomba.perception.slam.mirrors.mirror import KeptMirror
from roomba.perception.slam.scan_matching.surface_kernels import POINT
from roomba.perception.slam.submaps.pose_graph import Link, LinkKind
from roomba.perception.slam.submaps.submap import KeptSubmap, Keyframe
from roomba.storage.array_fields import ArrayFields

FORMAT: Final = 1
"""Number of the file's format; another number is another format."""
_LINK_KINDS: Final = (LinkKind.MATCHED, LinkKind.DRIVEN, LinkKind.GUESSED, LinkKind.TOLD)
"""A file stores a kind as its index here."""
_MOST_BEAMS: Final = 100_000
_MOST_BYTES: Final = 1_000_000_000
"""Most bytes of the file; the points of a drive of hours have a tenth."""


class MapperFileError(RoombaError):
    """A file that cannot be used; the message names it and says why."""


@dataclass(frozen=True, slots=True, eq=False)
class KeptMap:
    """A map that is being made, and what its maker knows beside it.

    ``run`` names the launch of the robot. ``station`` is where the docked robot stands, map frame,
    None while that is not known; ``station_from_start`` the same seen from where the map began.
    ``taken_up`` is how often it was resumed without progress.
    """

    state: MapperState
    run: str
    station: Pose | None = None
    station_from_start: Pose | None = None
    taken_up: int = 0


def save_mapper(kept: KeptMap, path: Path) -> None:
    """Write a map that is being made; raises OSError when the disk refuses."""
    packed = io.BytesIO()
    np.savez(packed, **_arrays_of(kept))
    write_kept(path, packed.getvalue(), FORMAT, most=_MOST_BYTES)


def load_mapper(path: Path, tell: Callable[[str], object]) -> KeptMap | None:
    """Return what was saved, bit for bit; None if nothing was.

    A file that is broken, of something else, or of another format is set aside, the one before it
    is used, and ``tell`` is told so. Raises MapperFileError if there is none that can be used.
    """
    try:
        return read_kept(path, _parsed, tell, version=FORMAT, most=_MOST_BYTES)
    except KeptFileError as error:
        raise MapperFileError(f"expected a map that is being made: {error}") from error


def _parsed(content: bytes) -> KeptMap:
    return _kept_of(ArrayFields(read_arrays(content, _MOST_BYTES)))


def remove_mapper(path: Path) -> None:
    """Forget the map; raises OSError when the disk refuses."""
    remove_kept(path)


def _arrays_of(kept: KeptMap) -> dict[str, NDArray[Any]]:
    state = kept.state
    frames = [frame for submap in state.submaps for frame in submap.keyframes]
    lidar, links = state.lidar, state.links
    no_points, no_poses = np.zeros((0, POINT), np.float32), np.zeros((0, 3))
    return {
        "format": np.array(FORMAT),
        "run": np.array(kept.run),
        "taken_up": np.array(kept.taken_up),
        "station": _row_of(kept.station),
        "station_from_start": _row_of(kept.station_from_start),
        "version": np.array(state.version),
        "is_lost": np.array(state.is_lost),
        "way": np.array(state.way),
        "phase": np.array(state.phase),
        "lidar_beams": np.array(lidar.beams),
        "lidar_numbers": np.array([lidar.first_angle, lidar.step, lidar.nearest, lidar.farthest]),
        "lidar_mount": _row_of(lidar.mount),
        "poses": state.poses,
        "submap_ways": np.array([submap.way for submap in state.submaps]),
        "submap_keyframes": np.array([len(submap.keyframes) for submap in state.submaps]),
        "keyframe_poses": np.array([frame.pose for frame in frames]) if frames else no_poses,
        "keyframe_points": np.array([len(frame.points) for frame in frames], np.int64),
        "points": np.concatenate([no_points, *(frame.points for frame in frames)]),
        "keyframe_open": np.array([len(frame.open) for frame in frames], np.int64),
        "open": np.concatenate([no_points[:, :2], *(frame.open for frame in frames)]),
        "link_ends": np.array([(link.parent, link.child) for link in links], np.int64).reshape(
            -1, 2
        ),
        "link_relatives": np.array([link.relative for link in links]).reshape(-1, 3),
        "link_information": np.array([link.information for link in links]).reshape(-1, 3, 3),
        "link_kinds": np.array([_LINK_KINDS.index(link.kind) for link in links], np.int64),
        "mirror_submaps": np.array([mirror.submap for mirror in state.mirrors], np.int64),
        "mirror_planes": np.array([mirror.plane for mirror in state.mirrors]).reshape(-1, 3),
        "mirror_reaches": np.array([mirror.reach for mirror in state.mirrors]).reshape(-1, 2),
        "mirror_seen_from": np.array([mirror.seen_from for mirror in state.mirrors], np.float64),
    }


def _kept_of(fields: ArrayFields) -> KeptMap:
    its_format = int(fields.counts("format"))
    if its_format != FORMAT:
        raise ValueError(f"expected one of format {FORMAT}, got format {its_format}")
    submaps = _submaps_of(fields)
    phase = fields.floats("phase", 2).tolist()
    state = MapperState(
        submaps,
        fields.floats("poses", len(submaps), 3),
        _links_of(fields, len(submaps)),
        float(fields.floats("way")),
        (phase[0], phase[1]),
        _lidar_of(fields),
        int(fields.counts("version")),
        bool(fields.flags("is_lost")),
        _mirrors_of(fields, len(submaps)),
    )
    return KeptMap(
        state,
        fields.text("run"),
        fields.pose("station"),
        fields.pose("station_from_start"),
        int(fields.counts("taken_up")),
    )


def _submaps_of(fields: ArrayFields) -> tuple[KeptSubmap, ...]:
    driven = fields.floats("submap_ways", -1)
    sizes = fields.counts("submap_keyframes", len(driven))
    lengths = fields.counts("keyframe_points", -1)
    if not len(driven) or not len(lengths):
        raise ValueError("expected one submap with one keyframe, or more, got none")
    points = fields.floats("points", int(lengths.sum()), POINT, kind=np.float32)
    poses = fields.floats("keyframe_poses", len(lengths), 3)
    if sizes.sum() != len(lengths):
        raise ValueError(f"expected {sizes.sum()} keyframes, got {len(lengths)}")
    parts = np.split(points, np.cumsum(lengths)[:-1])
    ways = _open_ways_of(fields, len(lengths))
    frames = [Keyframe(*each) for each in zip(parts, poses, ways, strict=True)]
    ends = np.cumsum(sizes).tolist()
    return tuple(
        KeptSubmap(way, tuple(frames[end - size : end]))
        for way, size, end in zip(driven.tolist(), sizes.tolist(), ends, strict=True)
    )


def _open_ways_of(fields: ArrayFields, keyframes: int) -> list[NDArray[np.float32]]:
    if not fields.has("keyframe_open"):
        return [np.zeros((0, 2), np.float32)] * keyframes
    lengths = fields.counts("keyframe_open", keyframes)
    ways = fields.floats("open", int(lengths.sum()), 2, kind=np.float32)
    return np.split(ways, np.cumsum(lengths)[:-1])


def _links_of(fields: ArrayFields, submaps: int) -> tuple[Link, ...]:
    ends = fields.counts("link_ends", -1, 2)
    if ends.size and ends.max() >= submaps:
        raise ValueError(f"expected links between {submaps} submaps, got one to {ends.max()}")
    relatives = fields.floats("link_relatives", len(ends), 3)
    information = fields.floats("link_information", len(ends), 3, 3)
    kinds = _link_kinds_of(fields, ends)
    parts = zip(ends.tolist(), relatives, information, kinds, strict=True)
    return tuple(
        Link(parent, child, relative, sureness, kind)
        for (parent, child), relative, sureness, kind in parts
    )


def _link_kinds_of(fields: ArrayFields, ends: NDArray[np.int64]) -> list[LinkKind]:
    if not fields.has("link_kinds"):
        return _older_link_kinds_of(fields, ends)
    numbers = fields.counts("link_kinds", len(ends))
    if numbers.size and numbers.max() >= len(_LINK_KINDS):
        raise ValueError(f"expected {len(_LINK_KINDS)} kinds of links, got number {numbers.max()}")
    return [_LINK_KINDS[number] for number in numbers.tolist()]


def _older_link_kinds_of(fields: ArrayFields, ends: NDArray[np.int64]) -> list[LinkKind]:
    """Return the kinds in a file of an older program, which told them by two flags."""
    matched = fields.flags("link_doubts", len(ends)).tolist()
    guessed = [False] * len(ends)
    if fields.has("link_guesses"):
        guessed = fields.flags("link_guesses", len(ends)).tolist()
    follows = (ends[:, 1] == ends[:, 0] + 1).tolist()
    return [_older_link_kind(*each) for each in zip(matched, guessed, follows, strict=True)]


def _older_link_kind(is_matched: bool, is_guessed: bool, follows: bool) -> LinkKind:
    if is_matched:
        return LinkKind.MATCHED
    if is_guessed:
        return LinkKind.GUESSED
    return LinkKind.DRIVEN if follows else LinkKind.TOLD


def _mirrors_of(fields: ArrayFields, submaps: int) -> tuple[KeptMirror, ...]:
    if not fields.has("mirror_submaps"):
        return ()
    numbers = fields.counts("mirror_submaps", -1)
    if numbers.size and numbers.max() >= submaps:
        raise ValueError(f"expected mirrors in {submaps} submaps, got one in {numbers.max()}")
    planes = fields.floats("mirror_planes", len(numbers), 3)
    reaches = fields.floats("mirror_reaches", len(numbers), 2)
    if reaches.size and reaches.min() <= 0.0:
        raise ValueError(f"expected mirrors that reach farther than 0, got {reaches.min()}")
    # A file of an older program lacks this distance: 0, as if the mirror was touched.
    is_told = fields.has("mirror_seen_from")
    seen_from = (
        fields.floats("mirror_seen_from", len(numbers)) if is_told else np.zeros(len(numbers))
    )
    if seen_from.size and seen_from.min() < 0.0:
        raise ValueError(f"expected mirrors seen from 0 m or farther, got {seen_from.min()}")
    parts = zip(numbers.tolist(), planes, reaches, seen_from.tolist(), strict=True)
    return tuple(KeptMirror(*each) for each in parts)


def _lidar_of(fields: ArrayFields) -> LidarNumbers:
    beams, mount = int(fields.counts("lidar_beams")), fields.pose("lidar_mount")
    if not 0 < beams <= _MOST_BEAMS or mount is None:
        raise ValueError(f"expected a lidar with beams and a mount, got {beams} and {mount}")
    first_angle, step, nearest, farthest = fields.floats("lidar_numbers", 4).tolist()
    if not 0.0 <= nearest < farthest:
        raise ValueError(f"expected a lidar that reaches from near to far, got {nearest, farthest}")
    return LidarNumbers(beams, first_angle, step, nearest, farthest, mount)


def _row_of(pose: Pose | None) -> NDArray[np.float64]:
    return np.full(3, np.nan) if pose is None else pose.as_array()
