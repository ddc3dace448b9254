"""The generator of robots and worlds: its published numbers, and its distributions."""

from __future__ import annotations

import numpy as np
import pytest
from fixtures.homes.worlds import NOISY

from roomba.world.engine.populate import first_robots
from roomba.world.engine.state.arrays import WORLD, Row
from roomba.world.engine.state.random_kernels import (
    next_bits,
    next_exponential,
    next_normal,
    next_uniform,
    normal_quantiles,
)

COUNT = 20_000


@pytest.fixture
def owner() -> Row:
    row = np.zeros(1, WORLD).view(np.recarray)[0]
    row.random = 1234567
    return row


@pytest.mark.filterwarnings("ignore:overflow")
def test_the_bits_are_those_of_splitmix64(owner: Row) -> None:
    """The numbers that Rosetta Code gives for this seed."""
    assert [int(next_bits(owner)) for _ in range(5)] == [
        6457827717110365317,
        3203168211198807973,
        9817491932198370423,
        4593380528125082431,
        16408922859458223821,
    ]


@pytest.mark.filterwarnings("ignore:overflow")
def test_uniform_normal_and_exponential_numbers_are_distributed_so(owner: Row) -> None:
    quantiles = normal_quantiles()
    uniform = np.array([next_uniform(owner) for _ in range(COUNT)])
    assert uniform.min() >= 0.0
    assert uniform.max() < 1.0
    counts, _ = np.histogram(uniform, 20, (0.0, 1.0))
    assert ((counts - COUNT / 20) ** 2).sum() / (COUNT / 20) < 45.0  # chi squared, 0.1 %
    normal = np.array([next_normal(owner, quantiles) for _ in range(COUNT)])
    assert (normal.mean(), normal.std()) == pytest.approx((0.0, 1.0), abs=0.03)
    assert (np.abs(normal) < 1.0).mean() == pytest.approx(0.6827, abs=0.01)
    assert (np.abs(normal) > 3.0).mean() == pytest.approx(0.0027, abs=0.0015)
    waits = np.array([next_exponential(owner) for _ in range(COUNT)])
    assert waits.min() >= 0.0
    assert (waits.mean(), waits.std()) == pytest.approx((1.0, 1.0), abs=0.04)


def test_the_quantiles_are_even_and_nearly_of_variance_one() -> None:
    quantiles = normal_quantiles()
    assert quantiles.dtype == np.float32
    assert (np.diff(quantiles) > 0.0).all()
    assert quantiles == pytest.approx(-quantiles[::-1], abs=1e-6)
    assert float(quantiles.std()) == pytest.approx(1.0, abs=1e-3)
    assert float(quantiles.max()) == pytest.approx(3.67, abs=0.01)


def test_robots_of_all_seeds_and_numbers_have_chance_and_errors_of_their_own() -> None:
    robots = first_robots(NOISY, range(50), 4, 0.5)
    truth = NOISY.simulation
    for name in ("random", "wheel_left_size", "wheel_right_size", "gyro_scale", "gyro_bias"):
        assert len(set(robots[name].tolist())) == 200
    sizes = np.concatenate([robots["wheel_left_size"], robots["wheel_right_size"]])
    assert float(sizes.mean()) == pytest.approx(1.0, abs=6e-4)
    assert float(sizes.std()) == pytest.approx(truth.wheels.scale_error, rel=0.15)
    assert float(robots["gyro_scale"].std()) == pytest.approx(
        NOISY.simulation.gyro.scale_error, rel=0.2
    )
    assert float(robots["gyro_bias"].std()) == pytest.approx(truth.gyro.bias, rel=0.2)
