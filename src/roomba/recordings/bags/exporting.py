"""A recording in a form of ROS 2: a folder with a database, or one file of MCAP; types included."""

from __future__ import annotations

import contextlib
import io
import shutil
import tempfile
from enum import Enum
from pathlib import Path
from typing import Final

from rosbags.convert import convert

from roomba.recordings.bag_format.index_sizes import has_wrong_sizes, mend_sizes
from roomba.recordings.bag_format.mending import Mended, mend_bag, needs_mending
from roomba.recordings.bag_format.records import MAGIC
from roomba.recordings.packed import refuse_pipe
from roomba.recordings.readings import LogError

_VERSION: Final = 9
"""The version of ROS 2's bags: the first one that has the types of messages in it."""
_LONGEST_REASON: Final = 200
"""Characters of what a reader says of a damaged bag."""
_OTHER: Final = "something else"


class Form(Enum):
    """What a recording is exported to."""

    MCAP = "mcap"
    """One file, for Foxglove and others."""
    ROS2 = "ros2"
    """A folder, for ``ros2 bag``."""


def export_bag(source: Path, target: Path, form: Form) -> Mended | None:
    """Write a recording in another form; raises LogError, BagError, or OSError.

    A bag that was cut short is copied, and the copy mended first: that result is returned, else
    None.
    """
    _require_recording(source)
    if target.exists():
        raise LogError(f"{target}: there is something already; name another place by --out")
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".export_", dir=target.parent) as folder:
        mended, whole = None, source
        is_cut = source.is_file() and needs_mending(source)
        if is_cut or (source.is_file() and has_wrong_sizes(source)):
            whole = Path(folder) / "copy.bag"
            shutil.copyfile(source, whole)
            mend_sizes(whole)
            mended = mend_bag(whole, source) if is_cut else None
        # By the name .bag the converter would write one of ROS 1.
        made = Path(folder) / target.stem.replace(".", "_")
        try:
            _convert(whole, made, form)
        except LogError as error:
            raise LogError(f"{source}: {error}") from error
        if form is Form.MCAP:
            (made,) = made.glob("*.mcap")
        shutil.move(made, target)
    return mended


def _convert(source: Path, made: Path, form: Form) -> None:
    storage = "mcap" if form is Form.MCAP else "sqlite3"
    try:
        # It prints which types differ between ROS 1 and 2.
        with contextlib.redirect_stdout(io.StringIO()):
            convert(
                srcs=[source],
                dst=made,
                dst_storage=storage,
                dst_version=_VERSION,
                compress=None,
                compress_mode="none",
                default_typestore=None,
                typestore=None,
                exclude_topics=[],
                include_topics=[],
                exclude_msgtypes=[],
                include_msgtypes=[],
            )
    except OSError:
        raise
    # A damaged bag may make a reader raise an error of any kind.
    except Exception as error:
        reason = str(error).strip().partition("\n")[0][:_LONGEST_REASON] or type(error).__name__
        raise LogError(f"it is damaged, and cannot be exported: {reason}") from error


def _require_recording(source: Path) -> None:
    """Raise LogError unless a file or folder begins as a recording does."""
    if not source.exists():
        raise LogError(f"{source}: expected a recording, there is no such file")
    if source.is_dir():
        if not (source / "metadata.yaml").is_file():
            raise LogError(
                f"{source}: expected a .bag, or the folder of a bag of ROS 2, got {_OTHER}"
            )
        return
    refuse_pipe(source)
    with source.open("rb") as file:
        begin = file.read(len(MAGIC))
    if not begin:
        raise LogError(f"{source}: expected a recording, got an empty file")
    if begin != MAGIC:
        raise LogError(f"{source}: expected a .bag of ./roomba record or rosbag, got {_OTHER}")
