from roomba.control.setpoint import Setpoint

TIMEOUT = 0.3


def streaming(senders: int = 1) -> tuple[Setpoint, float]:
    setpoint = Setpoint(TIMEOUT)
    for tick in range(10):
        setpoint.wish(10.0 + 0.05 * tick, (0.1 * tick, 0.0), senders)
    return setpoint, 10.45


def test_nothing_is_wished_at_first() -> None:
    setpoint = Setpoint(TIMEOUT)
    assert setpoint.target is None
    assert not setpoint.check(5.0, 0)


def test_a_single_wish_is_driven_to_the_end_though_its_sender_leaves() -> None:
    setpoint = Setpoint(TIMEOUT)
    setpoint.wish(10.0, (3.0, 4.0), senders=1)
    assert not setpoint.check(10.1, senders=0)
    assert not setpoint.check(20.0, senders=0)
    assert setpoint.target == (3.0, 4.0)


def test_a_stream_stops_when_its_sender_vanishes() -> None:
    setpoint, now = streaming()
    assert not setpoint.check(now + 0.05, senders=1)
    assert setpoint.check(now + 0.1, senders=0)
    assert setpoint.target is None
    assert not setpoint.check(now + 0.15, senders=0)


def test_a_stream_stops_when_its_sender_is_silent() -> None:
    setpoint, now = streaming()
    assert not setpoint.check(now + TIMEOUT - 0.05, senders=1)
    assert setpoint.check(now + TIMEOUT, senders=1)
    assert setpoint.target is None
    assert not setpoint.check(now + TIMEOUT + 0.1, senders=1)


def test_a_setpoint_on_the_move_may_wait_while_it_is_still_sent() -> None:
    setpoint, now = streaming()
    for tick in range(1, 10):
        setpoint.wish(now + 0.05 * tick, (0.9, 0.0), 1)
        assert not setpoint.check(now + 0.05 * tick, senders=1)
    assert setpoint.check(now + 1.0, senders=1)


def test_a_wish_that_is_repeated_is_no_stream() -> None:
    setpoint = Setpoint(TIMEOUT)
    for tick in range(5):
        setpoint.wish(10.0 + 0.05 * tick, (3.0, 4.0), senders=1)
    assert not setpoint.check(20.0, senders=0)
    assert setpoint.target == (3.0, 4.0)


def test_a_sender_that_joined_later_and_leaves_is_noticed() -> None:
    setpoint, now = streaming(senders=1)
    setpoint.check(now + 0.05, senders=2)
    assert setpoint.check(now + 0.1, senders=1)


def test_a_fulfilled_wish_is_forgotten_but_a_stream_goes_on() -> None:
    setpoint, now = streaming()
    setpoint.fulfilled(now + 0.05)
    assert setpoint.target is not None
    setpoint.fulfilled(now + 1.0)
    assert setpoint.target is None


def test_a_clock_set_back_makes_no_stream() -> None:
    setpoint, now = streaming()
    setpoint.wish(now - 100.0, (1.0, 1.0), 1)
    assert not setpoint.check(now - 99.95, senders=0)
