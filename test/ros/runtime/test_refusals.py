"""Refused messages are counted, and logged in at most one line a second."""

import itertools

from diagnostic_msgs.msg import DiagnosticStatus
from hypothesis import given
from hypothesis import strategies as st

from roomba_ros.convert.diagnostics import refused_message
from roomba_ros.runtime.refusals import LINE_PERIOD, Refusals

NAN = "expected velocities of finite numbers, got (nan, 0)"
EMPTY = "expected transforms, got none"


def test_nothing_is_told_before_something_is_refused() -> None:
    refusals = Refusals()
    assert (refusals.counts, refusals.newest, refusals.take_line(5.0)) == ({}, "", "")
    assert not refusals.is_recent(5.0)


def test_the_first_is_told_at_once_and_the_rest_is_summed_up() -> None:
    refusals = Refusals()
    refusals.note(10.0, "cmd_vel", NAN)
    assert refusals.take_line(10.0) == f"cmd_vel refused: {NAN}"
    for number in range(12):
        refusals.note(10.1 + 0.01 * number, "cmd_vel", NAN)
    refusals.note(10.5, "/tf_static", EMPTY)
    assert refusals.take_line(10.9) == ""
    line = f"/tf_static refused: {EMPTY}; 12 more refused: 12 on cmd_vel"
    assert refusals.take_line(11.0) == line
    assert refusals.take_line(99.0) == ""
    assert refusals.counts == {"cmd_vel": 13, "/tf_static": 1}


def test_a_refusal_is_news_for_ten_seconds() -> None:
    refusals = Refusals()
    refusals.note(10.0, "cmd_vel", NAN)
    assert refusals.is_recent(19.9)
    assert not refusals.is_recent(20.0)


def test_several_topics_are_summed_up_one_after_the_other() -> None:
    refusals = Refusals()
    for topic in ("b", "a", "a", "c"):
        refusals.note(1.0, topic, NAN)
    assert refusals.take_line(1.0) == f"c refused: {NAN}; 3 more refused: 2 on a, 1 on b"


@given(st.lists(st.tuples(st.floats(0.0, 0.7), st.sampled_from("abc")), min_size=1, max_size=80))
def test_lines_are_a_second_apart_and_tell_every_message(
    noted: list[tuple[float, str]],
) -> None:
    refusals, now = Refusals(), 0.0
    lines: list[tuple[float, str]] = []
    for wait, topic in noted:
        now += wait
        refusals.note(now, topic, "no number")
        lines.append((now, refusals.take_line(now)))
    lines.append((now + LINE_PERIOD, refusals.take_line(now + LINE_PERIOD)))
    told = [(at, line) for at, line in lines if line]
    for (earlier, _), (later, _) in itertools.pairwise(told):
        assert later - earlier >= LINE_PERIOD
    count = sum(1 + int(line.partition("; ")[2].partition(" ")[0] or 0) for _, line in told)
    assert count == len(noted) == sum(refusals.counts.values())


def test_the_status_of_a_node_says_what_and_why() -> None:
    calm = refused_message(2.5, "speed_pub_node", {}, "", is_recent=False)
    (status,) = calm.status
    assert calm.header.stamp.to_sec() == 2.5
    assert (status.name, status.level) == ("speed_pub_node: messages", DiagnosticStatus.OK)
    assert (status.message, status.values) == ("nothing was refused", [])

    newest = f"odom refused: {NAN}"
    counts = {"odom": 2, "cmd_vel": 20}
    (status,) = refused_message(2.5, "speed_pub_node", counts, newest, is_recent=True).status
    assert status.level == DiagnosticStatus.WARN
    assert status.message == f"22 messages were refused; the last: {newest}"
    told = [(value.key, value.value) for value in status.values]
    assert told == [("cmd_vel", "20"), ("odom", "2")]
