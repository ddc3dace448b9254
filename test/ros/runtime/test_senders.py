"""Which nodes may send on a topic: a named one, or any one that is alone."""

import time

import pytest
import rospy
from hypothesis import given
from hypothesis import strategies as st

from roomba_ros.convert.errors import MessageError
from roomba_ros.runtime.senders import SELDOM_SILENT_AFTER, OneSender, OnlyFrom


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The wall time, which the test sets."""
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    return now


def test_only_the_named_node_is_let_through() -> None:
    rule = OnlyFrom("speed_pub_node")
    rule.check(rospy.resolve_name("speed_pub_node"))
    with pytest.raises(MessageError, match=r"expected messages of /\S*speed_pub_node alone.*/evil"):
        rule.check("/evil")


def test_before_a_message_there_is_no_conflict(clock: list[float]) -> None:
    clock[0] = 0.0
    assert OneSender().conflict == ""
    rule = OneSender()
    rule.check("/own")
    assert rule.conflict == ""


def test_the_first_sender_counts_and_a_second_one_is_noticed(clock: list[float]) -> None:
    rule = OneSender()
    rule.check("/own")
    assert rule.conflict == ""
    with pytest.raises(MessageError, match="expected one sender, /own, got a message of /fake"):
        rule.check("/fake")
    assert rule.conflict == "both /own and /fake tell it: end one of them"
    clock[0] += 0.5
    rule.check("/own")
    assert rule.conflict
    clock[0] += 0.6
    rule.check("/own")
    assert rule.conflict == ""


def test_after_a_second_of_silence_another_node_may_send(clock: list[float]) -> None:
    rule = OneSender()
    rule.check("/before")
    clock[0] += 1.1
    rule.check("/after")
    with pytest.raises(MessageError):
        rule.check("/before")


def test_where_messages_are_seldom_a_node_may_be_silent_for_longer(clock: list[float]) -> None:
    rule = OneSender(SELDOM_SILENT_AFTER)
    rule.check("/own")
    for _ in range(3):
        clock[0] += 2.9
        with pytest.raises(MessageError):
            rule.check("/fake")
        assert rule.conflict
        rule.check("/own")
    clock[0] += 2.9
    assert rule.conflict
    clock[0] += 0.2
    assert rule.conflict == ""
    rule.check("/after")


@given(st.lists(st.tuples(st.sampled_from("abc"), st.floats(0.0, 2.0)), max_size=40))
def test_of_any_sequence_those_let_through_change_only_after_silence(
    told: list[tuple[str, float]],
) -> None:
    now = 100.0
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(time, "monotonic", lambda: now)
        rule, sender, heard = OneSender(), "", -1e9
        for name, pause in told:
            now += pause
            may = name == sender or now - heard > 1.0
            try:
                rule.check(name)
            except MessageError:
                assert not may
                assert name in rule.conflict
                continue
            assert may
            sender, heard = name, now
