"""``./roomba record``: a bag of the graph that outlasts a kill, or what was before a mishap."""

from __future__ import annotations

import argparse
import os
import re
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import rospkg

from roomba.commands.options import HelpfulParser, number
from roomba.errors import RoombaError
from roomba.recordings.bags.ring import Message, Ring, keep_newest, save
from roomba.recordings.bags.writer import BagWriter
from roomba_ros.bags.recorder import GraphEar
from roomba_ros.bags.wrongs import Wrongs
from roomba_ros.runtime.graph.staying import stay_in_graph
from roomba_ros.runtime.node import (
    leave,
    register,
    require_master,
    settle,
    told_to_end,
    wait_for_clock,
)

PROGRAM: Final = "./roomba record"
_SECONDS: Final = 60.0
_MOST_SECONDS: Final = 3600.0
"""s of wall time that are kept before a mishap, by default and at most."""
_FLUSH: Final = 0.4
"""s of wall time; no message is longer in memory alone."""
_LOOK: Final = 1.0
"""s of wall time between two flushes: a kill loses the messages of that time at most."""
_PAUSE: Final = 0.05
_UNDER_WAY: Final = 0.2
"""s that are still recorded after the recorder was told to end: messages are on their way."""
_AFTER: Final = 2.0
"""s of wall time that are recorded after something went wrong."""
_REST: Final = 30.0
"""s of wall time between two mishaps that are saved: one is often told in several ways."""
_MOST_BYTES: Final = 64 << 20
"""Bytes of messages of the last seconds that are kept in memory."""
_MOST_FILES: Final = 20
_MOST_DISK: Final = 500 << 20
"""Files of mishaps, and their bytes, that are kept in a folder."""
_PATTERN: Final = "wrong-*.bag"


class Recording:
    """One bag of all messages that come; it is flushed in time."""

    def __init__(self, path: Path) -> None:
        """Begin the bag; raises OSError."""
        self._bag = BagWriter(path)
        self._lock = threading.Lock()
        self._flushed = time.monotonic()
        self._error: OSError | None = None
        self.messages = 0

    def take(self, message: Message) -> None:
        """Write a message; the next :meth:`tick` raises what the disk refused."""
        with self._lock:
            if self._error is not None:
                return
            try:
                self._bag.write(*message)
                self.messages += 1
            except OSError as error:
                self._error = error

    def tick(self) -> None:
        """Flush if it is time to; raises OSError."""
        now = time.monotonic()
        with self._lock:
            if self._error is not None:
                raise self._error
            if now - self._flushed >= _FLUSH:
                self._flushed = now
                self._bag.flush()

    def close(self) -> str:
        """Close the bag; return a sentence for the user about it. Raises OSError."""
        with self._lock:
            self._bag.close()
        return f"{self._bag.path}: {self.messages} messages, {self._bag.size / 1e6:.1f} MB"


