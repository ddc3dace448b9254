"""The pool of the benchmarks: its processes do not see Ctrl-C, and end with what they are for."""

from __future__ import annotations

import multiprocessing
import time

import pytest
from fixtures.processes.ctrl_c import blocks_ctrl_c

from roomba_bench.workers import Workers

PROGRAM = """
from pathlib import Path
from roomba_bench.workers import Workers
with Workers() as pool:
    print(pool.submit(Path.read_text, Path("/proc/self/status")).result())
"""


def test_processes_do_not_see_ctrl_c_from_their_begin_on() -> None:
    assert blocks_ctrl_c(PROGRAM)


def test_work_is_done_beside_each_other() -> None:
    with Workers() as pool:
        assert [pool.submit(divmod, 7, by).result() for by in (2, 3)] == [(3, 1), (2, 1)]


def test_processes_end_at_once_when_it_is_broken_off() -> None:
    def broken_off() -> None:
        with Workers() as pool:
            pool.submit(time.sleep, 60.0)
            raise KeyboardInterrupt

    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        broken_off()
    assert time.monotonic() - began < 20.0
    assert multiprocessing.active_children() == []
