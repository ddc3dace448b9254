import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from roomba.configuration.body import BodyConfig
from roomba.control.speed_loop import Hazards, Hold, Source, SpeedLoop
from roomba.geometry import Twist

BODY = BodyConfig(command_timeout=0.5)


def loop() -> SpeedLoop:
    return SpeedLoop(BODY, 0.5)


def test_nothing_asked_for_nothing_driven() -> None:
    assert loop().tick(10.0) == (Twist(), Hold.NO_COMMAND)


def test_it_drives_as_asked() -> None:
    speed_loop = loop()
    speed_loop.command(10.0, Twist(0.3, 1.0))
    assert speed_loop.tick(10.1) == (Twist(0.3, 1.0), Hold.NONE)


def test_an_old_command_counts_no_more() -> None:
    speed_loop = loop()
    speed_loop.command(10.0, Twist(0.3, 0.0))
    assert speed_loop.tick(10.49)[0] == Twist(0.3, 0.0)
    assert speed_loop.tick(10.5) == (Twist(), Hold.NO_COMMAND)
    assert speed_loop.tick(10.2) == (Twist(), Hold.NO_COMMAND)


def test_what_is_forgotten_counts_no_more() -> None:
    speed_loop = loop()
    speed_loop.command(10.0, Twist(0.3, 0.0))
    speed_loop.command(10.0, Twist(0.1, 0.0), Source.MISSION)
    speed_loop.forget_commands()
    assert speed_loop.tick(10.1) == (Twist(), Hold.NO_COMMAND)


def test_after_the_clock_was_set_back_a_command_still_grows_old() -> None:
    speed_loop = loop()
    speed_loop.command(1000.0, Twist(0.3, 0.0))
    assert speed_loop.tick(10.0)[0] == Twist(0.3, 0.0)
    assert speed_loop.tick(10.6)[0] == Twist()


def test_a_direct_command_counts_above_the_missions_while_it_is_fresh() -> None:
    speed_loop = loop()
    for tenth in range(20):
        speed_loop.command(0.1 * tenth, Twist(0.1, 0.0), Source.MISSION)
        if tenth == 5:
            speed_loop.command(0.5, Twist(-0.2, 1.0))
        is_direct = 5 <= tenth < 10
        expected = Twist(-0.2, 1.0) if is_direct else Twist(0.1, 0.0)
        assert speed_loop.tick(0.1 * tenth)[0] == expected, tenth


def test_the_missions_command_grows_old_as_any_other() -> None:
    speed_loop = loop()
    speed_loop.command(10.0, Twist(3.0, 0.0), Source.MISSION)
    assert speed_loop.tick(10.49) == (Twist(0.5, 0.0), Hold.NONE)
    assert speed_loop.tick(10.5) == (Twist(), Hold.NO_COMMAND)


@pytest.mark.parametrize("source", Source)
def test_the_emergency_stop_is_above_everything(source: Source) -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(bumper=True, cliff=True))
    speed_loop.emergency = True
    for tenth in range(50):
        speed_loop.command(0.1 * tenth, Twist(-0.3, 1.0), source)
        assert speed_loop.tick(0.1 * tenth) == (Twist(), Hold.EMERGENCY)


def test_what_was_asked_for_during_an_emergency_stop_is_not_driven_after_it() -> None:
    speed_loop = loop()
    speed_loop.command(0.0, Twist(0.3, 0.0))
    speed_loop.command(0.0, Twist(0.3, 0.0), Source.MISSION)
    speed_loop.emergency = True
    assert speed_loop.tick(0.1)[1] is Hold.EMERGENCY
    speed_loop.emergency = False
    assert speed_loop.tick(0.2) == (Twist(), Hold.NO_COMMAND)
    speed_loop.command(0.3, Twist(0.3, 0.0))
    assert speed_loop.tick(0.3) == (Twist(0.3, 0.0), Hold.NONE)


@given(st.floats(-5.0, 5.0), st.floats(-90.0, 90.0), st.floats(0.0, 2.0), st.floats(0.01, 2.0))
def test_the_limit_holds_and_the_arc_stays(
    linear: float, angular: float, cruise: float, most: float
) -> None:
    speed_loop = loop()
    speed_loop.set_max_speed(most)
    speed_loop.set_cruise_speed(cruise)
    speed_loop.command(0.0, Twist(linear, angular))
    twist, _ = speed_loop.tick(0.1)
    assert abs(twist.linear) <= min(cruise, most) + 1e-12
    assert abs(twist.angular) <= 4.25 + 1e-12
    assert twist.linear * angular == pytest.approx(twist.angular * linear, abs=1e-9)


def test_speed_zero_means_stand() -> None:
    speed_loop = loop()
    speed_loop.set_cruise_speed(0.0)
    speed_loop.command(0.0, Twist(0.3, 1.0))
    assert speed_loop.tick(0.1) == (Twist(), Hold.SPEED_ZERO)


