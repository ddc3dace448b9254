"""Forked processes: how they end, in words, and whether they are stopped."""

import gc
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from fixtures.waiting import wait_until

from roomba_ros.supervision.fork import fork, is_stopped, told_end


def fails() -> None:
    raise ValueError("as wanted")


@pytest.mark.parametrize(
    ("function", "told"),
    [
        (lambda: None, "ended with status 0"),
        (lambda: sys.exit(7), "ended with status 7"),
        (lambda: sys.exit("a word"), "ended with status 1"),
        (fails, "ended with status 1"),
        (lambda: os.kill(os.getpid(), signal.SIGKILL), "was ended by SIGKILL"),
        (lambda: os.kill(os.getpid(), signal.SIGRTMIN + 3), "was ended by signal"),
    ],
)
def test_the_end_is_told(function: Callable[[], object], told: str) -> None:
    _, status = os.waitpid(fork(function), 0)
    assert told_end(status).startswith(told)


def test_a_forked_process_has_its_own_group_and_can_be_interrupted() -> None:
    child = fork(signal.pause)
    wait_until(lambda: os.getpgid(child) == child, 10.0, "its own group")
    os.kill(child, signal.SIGINT)
    assert told_end(os.waitpid(child, 0)[1]) == "ended with status 1"


def test_what_it_shares_stays_shared_when_it_looks_for_garbage() -> None:
    """A node does so at the end of its start; nine copies of all imports were 400 MB."""
    shared = [[number] for number in range(400_000)]
    read, write = os.pipe()

    def look() -> None:
        gc.collect()
        os.write(write, str(private_memory()).encode())

    os.waitpid(fork(look), 0)
    taken = int(os.read(read, 20))
    assert 0 < taken < 0.5 * 64 * len(shared), "bytes of its own"


def private_memory() -> int:
    lines = Path("/proc/self/smaps_rollup").read_text("ascii").splitlines()
    [size] = [line.split()[1] for line in lines if line.startswith("Private_Dirty:")]
    return 1024 * int(size)


def test_one_that_is_interrupted_before_it_begins_ends() -> None:
    """The handler of its parent, which only notes the signal, must not take it."""
    before = signal.signal(signal.SIGINT, lambda *_: None)
    try:
        for _ in range(20):
            child = fork(signal.pause)
            os.kill(child, signal.SIGINT)
            wait_until(lambda: os.waitpid(child, os.WNOHANG)[0] == child, 10.0, "it ended")  # noqa: B023
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_stopped_process_is_seen() -> None:
    with subprocess.Popen(["sleep", "100"]) as process:
        assert not is_stopped(process.pid)
        process.send_signal(signal.SIGSTOP)
        wait_until(lambda: is_stopped(process.pid), 10.0, "it is stopped")
        process.send_signal(signal.SIGCONT)
        wait_until(lambda: not is_stopped(process.pid), 10.0, "it goes on")
        process.kill()
    assert not is_stopped(process.pid)
