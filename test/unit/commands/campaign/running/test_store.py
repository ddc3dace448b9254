"""Results on the disk: whole lines stay, also where the last one is damaged."""

from __future__ import annotations

from pathlib import Path

import pytest
from fixtures.campaigns.campaign_work import FINE, made_run

from roomba.commands.campaign.running.store import opened_store
from roomba.commands.campaign.running.work import RunEnd
from roomba.commands.options import UsageError

END = RunEnd(FINE, "", "here:1", 1.0)
FAILED = RunEnd(None, "no floor", "there:2", 2.0)


def test_what_was_stored_is_there_again(tmp_path: Path) -> None:
    one, other, third = made_run(1), made_run(2), made_run(3)
    with opened_store(tmp_path / "out") as store:
        store.add(one, END)
        store.add(other, FAILED)
    with opened_store(tmp_path / "out") as store:
        assert one.key in store
        assert third.key not in store
        rows = store.rows_of([third, other, one])
    assert [row["seed"] for row in rows] == [2, 1]
    assert rows[0]["figures"] is None
    assert rows[0]["failure"] == "no floor"
    assert rows[1]["figures"] == FINE.as_json()
    assert rows[1]["where"] == "here:1"


def test_a_line_that_was_cut_short_is_run_again_and_takes_nothing_with_it(tmp_path: Path) -> None:
    runs = [made_run(seed) for seed in range(3)]
    with opened_store(tmp_path) as store:
        for run in runs:
            store.add(run, END)
    journal = tmp_path / "results.journal"
    journal.write_bytes(journal.read_bytes()[:-20])
    with opened_store(tmp_path) as store:
        assert [run.key in store for run in runs] == [True, True, False]
        store.add(runs[2], END)
    with opened_store(tmp_path) as store:
        assert all(run.key in store for run in runs)


def test_variants_that_are_the_same_share_a_result(tmp_path: Path) -> None:
    run = made_run(1, "usual")
    twin = made_run(1, "usual")
    with opened_store(tmp_path) as store:
        store.add(run, END)
        assert len(store) == 1
        assert [row["seed"] for row in store.rows_of([run, twin])] == [1, 1]


def test_two_campaigns_do_not_write_into_one_folder(tmp_path: Path) -> None:
    with (
        opened_store(tmp_path),
        pytest.raises(UsageError, match="another campaign writes"),
        opened_store(tmp_path),
    ):
        pass
    with opened_store(tmp_path):
        pass
