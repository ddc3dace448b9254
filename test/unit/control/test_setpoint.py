import pytest

from roomba.control.setpoint import Setpoint

TIMEOUT = 0.3
GIVEN_UP_AFTER, NEARER = 10.0, 0.02


def streaming(senders: int = 1) -> tuple[Setpoint, float]:
    setpoint = Setpoint(TIMEOUT, GIVEN_UP_AFTER, NEARER)
    for tick in range(10):
        setpoint.wish(10.0 + 0.05 * tick, (0.1 * tick, 0.0), senders)
    return setpoint, 10.45


def test_nothing_is_wished_at_first() -> None:
    setpoint = Setpoint(TIMEOUT, GIVEN_UP_AFTER, NEARER)
    assert setpoint.target is None
    assert not setpoint.drop_if_lost(5.0, 0)


def test_a_single_wish_is_driven_to_the_end_though_its_sender_leaves() -> None:
    setpoint = Setpoint(TIMEOUT, GIVEN_UP_AFTER, NEARER)
    setpoint.wish(10.0, (3.0, 4.0), senders=1)
    assert not setpoint.drop_if_lost(10.1, senders=0)
    assert not setpoint.drop_if_lost(20.0, senders=0)
    assert setpoint.target == (3.0, 4.0)


def test_a_stream_stops_when_its_sender_vanishes() -> None:
    setpoint, now = streaming()
    assert not setpoint.drop_if_lost(now + 0.05, senders=1)
    assert setpoint.drop_if_lost(now + 0.1, senders=0)
    assert setpoint.target is None
    assert not setpoint.drop_if_lost(now + 0.15, senders=0)


def test_a_stream_stops_when_its_sender_is_silent() -> None:
    setpoint, now = streaming()
    assert not setpoint.drop_if_lost(now + TIMEOUT - 0.05, senders=1)
    assert setpoint.drop_if_lost(now + TIMEOUT, senders=1)
    assert setpoint.target is None
    assert not setpoint.drop_if_lost(now + TIMEOUT + 0.1, senders=1)


def test_a_setpoint_on_the_move_may_wait_while_it_is_still_sent() -> None:
    setpoint, now = streaming()
    for tick in range(1, 10):
        setpoint.wish(now + 0.05 * tick, (0.9, 0.0), 1)
        assert not setpoint.drop_if_lost(now + 0.05 * tick, senders=1)
    assert setpoint.drop_if_lost(now + 1.0, senders=1)


def test_a_wish_that_is_repeated_is_no_stream() -> None:
    setpoint = Setpoint(TIMEOUT, GIVEN_UP_AFTER, NEARER)
    for tick in range(5):
        setpoint.wish(10.0 + 0.05 * tick, (3.0, 4.0), senders=1)
    assert not setpoint.drop_if_lost(20.0, senders=0)
    assert setpoint.target == (3.0, 4.0)


def test_a_sender_that_joined_later_and_leaves_is_noticed() -> None:
    setpoint, now = streaming(senders=1)
    setpoint.drop_if_lost(now + 0.05, senders=2)
    assert setpoint.drop_if_lost(now + 0.1, senders=1)


def test_a_fulfilled_wish_is_forgotten_but_a_stream_goes_on() -> None:
    setpoint, now = streaming()
    setpoint.fulfilled(now + 0.05)
    assert setpoint.target is not None
    setpoint.fulfilled(now + 1.0)
    assert setpoint.target is None


def test_a_clock_set_back_makes_no_stream() -> None:
    setpoint, now = streaming()
    setpoint.wish(now - 100.0, (1.0, 1.0), 1)
    assert not setpoint.drop_if_lost(now - 99.95, senders=0)


def wished(*targets: tuple[float, float]) -> Setpoint:
    setpoint = Setpoint(TIMEOUT, GIVEN_UP_AFTER, NEARER)
    for number, target in enumerate(targets):
        setpoint.wish(10.0 + 0.05 * number, target, 1)
    return setpoint


def given_up_at(setpoint: Setpoint, distances: dict[float, float]) -> list[float]:
    """Return when it was given up, of times and the distances then."""
    return [at for at, off in distances.items() if setpoint.drop_if_out_of_reach(at, off)]


def ticks(start: float, seconds: float, distance: float, speed: float = 0.0) -> dict[float, float]:
    steps = [0.05 * tick for tick in range(round(seconds / 0.05))]
    return {start + step: distance - speed * step for step in steps}


def test_a_single_wish_to_which_it_comes_no_nearer_is_given_up() -> None:
    setpoint = wished((0.0, 0.0), (0.0, 0.0))
    nearer = ticks(10.1, 20.0, 3.0, 0.1)
    assert given_up_at(setpoint, nearer) == []
    # Noise of the pose brings it no nearer.
    noisy = {time: 1.0 + 0.01 * (-1) ** at for at, time in enumerate(ticks(30.1, 15.0, 1.0))}
    given_up = given_up_at(setpoint, noisy)
    assert given_up[0] == pytest.approx(40.0, abs=0.3)
    assert setpoint.target is None


def test_a_repeated_wish_is_given_up_and_another_one_is_not() -> None:
    setpoint = wished((0.0, 0.0))
    for time in ticks(10.1, 9.5, 1.0):
        setpoint.wish(time, (0.0, 0.0), 1)
        assert not setpoint.drop_if_out_of_reach(time, 1.0)
    setpoint.wish(19.6, (5.0, 0.0), 1)
    assert given_up_at(setpoint, ticks(20.0, 9.0, 4.0)) == []
    assert setpoint.target == (5.0, 0.0)


def test_a_stream_is_not_given_up_while_it_flows() -> None:
    setpoint, now = streaming()
    for time in ticks(now, 15.0, 1.0):
        setpoint.wish(time, (0.9, 0.0), 1)
        assert not setpoint.drop_if_out_of_reach(time, 1.0)


@pytest.mark.parametrize("jump", [-100.0, 3600.0])
def test_a_clock_that_is_set_gives_up_nothing_and_puts_nothing_off(jump: float) -> None:
    setpoint = wished((0.0, 0.0))
    assert given_up_at(setpoint, ticks(10.1, 5.0, 1.0)) == []
    given_up = given_up_at(setpoint, ticks(15.1 + jump, 6.0, 1.0))
    assert given_up[0] == pytest.approx(20.1 + jump, abs=0.3)
