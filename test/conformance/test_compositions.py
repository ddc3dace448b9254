"""However the robot is put together, it does the same: same home, same seed, same outcome."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.homes.worlds import NOISY
from fixtures.robots.compositions import COMPOSITIONS, REFERENCE, Case, Outcome, assert_same
from fixtures.robots.missions import HOME, TWO_ROOMS
from fixtures.thoroughness import core_first, examples
from hypothesis import Phase as Stage
from hypothesis import given, settings
from hypothesis import strategies as st

from roomba.clean_request import CleanRequest
from roomba.configuration.body import BodyConfig
from roomba.geometry import Pose
from roomba.headless.body import SimulatedBody
from roomba.headless.mission import HeadlessMission
from roomba.robot.readings import Readings
from roomba.vocabulary import Phase
from roomba.world.random.home import random_home

THING = (1.0, 0.75, 0.10)
"""x, y and radius, m, of something on the floor of HOME that its map does not show."""
CASES = {
    "clean": Case(TWO_ROOMS),
    "clean, ideal": Case(HOME, sensors="ideal"),
    "clean around a thing": Case(HOME, things=(THING,), seed=3),
    "clean at the body's top speed": Case(HOME, speed=0.5, seed=2),
    "clean as slowly as the robot can": Case(HOME, max_speed=0.1, seconds=240.0),
    "explore": Case(TWO_ROOMS, is_mapped=False, explores=True),
    "explore, ideal, slowly": Case(
        TWO_ROOMS, sensors="ideal", is_mapped=False, explores=True, speed=0.2
    ),
    "clean with a lidar that turns": Case(HOME, lidar="neato", seed=2),
    "explore with a lidar that turns": Case(
        TWO_ROOMS, lidar="lds_01", is_mapped=False, explores=True
    ),
    "clean while mapping": Case(TWO_ROOMS, is_mapped=False, seed=2),
    "clean with worn wheels": Case(TWO_ROOMS, wheels="worn", seed=2),
    # Of this seed it touches nothing: a touch would amplify the last bits, if some differed.
    "clean with worn wheels and a lidar that turns": Case(
        HOME, wheels="worn", lidar="neato", seed=1
    ),
    "explore with worn wheels": Case(TWO_ROOMS, wheels="worn", is_mapped=False, explores=True),
    "charge on the way": Case(HOME, charge=0.09, charge_at=30.0, seconds=300.0),
}

CORE = {
    "clean",
    "clean around a thing",
    "explore",
    "clean with worn wheels and a lidar that turns",
    "clean while mapping",
    "charge on the way",
}


@pytest.fixture(scope="module")
def references() -> dict[str, Outcome]:
    return {}


@pytest.mark.parametrize("name", core_first(CASES, CORE))
@pytest.mark.parametrize("composition", core_first(COMPOSITIONS, {"bursts"}))
def test_it_does_the_same(composition: str, name: str, references: dict[str, Outcome]) -> None:
    case = CASES[name]
    if name not in references:
        references[name] = REFERENCE(case)
    reference = references[name]
    way = np.hypot(*np.diff(reference.poses[:, 1:3], axis=0).T).sum()
    assert way > 3.0
    assert_same(COMPOSITIONS[composition](case), reference, within=1e-6)


def test_bursts_run_with_a_lidar_that_turns() -> None:
    robot = HeadlessMission(HOME, NOISY.with_lidar("neato"), seed=2)
    robot.mission.clean(CleanRequest(), robot.senses())
    while robot.seen.time < 60.0:
        robot.advance()
    # Without bursts it would be a piece for each tick.
    assert len(robot.rows) < 0.25 * len(robot.passed)


def test_a_charge_is_one_of_the_cases() -> None:
    case = CASES["charge on the way"]
    assert COMPOSITIONS["bursts"](case).phase is Phase.CHARGING


@pytest.mark.parametrize("composition", COMPOSITIONS)
def test_the_same_seed_gives_the_same_trace_and_another_one_another(composition: str) -> None:
    cases = [Case(HOME, seed=seed, seconds=60.0) for seed in (3, 3, 4)]
    traces = [COMPOSITIONS[composition](case).poses.tobytes() for case in cases]
    assert traces[0] == traces[1]
    assert traces[0] != traces[2]


@pytest.mark.parametrize("seed", [41, 42])
def test_in_random_homes_as_well(seed: int) -> None:
    home = random_home(seed, BodyConfig())
    case = Case(home, seed=seed, seconds=150.0)
    assert_same(COMPOSITIONS["bursts"](case), REFERENCE(case))


def test_wheels_that_are_a_nanometre_off_lead_along_the_same_path(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    case = Case(HOME, things=((1.03, 0.77, 0.10),), seed=3, speed=0.2, begin=5.0, seconds=170.0)
    reference, plain = REFERENCE(case), SimulatedBody.read

    def read(body: SimulatedBody) -> Readings:
        readings = plain(body)
        odometry = readings.odometry
        off = 1e-9 if readings.time >= case.begin else 0.0
        return replace(readings, odometry=replace(odometry, x=odometry.x + off))

    monkeypatch.setattr(SimulatedBody, "read", read)
    # A tenth of what two compositions may differ by.
    assert_same(REFERENCE(case), reference, within=1e-3)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """A small room with a box in it, a thing that its map does not show, a robot and an errand."""
    width, depth = draw(st.floats(1.6, 3.0)), draw(st.floats(1.6, 3.0))
    left, low = draw(st.floats(0.9, width - 0.5)), draw(st.floats(0.0, depth - 0.3))
    box = (left, low, left + draw(st.floats(0.1, 0.5)), low + draw(st.floats(0.1, 0.3)))
    x, y = draw(st.floats(0.8, width - 0.3)), draw(st.floats(0.3, depth - 0.3))
    is_mapped = draw(st.booleans())
    return Case(
        room_home(width, depth, (box,), station=Pose(0.2, 0.5 * depth, np.pi)),
        sensors=draw(st.sampled_from(("noisy", "ideal"))),
        lidar=draw(st.sampled_from((None, "neato", "lds_01", "rplidar_a1"))),
        wheels=draw(st.sampled_from(("factory", "worn"))),
        seed=draw(st.integers(0, 1000)),
        is_mapped=is_mapped,
        explores=not is_mapped and draw(st.booleans()),
        things=((x, y, 0.05),) if draw(st.booleans()) else (),
        speed=draw(st.floats(0.1, 0.5)),
        max_speed=draw(st.sampled_from((0.5, 0.25))),
        seconds=45.0,
    )


@settings(
    max_examples=examples(12),
    deadline=None,
    derandomize=True,
    # Each example takes seconds: one that fails is not made smaller.
    phases=(Stage.explicit, Stage.generate),
)
@given(cases())
def test_with_and_without_bursts_a_run_is_the_same(case: Case) -> None:
    assert_same(COMPOSITIONS["bursts"](case), REFERENCE(case), within=1e-6)
