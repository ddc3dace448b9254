"""The protocol of a peer's process: a line of JSON in, a line of JSON out, on standard streams."""

from __future__ import annotations

import importlib
import json
import platform
import time
import traceback
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from importlib import metadata
from typing import Any, TextIO, TypeAlias

Parameters: TypeAlias = Mapping[str, Any]

CHECKED_POSES = 40
"""Poses of a case of scans whose mean range each peer reports; few, so that no peer takes long."""
_LONGEST = 200
"""Characters of an error."""


class LeftOutError(Exception):
    """A peer leaves this case out; its text gives the reason, and is shown unchanged."""


@dataclass(frozen=True)
class Work:
    """The measured work: ``batch`` does some and returns how many units (scans, plans) it did."""

    batch: Callable[[], float]
    facts: dict[str, float] = field(default_factory=dict)


def rate(batch: Callable[[], float], seconds: float) -> float:
    """Return units per second over at least ``seconds``; the same clock for us and for peers."""
    done = 0.0
    start = time.perf_counter()
    while True:
        done += batch()
        elapsed = time.perf_counter() - start
        if elapsed >= seconds:
            return done / elapsed


def once(work: Callable[[], object]) -> Callable[[], float]:
    """Return a batch of one unit."""

    def batch() -> float:
        work()
        return 1.0

    return batch


def serve(module: str, requests: Iterable[str], answers: TextIO) -> None:
    """Answer ``requests`` for the peer whose script is ``module``.

    The script offers ``prepare(parameters)``, and ``DISTRIBUTION``: its name for pip, "" for Python
    itself.
    """
    work: Work | None = None
    for line in requests:
        request = json.loads(line)
        try:
            if "prepare" in request:
                peer = importlib.import_module(module)
                work = peer.prepare(request["prepare"])
                work.batch()  # code that is compiled or allocated at first use must not count
                answer = {"version": _version(peer.DISTRIBUTION), "facts": work.facts}
            elif work is None:
                answer = {"error": "expected 'prepare' before 'run'"}
            else:
                answer = {"rate": rate(work.batch, float(request["run"]))}
        except LeftOutError as error:
            answer = {"error": str(error)}
        except Exception as error:
            # An exception of one peer's library must not end the other peers.
            traceback.print_exc()
            answer = {"error": f"{type(error).__name__}: {error}".splitlines()[0][:_LONGEST]}
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def _version(distribution: str) -> str:
    if not distribution:
        return platform.python_version()
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return ""
