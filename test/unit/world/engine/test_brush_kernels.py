"""What the brush takes: the part as plain Python, and the whole robot."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.rooms import Block, room_home
from fixtures.homes.worlds import DT, IDEAL, NOISY, drive
from fixtures.thoroughness import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.configuration.simulation import SimulatedRobotConfig, pickup_share
from roomba.geometry import Pose, Twist
from roomba.world.engine.brush_kernels import amount_under_disc, sweep
from roomba.world.home.dirt import DirtField
from roomba.world.home.home import DirtSource
from roomba.world.simulator import Simulator

KEEP = 0.2
CONFIG = SimulatedRobotConfig()


def clean_field() -> DirtField:
    home = room_home(blocks=((2.0, 1.0, 3.0, 2.0),))
    return DirtField(home.frame, home.solid)


def sweep_at(
    field: DirtField,
    middle: tuple[float, float, float],
    length: float,
    turn: float = 0.0,
    keep: float = KEEP,
    room: int = 10**15,
    brush: tuple[float, float] = (0.2, 0.05),
) -> int:
    place = tuple(field.place.tolist())
    cells = field.micrograms.reshape(-1)
    return sweep(cells, 0, field.frame.shape, place, brush, keep, middle, length, turn, room)


def drive_over(field: DirtField, steps: int) -> int:
    """Drive 2 m along y = 3 in so many steps; return what was taken."""
    return sum(
        sweep_at(field, (0.5 + 2.0 * (index + 0.5) / steps, 3.0, 0.0), 2.0 / steps)
        for index in range(steps)
    )


@pytest.mark.parametrize("steps", [40, 80, 160, 400, 1000])
def test_a_pass_takes_the_brushs_share_in_one_step_or_in_many(steps: int) -> None:
    field = clean_field()
    field.micrograms[:] = 1_000_000
    drive_over(field, steps)
    row, column = field.frame.cell_of(1.5, 3.0)
    assert field.micrograms[row, column - 5 : column + 5] / 1e6 == pytest.approx(KEEP, abs=0.02)


@given(st.floats(0.0, 1.0), st.floats(0.001, 0.05), st.integers(1, 12))
def test_many_small_steps_keep_what_one_keeps(keep: float, way: float, parts: int) -> None:
    left = []
    for count in (1, parts):
        field = clean_field()
        field.micrograms[:] = 1_000_000_000
        for _ in range(count):
            sweep_at(field, (1.51, 3.01, 0.4), way / count, keep=keep)
        left.append(field.micrograms[field.frame.cell_of(1.51, 3.01)] / 1e9)
    assert left[1] == pytest.approx(left[0], abs=1e-7)
    assert left[0] == pytest.approx(max(keep, 1e-12) ** (way / 0.05), abs=1e-7)


def test_nothing_is_taken_beside_the_brush() -> None:
    field = clean_field()
    field.micrograms[:] = 1_000_000
    drive_over(field, 200)
    row, column = field.frame.cell_of(1.5, 3.0)
    touched = field.micrograms[:, column] < 1_000_000
    assert touched[row - 2 : row + 2].all()
    assert touched.sum() == 4


@given(st.floats(0.5, 4.5), st.floats(0.5, 3.5), st.floats(-4.0, 4.0), st.floats(-1.0, 1.0))
def test_only_cells_under_the_turned_brush_are_touched_and_all_of_them(
    x: float, y: float, theta: float, turn: float
) -> None:
    field = clean_field()
    field.micrograms[:] = 1_000_000
    sweep_at(field, (x, y, theta), 0.01, turn, brush=(0.4, 0.3))
    rows, columns = np.indices(field.frame.shape)
    cell_x, cell_y = field.frame.centres(rows, columns)
    turned = ((cell_x - x) + 1j * (cell_y - y)) * np.exp(-1j * theta)
    over = np.maximum(np.abs(turned.real) - 0.15, np.abs(turned.imag) - 0.2)
    touched = field.micrograms < 1_000_000
    assert not touched[over > 1e-9].any()
    # Where the bristles stand still, in the middle of a turn, nothing is taken.
    way = np.hypot(0.01 - turn * turned.imag, turn * turned.real)
    assert touched[(over < -1e-9) & (way > 1e-6)].all()


@given(
    st.integers(1, 30), st.floats(0.0, 1.0), st.integers(0, 10**9), st.floats(-1.0, 1.0)
)  # fmt: skip
def test_floor_and_bin_are_what_was_there(steps: int, keep: float, room: int, turn: float) -> None:
    field = clean_field()
    field.spread(1.5, 3.0, 0.3, 25.0)
    before = field.total
    taken = 0
    for index in range(steps):
        middle = 1.0 + 0.02 * index, 3.0, 0.3
        taken += sweep_at(field, middle, 0.05, turn, keep, room - taken)
    assert taken <= room
    assert field.total + taken == before
    assert field.micrograms.min() >= 0


def test_a_brush_that_stands_still_or_takes_nothing_takes_nothing() -> None:
    field = clean_field()
    field.micrograms[:] = 10
    assert sweep_at(field, (1.5, 3.0, 0.0), 0.0) == 0
    assert sweep_at(field, (1.5, 3.0, 0.0), 0.01, keep=1.0) == 0
    assert sweep_at(field, (1.5, 3.0, 0.0), 0.01, room=0) == 0
    assert sweep_at(field, (1.5, 3.0, 0.0), -0.01) > 0


def test_the_brush_at_the_grids_border_reaches_over_nothing() -> None:
    field = clean_field()
    field.micrograms[:] = 1_000_000
    for x, y in ((-3.0, 2.0), (9.0, 9.0)):
        assert sweep_at(field, (x, y, 0.3), 0.01, brush=(0.2, 0.2)) == 0
    for x, y, corner in ((-0.1, -0.1, (0, 0)), (5.1, 4.1, (-1, -1))):
        before = field.micrograms.copy()
        sweep_at(field, (x, y, 0.0), 0.01, brush=(0.1, 0.1))
        before[corner] = field.micrograms[corner]
        assert before[corner] < 1_000_000
        assert (field.micrograms == before).all()


def test_the_amount_under_a_disc_is_that_of_its_cells() -> None:
    field = clean_field()
    field.spread(1.4, 2.9, 0.3, 25.0)
    rows, columns = np.indices(field.frame.shape)
    x, y = field.frame.centres(rows, columns)
    for disc in ((1.51, 3.02), (1.2, 2.7), (0.0, 0.0), (5.05, 4.05), (-9.0, 0.0)):
        under = amount_under_disc(field.micrograms, field.place, *disc, 0.174)
        expected = field.micrograms[np.hypot(x - disc[0], y - disc[1]) <= 0.174].sum()
        assert under == expected
    assert amount_under_disc(field.micrograms, field.place, 1.51, 3.02, 0.174) > 1_000_000


def share_taken(brush: float, fan: float, carpets: tuple[Block, ...] = ()) -> float:
    """Drive once over an even floor; return the share of the dirt that was under the brush.

    Wheels do not slip, so that it stays in its lane.
    """
    home = room_home(10.0, 4.0, carpets=carpets)
    world = Simulator(home, IDEAL, start=Pose(0.5, 2.0, 0.0))
    world.dirt.micrograms[world.dirt.floor] = 100_000
    world.set_power(brush, fan)
    drive(world, 0.4, 0.0, 15.0)
    row, column = world.dirt.frame.cell_of(4.0, 2.0)
    lane = world.dirt.micrograms[row - 2 : row + 2, column : column + 40]
    return 1.0 - float(lane.mean()) / 100_000


@pytest.mark.parametrize(
    ("brush", "fan"), [(0.0, 0.0), (1.0, 0.0), (0.5, 0.0), (0.0, 1.0), (1.0, 0.6), (0.7, 0.3)]
)
def test_brush_and_fan_levels_decide_what_a_pass_takes_and_carpet_holds_it(
    brush: float, fan: float
) -> None:
    by_fan = CONFIG.simulation.fan.pickup * fan
    on_floor = pickup_share(CONFIG.simulation.brush.pickup * brush, by_fan)
    on_carpet = pickup_share(CONFIG.simulation.brush.carpet_pickup * brush, by_fan)
    assert share_taken(brush, fan) == pytest.approx(on_floor, abs=0.03)
    assert share_taken(brush, fan, ((0.0, 0.0, 10.0, 4.0),)) == pytest.approx(on_carpet, abs=0.03)


def test_the_shipped_levels_take_four_fifths() -> None:
    assert share_taken(CONFIG.brush.duty, CONFIG.fan.duty) == pytest.approx(0.8, abs=0.02)


def test_the_bin_and_the_floor_are_all_that_was_brought_in_whatever_is_driven() -> None:
    sources = (DirtSource("table", 2.5, 2.0, 0.5, 30.0, 500.0),)
    world = Simulator(room_home(sources=sources), NOISY, start=Pose(2.5, 2.0, 0.0))
    random = np.random.default_rng(2)
    for _ in range(60):
        drive(world, random.uniform(-0.2, 0.5), random.uniform(-2.0, 2.0), 1.0)
        assert world.dirt.total + world.in_bin == world.brought_in
        assert world.dirt.micrograms.min() >= 0
    assert world.in_bin > 1_000_000
    assert not world.dirt.micrograms[~world.dirt.floor].any()


def test_a_full_bin_takes_no_more_to_the_last_microgram() -> None:
    small = SimulatedRobotConfig(brush=CONFIG.brush.model_copy(update={"bin_capacity": 0.5}))
    world = Simulator(room_home(), small, start=Pose(0.5, 2.0, 0.0))
    world.spill(2.5, 2.0, 0.5, 20.0)
    seen = drive(world, 0.5, 0.0, 8.0)
    assert world.in_bin == 500_000
    assert seen.in_bin == 0.5
    assert seen.grains < 1.0
    assert world.dirt.total + world.in_bin == world.brought_in


def test_grains_are_counted_as_they_come_in() -> None:
    world = Simulator(room_home(), IDEAL, start=Pose(0.5, 2.0, 0.0))
    world.spill(2.0, 2.0, 0.2, 0.2)
    counted, most = 0.0, 0.0
    for _ in range(400):
        grains = world.step(Twist(0.3, 0.0), DT).grains
        assert grains == round(grains)
        counted, most = counted + grains * DT, max(most, grains)
    # It tells whole numbers.
    assert counted == pytest.approx(world.in_bin / CONFIG.dirt_sensor.grain, rel=1e-4)
    assert 0.0 < most < CONFIG.dirt_sensor.most
    world.spill(4.0, 2.0, 0.1, 50.0)
    world.put(Pose(3.0, 2.0, 0.0))
    seen = [world.step(Twist(0.3, 0.0), DT).grains for _ in range(200)]
    assert max(seen) == pytest.approx(CONFIG.dirt_sensor.most, rel=0.03)
    assert max(seen) <= CONFIG.dirt_sensor.most


def test_noisy_grains_are_right_on_average() -> None:
    world = Simulator(room_home(), NOISY, start=Pose(0.5, 2.0, 0.0))
    world.spill(2.0, 2.0, 0.2, 0.2)
    grains = [world.step(Twist(0.3, 0.0), DT).grains * DT for _ in range(400)]
    expected = world.in_bin / CONFIG.dirt_sensor.grain
    assert sum(grains) == pytest.approx(expected, abs=6.0 * expected**0.5)
    assert sum(grains) != pytest.approx(expected, abs=1e-6)


def test_the_brush_motors_current_tells_carpet_from_floor() -> None:
    home = room_home(carpets=((2.5, 0.0, 5.0, 4.0),))
    battery, brush = CONFIG.battery, CONFIG.simulation.brush
    for x, power in ((1.0, brush.power), (3.5, brush.carpet_power)):
        world = Simulator(home, IDEAL, start=Pose(x, 2.0, 0.0))
        world.set_power(brush=0.5)
        current = world.step(Twist(0.0, 1.0), DT).brush_current
        assert current == pytest.approx(0.5 * power / battery.nominal_voltage)
        assert drive(world, 0.0, 0.0, 1.0).brush_current == 0.0
    noisy = Simulator(home, NOISY, start=Pose(1.0, 2.0, 0.0))
    seen = [noisy.step(Twist(0.0, 1.0), DT).brush_current for _ in range(1000)]
    assert float(np.mean(seen)) == pytest.approx(brush.power / battery.nominal_voltage, abs=0.003)
    assert float(np.std(seen)) == pytest.approx(brush.current_noise, rel=0.1)


@settings(max_examples=examples(20))
@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_duties_are_kept_and_one_may_be_left_as_it_is(brush: float, fan: float) -> None:
    world = Simulator(room_home())
    world.set_power(brush, fan)
    assert world.duty == (brush, fan)
    world.set_power(fan=0.25)
    assert world.duty == (brush, 0.25)


@pytest.mark.parametrize("duty", [-0.1, 1.1, float("nan")])
def test_a_duty_that_makes_no_sense_is_refused_and_changes_nothing(duty: float) -> None:
    world = Simulator(room_home())
    before = world.duty
    with pytest.raises(ValueError, match="fan: expected a duty from 0 to 1"):
        world.set_power(0.5, duty)
    assert world.duty == before
