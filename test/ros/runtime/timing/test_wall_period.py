"""Messages that are held back for a period of wall time, with a clock of the test's own."""

from roomba_ros.runtime.timing.wall_period import WallPeriod


class Wall:
    """A wall clock that stands still."""

    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


def test_it_is_over_at_first_and_then_when_its_time_has_passed() -> None:
    wall = Wall()
    period = WallPeriod(0.5, wall)
    assert period.is_over()
    period.begin()
    assert not period.is_over()
    wall.now += 0.25
    assert not period.is_over()
    wall.now += 0.25
    assert period.is_over()


def test_asking_begins_nothing_and_beginning_anew_holds_back_from_then() -> None:
    wall = Wall()
    period = WallPeriod(0.5, wall)
    period.begin()
    wall.now += 0.5
    assert period.is_over()
    assert period.is_over()
    period.begin()
    wall.now += 0.375
    period.begin()
    wall.now += 0.375
    assert not period.is_over()
