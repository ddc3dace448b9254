import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from hypothesis import given
from hypothesis import strategies as st

from roomba.grid import GridFrame
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM, DirtField


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


def test_a_coarse_map_gets_finer_dirt() -> None:
    frame = GridFrame(0.2, -1.0, -1.0, 10, 10)
    solid = np.zeros(frame.shape, bool)
    solid[0] = True
    field = DirtField(frame, solid)
    assert field.frame.resolution == pytest.approx(0.1)
    assert field.frame.shape == (20, 20)
    field.spread(0.0, -0.7, 0.3, 1.0)
    assert not field.micrograms[:2].any()