class BlackBox:
    """Saves the last seconds before each mishap, and the two seconds after it."""

    def __init__(self, folder: Path, seconds: float) -> None:
        """Keep nothing yet; raises OSError if there can be no such folder."""
        folder.mkdir(parents=True, exist_ok=True)
        self._folder, self._ring, self._wrongs = folder, Ring(seconds, _MOST_BYTES), Wrongs()
        self._lock = threading.Lock()
        self._reason, self._due, self._rests_until = "", 0.0, 0.0
        self._mishap: list[Message] = []
        self._room = 0
        self.saved = 0

    def take(self, message: Message) -> None:
        """Keep a message, and notice what it says."""
        with self._lock:
            self._ring.add(message)
            now = time.monotonic()
            if self._reason and now < self._due and self._room > 0:
                self._mishap.append(message)
                self._room -= len(message.raw)
            reason = self._wrongs.heard(message)
            if reason and not self._reason and now >= self._rests_until:
                # Copied now: on a fast clock the ring would drop much of it before it is saved.
                self._mishap, self._room = self._ring.messages(), _MOST_BYTES
                self._reason, self._due = reason, now + _AFTER

    def tick(self) -> None:
        """Save what is due; raises OSError."""
        now = time.monotonic()
        with self._lock:
            if not self._reason or now < self._due:
                return
            self._rests_until = now + _REST
        self._save()

    def close(self) -> str:
        """Save a mishap that is not saved yet; return a sentence for the user. Raises OSError."""
        if self._reason:
            self._save()
        return f"{self._folder}: {self.saved} mishaps saved"

    def _save(self) -> None:
        with self._lock:
            reason, self._reason = self._reason, ""
            mishap, self._mishap = self._mishap, []
        begun = time.strftime("%Y%m%d-%H%M%S", time.gmtime())
        words = re.sub(r"[^a-z0-9]+", "-", reason.lower()).strip("-")[:60]
        path = self._folder / f"wrong-{begun}-{words}.bag"
        save(mishap, path)
        self.saved += 1
        print(f"{reason}\n    saved as {path}", flush=True)
        for old in keep_newest(self._folder, _PATTERN, _MOST_FILES, _MOST_DISK):
            print(f"    {old.name} was removed: the folder has enough of them", flush=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Record until Ctrl-C; returns the exit status."""
    wanted = _wanted(arguments)
    require_master()
    register(f"record_{os.getpid()}")
    stay_in_graph()
    try:
        # Latched messages come at once, and have no time before the clock is known.
        wait_for_clock()
        settle()
        kept = _begun(wanted)
        ear = GraphEar(kept.take, only=wanted.topics, has_camera=wanted.camera)
        _record(ear, kept)
        print(f"\n{kept.close()}", flush=True)
    except (RoombaError, OSError) as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr, flush=True)
        return 1
    return 0


def _begun(wanted: argparse.Namespace) -> Recording | BlackBox:
    if wanted.when_wrong:
        folder = wanted.file or Path(rospkg.get_ros_home()) / "roomba_robot" / "mishaps"
        seconds = _SECONDS if wanted.seconds is None else wanted.seconds
        print(
            f"The last {seconds:g} s are saved in {folder} when something goes wrong; "
            "Ctrl-C ends it.",
            flush=True,
        )
        return BlackBox(folder, seconds)
    path = wanted.file or Path(time.strftime("%Y-%m-%d-%H-%M-%S.bag"))
    begun = Recording(path)
    print(f"Recording into {path}; Ctrl-C ends it.", flush=True)
    return begun


def _record(ear: GraphEar, kept: Recording | BlackBox) -> None:
    """Record the graph until a signal or the master ends this process; raises OSError."""
    looked = -_LOOK
    while not told_to_end():
        now = time.monotonic()
        if now - looked >= _LOOK:
            looked = now
            ear.look()
        kept.tick()
        time.sleep(_PAUSE)
    time.sleep(_UNDER_WAY)


def _wanted(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Return what the command line asks for; leaves with status 2 where it makes no sense."""
    parser = _parser()
    wanted = parser.parse_args(arguments)
    if wanted.seconds is not None and not wanted.when_wrong:
        parser.error("--seconds: how many are kept in memory, so expected --when-wrong as well")
    for name in wanted.topics:
        if not name.startswith("/"):
            parser.error(
                f"--topics: expected names that begin with /, got {name!r}; a file stands before "
                "the option"
            )
    return wanted


def _parser() -> argparse.ArgumentParser:
    parser = HelpfulParser(
        prog=PROGRAM,
        description="What the robot of ./roomba run tells, as a bag of ROS 1 that a kill leaves "
        "whole; or, with --when-wrong, the last minute before a mishap, each time there is one. "
        "Ctrl-C ends it.",
        epilog="Exit status: 0 after Ctrl-C, 1 when no robot runs or the disk refuses, 2 for wrong "
        "usage. A file that is there already is left alone. ./roomba export makes other forms of a "
        "bag.",
    )
    parser.add_argument(
        "file",
        nargs="?",
        type=Path,
        metavar="FILE.bag|FOLDER",
        help="where to (default: a bag named after the time; with --when-wrong "
        "roomba_robot/mishaps in the ROS home folder)",
    )
    parser.add_argument(
        "--topics", nargs="+", default=[], metavar="/NAME", help="only these (default: all)"
    )
    parser.add_argument(
        "--camera",
        action="store_true",
        help="the camera's pictures as well, which are drawn only while they are heard",
    )
    parser.add_argument(
        "--when-wrong",
        action="store_true",
        help="keep the last seconds in memory, and save them when something goes wrong: a process "
        "ends or hangs, the robot reports an error, an emergency stop",
    )
    parser.add_argument(
        "--seconds",
        type=number(lambda value: 1.0 <= value <= _MOST_SECONDS, f"1 to {_MOST_SECONDS:g} s"),
        metavar="S",
        help=f"how many of them (default: {_SECONDS:g})",
    )
    return parser


if __name__ == "__main__":
    leave(main())
