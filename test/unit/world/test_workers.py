"""Threads that are made when they are needed: in copies and forks of a process as well."""

from __future__ import annotations

import copy
import multiprocessing
import threading
from collections.abc import Iterator

import pytest

from roomba.world.workers import Workers


@pytest.fixture
def workers() -> Iterator[Workers]:
    """Two threads, which have worked."""
    workers = Workers(2)
    workers.run(lambda _: None, [1, 2])
    yield workers
    workers.close()


def work_is_shared_out(workers: Workers) -> None:
    """Two parts of which each waits for the other, so that one thread cannot do both."""
    meeting = threading.Barrier(2)
    workers.run(lambda _: meeting.wait(10.0), [1, 2])


def test_each_thread_gets_its_part_and_all_are_done(workers: Workers) -> None:
    done: list[int] = []
    workers.run(done.append, range(20))
    assert sorted(done) == list(range(20))
    work_is_shared_out(workers)


def test_what_goes_wrong_is_raised(workers: Workers) -> None:
    with pytest.raises(ZeroDivisionError):
        workers.run(lambda number: 1 / number, [1, 0])


def test_after_the_end_they_begin_anew(workers: Workers) -> None:
    workers.close()
    workers.close()
    work_is_shared_out(workers)


def test_a_copy_makes_threads_of_its_own(workers: Workers) -> None:
    other = copy.deepcopy(workers)
    work_is_shared_out(other)
    other.close()
    work_is_shared_out(workers)


def test_a_forked_process_makes_threads_of_its_own(workers: Workers) -> None:
    child = multiprocessing.get_context("fork").Process(
        target=work_is_shared_out, args=(workers,), daemon=True
    )
    child.start()
    child.join(30.0)
    try:
        assert child.exitcode == 0
    finally:
        child.kill()
        child.join()
    work_is_shared_out(workers)
