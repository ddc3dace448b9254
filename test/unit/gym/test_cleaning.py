"""Episodes in a turned home equal those of the unturned home, expressed in the turned frame."""

import math
from typing import Any

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from numpy.typing import NDArray

from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.gym import RoombaClean, RoombaCleanVector
from roomba.world.home.home import DirtSource, Home
from roomba.world.home.turned import turned_home

HOME = room_home(
    blocks=[(1.5, 2.5, 2.5, 4.0)], sources=(DirtSource("dust", 3.0, 1.0, 1.0, 5.0, 0.0),)
)
ROUNDED = 1e-6
"""What turning a start to and fro may change."""


def episode_in(home: Home, start: Pose | None) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return observations, rewards and covered shares, and poses, of a drive by chance."""
    environment = RoombaClean(home=home)
    random = np.random.default_rng(0)
    options = {"start": (start.x, start.y, start.theta)} if start is not None else None
    seen, info = environment.reset(seed=5, options=options)
    rows, poses = [np.append(seen, (0.0, info["covered"]))], [info["pose"]]
    for _ in range(30):
        seen, reward, _, _, info = environment.step(random.uniform(-1.0, 1.0, 2).astype(np.float32))
        rows.append(np.append(seen, (reward, info["covered"])))
        poses.append(info["pose"])
    return np.stack(rows), np.stack(poses)


@pytest.mark.parametrize("degrees", [30.0, 90.0, 180.0, -100.0])
@pytest.mark.parametrize("start", [None, Pose(3.0, 1.0, 0.5)])
def test_in_a_turned_home_all_is_the_same_but_turned(degrees: float, start: Pose | None) -> None:
    turned = turned_home(HOME, math.radians(degrees))
    rows, poses = episode_in(HOME, start)
    turned_rows, turned_poses = episode_in(turned, start and turned.told(start))
    assert turned_rows == pytest.approx(rows, abs=ROUNDED if start else 0.0)
    expected = [turned.told(Pose(*pose)).as_array() for pose in poses]
    assert turned_poses == pytest.approx(np.array(expected), abs=ROUNDED)


def test_the_station_of_a_turned_home_is_in_the_turned_frame() -> None:
    robots = RoombaCleanVector(2, home=turned_home(HOME, 0.5 * math.pi))
    _, infos = robots.reset(seed=1, options={"at_station": True})
    assert infos["pose"] == pytest.approx(np.array([(-0.5, 0.5, 0.5 * math.pi)] * 2))


def test_a_start_that_is_refused_is_told_as_it_was_given() -> None:
    environment = RoombaClean(home=turned_home(HOME, 0.5 * math.pi))
    with pytest.raises(HomeError, match=r"does not fit at \(-0\.10, 2\.00\)"):
        environment.reset(options={"start": (-0.1, 2.0, 0.0)})