def test_a_pressed_bumper_makes_it_back_off_a_little_and_never_push() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(bumper=True))
    for tenth in range(20):
        now = 0.1 * tenth
        speed_loop.command(now, Twist(0.3, 1.0))
        backs_off = now <= BODY.bumper_backing_time
        expected = Twist(-BODY.backing_speed, 0.0) if backs_off else Twist(0.0, 1.0)
        assert speed_loop.tick(now) == (expected, Hold.BUMPER)
    speed_loop.set_hazards(Hazards())
    speed_loop.set_hazards(Hazards(bumper=True))
    assert speed_loop.tick(2.0) == (Twist(-BODY.backing_speed, 0.0), Hold.BUMPER)


def test_a_hazard_that_is_told_again_and_again_does_not_begin_anew() -> None:
    for hazard, lasts in (
        (Hazards(bumper=True), BODY.bumper_backing_time),
        (Hazards(cliff=True), BODY.cliff_backing_time),
    ):
        speed_loop = loop()
        for tick in range(60):
            now = 0.125 * tick
            speed_loop.set_hazards(hazard)
            speed_loop.command(now, Twist(0.3, 0.0))
            backs_off = speed_loop.tick(now)[0].linear < 0.0
            assert backs_off == (now <= lasts), now


def test_it_backs_off_to_the_end_of_its_time() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(bumper=True))
    for now, backs_off in ((0.0, True), (BODY.bumper_backing_time, True), (0.61, False)):
        speed_loop.command(now, Twist(0.3, 0.0))
        assert (speed_loop.tick(now)[0].linear < 0.0) == backs_off


def test_it_is_not_held_at_first() -> None:
    assert loop().emergency is False


def test_after_the_clock_was_set_back_it_backs_off_no_longer_than_ever() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(cliff=True))
    for began in (1000.0, 10.0):
        for tick in range(40):
            now = began + 0.125 * tick
            speed_loop.command(now, Twist(0.3, 0.0))
            backs_off = speed_loop.tick(now)[0].linear < 0.0
            assert backs_off == (now - began <= BODY.cliff_backing_time), now


def test_a_pressed_bumper_lets_it_turn_and_drive_backwards() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(bumper=True))
    for wanted in (Twist(0.0, 1.0), Twist(-0.3, 1.0)):
        speed_loop.command(0.1, wanted)
        assert speed_loop.tick(0.2) == (wanted, Hold.NONE)
    speed_loop.set_hazards(Hazards())
    speed_loop.command(0.2, Twist(0.3, 0.0))
    assert speed_loop.tick(0.3)[1] is Hold.NONE


def test_it_backs_away_from_a_cliff_whatever_was_asked_for() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(cliff=True))
    for wanted in (Twist(0.5, 0.0), Twist(0.0, 2.0), Twist(-0.5, 1.0)):
        speed_loop.command(0.0, wanted)
        assert speed_loop.tick(0.1) == (Twist(-BODY.backing_speed, 0.0), Hold.CLIFF)
    speed_loop.set_cruise_speed(0.02)
    assert speed_loop.tick(0.1) == (Twist(-0.02, 0.0), Hold.CLIFF)
    speed_loop.set_hazards(Hazards())
    speed_loop.command(0.2, Twist(0.01, 0.0))
    assert speed_loop.tick(0.3) == (Twist(0.01, 0.0), Hold.NONE)


def test_it_does_not_back_away_for_ever() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(cliff=True))
    for now in (0.0, 1.0, 2.4):
        speed_loop.command(now, Twist(0.3, 0.0))
        assert speed_loop.tick(now)[0].linear < 0.0
    speed_loop.command(2.6, Twist(0.3, 0.0))
    assert speed_loop.tick(2.6) == (Twist(), Hold.CLIFF)
    speed_loop.set_hazards(Hazards())
    speed_loop.set_hazards(Hazards(cliff=True))
    assert speed_loop.tick(2.7)[0].linear < 0.0


def test_without_a_command_it_stands_at_a_cliff_too() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(cliff=True))
    assert speed_loop.tick(0.1) == (Twist(), Hold.NO_COMMAND)


def test_it_stands_while_a_wheel_hangs_in_the_air() -> None:
    speed_loop = loop()
    speed_loop.set_hazards(Hazards(cliff=True, wheel_drop=True))
    speed_loop.command(0.0, Twist(-0.5, 1.0))
    assert speed_loop.tick(0.1) == (Twist(), Hold.WHEEL_DROP)


@pytest.mark.parametrize("speed", [-0.1, math.nan, math.inf])
def test_what_is_no_speed_is_refused_and_the_old_one_stays(speed: float) -> None:
    speed_loop = loop()
    speed_loop.set_cruise_speed(0.2)
    with pytest.raises(ValueError, match="0 m/s or more"):
        speed_loop.set_cruise_speed(speed)
    assert speed_loop.speed_limit == 0.2


@pytest.mark.parametrize("twist", [Twist(math.nan, 0.0), Twist(0.0, -math.inf)])
def test_what_cannot_be_driven_is_refused_and_the_old_command_stays(twist: Twist) -> None:
    speed_loop = loop()
    speed_loop.command(0.0, Twist(0.1, 0.0))
    with pytest.raises(ValueError, match="finite"):
        speed_loop.command(0.1, twist)
    assert speed_loop.tick(0.2)[0] == Twist(0.1, 0.0)
