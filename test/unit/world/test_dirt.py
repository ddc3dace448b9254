import math

import numpy as np
import pytest
from fixtures.rooms import room_home
from hypothesis import given
from hypothesis import strategies as st

from roomba.grid import GridFrame
from roomba.world import dirt_kernels
from roomba.world.dirt import MICROGRAMS_PER_GRAM, DirtField

BRUSH = np.array([0.2, 0.05, 0.8])


def clean_field() -> DirtField:
    home = room_home(blocks=((2.0, 1.0, 3.0, 2.0),))
    return DirtField(home.frame, home.solid)


@given(
    st.floats(0.1, 4.9),
    st.floats(0.1, 3.9),
    st.floats(0.1, 3.0),
    st.floats(0.0, 500.0),
)
def test_what_falls_lies_on_the_floor_to_the_last_microgram(
    x: float, y: float, radius: float, grams: float
) -> None:
    field = clean_field()
    try:
        brought = field.spread(x, y, radius, grams)
    except ValueError:
        # in the middle of the block there is no floor near enough
        assert 2.0 < x < 3.0
        return
    assert brought == round(grams * MICROGRAMS_PER_GRAM)
    assert field.total == brought
    solid = room_home(blocks=((2.0, 1.0, 3.0, 2.0),)).solid
    assert not field.micrograms[solid].any()


def test_most_of_it_falls_near_its_source() -> None:
    field = clean_field()
    field.spread(1.0, 3.0, 0.2, 10.0)
    row, column = np.unravel_index(field.micrograms.argmax(), field.micrograms.shape)
    x, y = field.frame.centre_of(int(row), int(column))
    assert math.hypot(x - 1.0, y - 3.0) < 0.1
    assert float(field.density.max()) == pytest.approx(10.0 / (2 * math.pi * 0.04), rel=0.05)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((math.nan, 1.0, 0.2, 1.0), "finite"),
        ((1.0, 1.0, 0.0, 1.0), "radius above 0"),
        ((1.0, 1.0, 0.2, -1.0), "amount of 0 g or more"),
        ((50.0, 1.0, 0.2, 1.0), "no floor within"),
        ((1.0, 1.0, 0.01, 1e5), "more than the floor"),
        ((1.0, 1.0, 0.5, 1e30), "more than the floor"),
    ],
)
def test_what_cannot_fall_is_refused_and_nothing_changes(
    arguments: tuple[float, float, float, float], said: str
) -> None:
    field = clean_field()
    with pytest.raises(ValueError, match=said):
        field.spread(*arguments)
    assert field.total == 0


def drive_over(field: DirtField, steps: int, brush: np.ndarray = BRUSH) -> int:
    """Drive 2 m along y = 3 in so many steps; return what was taken."""
    taken = 0
    for index in range(steps):
        x = 0.5 + 2.0 * (index + 0.5) / steps
        taken += dirt_kernels.sweep(
            field.micrograms, field.place, brush, x, 3.0, 0.0, 2.0 / steps, 0.0, 1.0, 10**15
        )
    return taken


def test_a_pass_takes_the_brushs_share_whatever_the_step() -> None:
    for steps in (160, 400, 1000):
        field = clean_field()
        field.micrograms[:] = 1_000_000
        drive_over(field, steps)
        row, column = field.frame.cell_of(1.5, 3.0)
        assert field.micrograms[row, column] / 1e6 == pytest.approx(0.2, abs=0.02)


def test_nothing_is_taken_beside_the_brush() -> None:
    field = clean_field()
    field.micrograms[:] = 1_000_000
    drive_over(field, 200)
    row, column = field.frame.cell_of(1.5, 3.0)
    touched = field.micrograms[:, column] < 1_000_000
    assert touched[row - 2 : row + 2].all()
    assert touched.sum() == 4


@given(st.integers(1, 30), st.floats(0.0, 1.0), st.integers(0, 10**9))
def test_floor_and_bin_are_what_was_there(steps: int, efficiency: float, room: int) -> None:
    field = clean_field()
    field.spread(1.5, 3.0, 0.3, 25.0)
    before = field.total
    taken = 0
    brush = np.array([0.2, 0.05, efficiency])
    for index in range(steps):
        taken += dirt_kernels.sweep(
            field.micrograms,
            field.place,
            brush,
            1.0 + 0.02 * index,
            3.0,
            0.3,
            0.4,
            1.0,
            0.05,
            room - taken,
        )
    assert taken <= room
    assert field.total + taken == before


def test_the_amount_under_a_disc_is_that_of_its_cells() -> None:
    field = clean_field()
    field.spread(1.4, 2.9, 0.3, 25.0)
    under = dirt_kernels.amount_under_disc(field.micrograms, field.place, 1.51, 3.02, 0.174)
    rows, columns = np.indices(field.frame.shape)
    x, y = field.frame.centre_of(rows, columns)  # type: ignore[arg-type]
    assert under == field.micrograms[np.hypot(x - 1.51, y - 3.02) <= 0.174].sum()
    assert under > 1_000_000


def test_a_coarse_map_gets_finer_dirt() -> None:
    frame = GridFrame(0.2, -1.0, -1.0, 10, 10)
    solid = np.zeros(frame.shape, bool)
    solid[0] = True
    field = DirtField(frame, solid)
    assert field.frame.resolution == pytest.approx(0.1)
    assert field.frame.shape == (20, 20)
    field.spread(0.0, -0.7, 0.3, 1.0)
    assert not field.micrograms[:2].any()
