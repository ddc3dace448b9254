"""Runs on a cluster of dask.distributed: workers come and go, and the scheduler may come back.

When a worker is gone, the scheduler gives its runs to another worker. When the scheduler is gone,
the runs without a result are given to the scheduler that comes back under its address.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import re
import time
from collections import deque
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import CancelledError
from typing import Any, Final

from distributed import Client, KilledWorker, LocalCluster, wait

from roomba.commands.campaign.running.runs import CampaignRun, OtherMachineError
from roomba.commands.campaign.running.work import RunEnd, Work
from roomba.commands.options import UsageError
from roomba.commands.trials.many import LONGEST_RUN, one_thread_each, undisturbed
from roomba.errors import RoombaError

_LOCAL: Final = re.compile(r"local:(\d{1,4})")
_ADDRESS: Final = re.compile(
    r"((tcp|tls)://)?[^\s/:]+:\d{1,5}|((tcp|tls)://)?\[[0-9a-fA-F:]+\]:\d{1,5}"
)
_PATIENCE: Final = 60.0
"""s without a scheduler, or without a worker, after which it is given up."""
_LOOK: Final = 1.0
"""s between two looks whether the workers are there."""
_ENDING: Final = 10.0
"""s for workers to end."""
_AHEAD: Final = 2
"""Runs that each thread of a worker has in advance, so that none waits for this machine."""
_LEAST_AHEAD: Final = 4
_LATE: Final = (TimeoutError, asyncio.TimeoutError)
"""Timeouts: they are two different classes before Python 3.11."""
_GONE: Final = (CancelledError, OSError, *_LATE)
"""What dask raises when the connection to the scheduler is lost."""


class ClusterError(RoombaError):
    """There is no scheduler, or no worker; what was stored stays."""


def check_cluster(text: str) -> None:
    """Refuse a text that is neither local:N nor an address; raises UsageError."""
    local = _LOCAL.fullmatch(text)
    if not (local and int(local[1])) and not (text[:6] != "local:" and _ADDRESS.fullmatch(text)):
        raise UsageError(
            f"--cluster: expected local:N, or the HOST:PORT of a scheduler of dask, got {text!r}"
        )


def run_on_cluster(
    cluster: str, runs: Sequence[CampaignRun], work: Work, patience: float = _PATIENCE
) -> Generator[tuple[CampaignRun, RunEnd | str]]:
    """Yield each run with what came of it, as ``run_on`` does.

    ``patience`` is s without a scheduler or a worker after which ClusterError is raised.
    """
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    with contextlib.ExitStack() as stack:
        scheduler: Any = cluster
        if local := _LOCAL.fullmatch(cluster):
            scheduler = stack.enter_context(_local_cluster(int(local[1])))
        left = deque(runs)
        while left:
            with (
                _connected(scheduler, patience) as client,
                contextlib.closing(_Round(client, left, patience).run(work)) as ends,
            ):
                yield from ends


@contextlib.contextmanager
def _local_cluster(workers: int) -> Iterator[LocalCluster]:
    """Start a cluster on this machine, which no other machine can reach."""
    with one_thread_each():
        with undisturbed():
            cluster = LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                host="127.0.0.1",
                dashboard_address=None,
                silence_logs=logging.CRITICAL,
            )
        try:
            yield cluster
        finally:
            with contextlib.suppress(*_LATE):
                cluster.close(timeout=_ENDING)


@contextlib.contextmanager
def _connected(scheduler: Any, patience: float) -> Iterator[Client]:
    try:
        client = Client(scheduler, timeout=patience)
    except _GONE as error:
        raise ClusterError(
            f"--cluster: expected a scheduler at {scheduler}, found none within {patience:g} s; "
            "what has ended is stored, and the same command goes on"
        ) from error
    try:
        yield client
    finally:
        with contextlib.suppress(*_GONE):
            client.close(timeout=_LOOK)


class _Round:
    """Runs given to one scheduler, until all have ended or it is gone."""

    def __init__(self, client: Client, left: deque[CampaignRun], patience: float) -> None:
        """Take runs from ``left``; runs without a result are put back if the scheduler is gone."""
        self._client, self._left, self._patience = client, left, patience
        self._at_work: dict[Any, CampaignRun] = {}
        self._worker_seen = self._end_seen = time.monotonic()

    def run(self, work: Work) -> Generator[tuple[CampaignRun, RunEnd | str]]:
        """Yield each run with its result."""
        try:
            while self._left or self._at_work:
                self._give(work)
                for future in self._ended():
                    end = _end_of(future)
                    yield self._at_work.pop(future), end
        except _GONE:
            return
        finally:
            self._left.extendleft(reversed(self._at_work.values()))

    def _give(self, work: Work) -> None:
        """Keep all workers at work; raises ClusterError when there are none for too long."""
        threads, now = sum(self._client.nthreads().values()), time.monotonic()
        if threads:
            self._worker_seen = now
        if now - self._worker_seen > self._patience:
            raise ClusterError(
                f"--cluster: expected workers, found none for {self._patience:g} s; start some by "
                "`dask worker ADDRESS --nthreads 1`; the same command goes on"
            )
        if now - self._end_seen > LONGEST_RUN:
            raise ClusterError(
                f"--cluster: no run has ended within {LONGEST_RUN:g} s; start the workers anew; "
                "the same command goes on"
            )
        room = max(_AHEAD * threads, _LEAST_AHEAD) - len(self._at_work)
        for run in [self._left.popleft() for _ in range(min(room, len(self._left)))]:
            self._at_work[self._client.submit(work, run, pure=False)] = run

    def _ended(self) -> list[Any]:
        """Wait a while for the next results; raises one of _GONE when the scheduler is gone."""
        with contextlib.suppress(*_LATE):
            wait(list(self._at_work), timeout=_LOOK, return_when="FIRST_COMPLETED")
        ended = [future for future in self._at_work if future.done()]
        if any(future.cancelled() for future in ended) or self._client.status != "running":
            raise CancelledError
        if ended:
            self._end_seen = time.monotonic()
        return ended


def _end_of(future: Any) -> RunEnd | str:
    try:
        end: RunEnd | str = future.result()
        return end
    except KilledWorker as error:
        return f"the workers that began it ended: {' '.join(str(error).split())}"
    except OtherMachineError:
        raise
    except CancelledError:
        raise
    except Exception as error:
        return f"its worker could not begin it: {error!r}"
