"""Each test that the page of promises names is there, and no promise is without one."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Final

import pytest

ROOT: Final = Path(__file__).parents[3]
PAGE: Final = (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8")
NAMED: Final = sorted(set(re.findall(r"`(test/[^`\s]+)`", PAGE)))
TOLD_ABOVE: Final = (
    "test_a_new_master_knows_all_and_the_clean_goes_on",
    "test_a_stopped_node_is_told_replaced_and_the_clean_goes_on",
    "test_a_clock_that_is_set_ends_nothing",
    "test_it_listens_on_loopback_alone",
    "test_a_message_that_is_too_long_ends_its_connection",
    "test_an_endless_header_is_dropped_at_once_and_a_slow_one_in_time",
)
"""Tests of faults that the robot of the report had, and that any robot may have."""
BROKE_THE_GRAPH: Final = (
    *TOLD_ABOVE,
    "test_forged_commands_and_a_forged_release_do_not_move_a_held_robot",
    "test_a_killed_node_is_told_and_back",
    "test_a_killed_node_goes_on_with_its_clean_and_keeps_its_zones",
    "test_zones_beyond_the_limits_are_refused_and_many_are_quickly_there",
    "test_a_damaged_checkpoint_gives_way_to_the_one_before",
    "test_silent_connections_hold_up_no_other_and_are_closed",
    "test_bad_messages_on_every_topic_are_refused_and_have_no_effect",
    "test_a_flood_of_commands_makes_no_flood_for_the_drive",
    "test_broken_yaml_is_refused_with_its_line",
    "test_a_wrong_argument_is_named_with_the_nearest_one",
    "test_a_link_at_the_unfinished_file_s_name_is_refused",
    "test_a_disk_that_refuses_is_told_and_what_was_refused_is_kept_when_it_does_not",
    "test_names_that_cannot_be_told_are_refused_in_few_words",
    "test_what_is_told_is_so",
    "test_a_killed_run_leaves_nothing_and_the_next_one_is_whole",
    "test_it_stands_within_half_a_second",
    "test_a_second_node_that_tells_the_place_is_noticed_and_the_robot_stands",
    "test_ctrl_c_during_the_start_ends_it_without_a_traceback",
)
"""Tests of what went wrong when the running graph was broken on purpose for an hour."""
ROWS: Final = [
    line
    for line in PAGE.splitlines()
    if line.startswith("| ") and not line.startswith(("| what", "| from"))
]


def test_the_page_names_tests() -> None:
    assert len(NAMED) > 40
    assert len(ROWS) > 60


@pytest.mark.parametrize("name", NAMED)
def test_a_test_that_is_named_is_there(name: str) -> None:
    file, _, function = name.partition("::")
    path = ROOT / file
    assert path.exists()
    if function:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        names = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
        assert function in names
    if path.is_dir():
        assert list(path.rglob("test_*.py"))


@pytest.mark.parametrize("row", ROWS)
def test_a_promise_has_a_test(row: str) -> None:
    assert re.search(r"`(test/|\./roomba )", row)


def tables() -> list[list[list[str]]]:
    """Return the cells of each row of each table of the page, the head and the line below too."""
    found: list[list[list[str]]] = []
    before = ""
    for line in PAGE.splitlines():
        if line.startswith("|"):
            if not before.startswith("|"):
                found.append([])
            found[-1].append([cell.strip() for cell in line.strip("|").split("|")])
        before = line
    return found


def test_each_table_has_one_head_and_rows_as_wide() -> None:
    for head, rule, *rows in tables():
        assert set("".join(rule)) == {"-"}, head
        assert rows, head
        assert {len(row) for row in (rule, *rows)} == {len(head)}, head
        assert head[0].startswith("what "), head
        assert not any(row[0].startswith("what goes wrong") for row in rows), head


def test_each_part_says_something_before_the_next_begins() -> None:
    parts = re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]
    assert len(parts) >= 10
    assert [part for part in parts if len(part.splitlines()) < 4] == []


def test_each_fault_has_one_row() -> None:
    """Two rows of one fault would tell two figures, of which one gets old."""
    faults = [row[0] for _, _, *rows in tables() for row in rows]
    assert len(set(faults)) == len(faults)


def test_all_faults_of_the_reports_robot_have_a_row() -> None:
    """It had 32, six of which are told in the tables of their subjects."""
    sizes = [len(rows) for head, _, *rows in tables() if len(head) == 5]
    assert sizes == [26]
    told = " ".join(row[-1] for head, _, *rows in tables() if len(head) == 3 for row in rows)
    assert [name for name in TOLD_ABOVE if name not in told] == []


def test_all_that_broke_the_running_graph_has_a_row() -> None:
    assert [name for name in BROKE_THE_GRAPH if f"::{name}`" not in PAGE] == []
