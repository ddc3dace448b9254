"""Places all over a map where points fit, and none where several fit alike."""

from __future__ import annotations

import numpy as np
from fixtures.homes.rooms import room_home
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, points_of, row

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose
from roomba.perception.matching.pose_kernels import is_apart
from roomba.perception.slam.submaps.places import clearly_best
from roomba.perception.slam.submaps.submap import Keyframe, Submap
from roomba.world.home.home import Home

CONFIG = MappingConfig()
LEAST = CONFIG.windows.likely
ALIKE = room_home(8.2, 4.0, ((4.0, 0.0, 4.2, 4.0), (3.0, 3.4, 4.0, 4.0), (7.2, 3.4, 8.2, 4.0)))
"""Two rooms that look the same."""


def submap(at: Pose, home: Home = FURNISHED) -> Submap:
    """A scan from a pose."""
    made = Submap(0.0, [Keyframe(points_of(Eye(home).scan(at)).astype(np.float32), np.zeros(3))])
    made.close(1500)
    return made


def test_points_are_found_at_any_heading_and_the_submap_is_told() -> None:
    poses = [Pose(1.2, 1.0, 0.3), Pose(3.4, 2.2, -2.0)]
    submaps = [submap(pose) for pose in poses]
    there = Pose(2.9, 2.6, 2.9)
    cloud = submap(there).cloud
    (found,) = clearly_best(
        [cloud], submaps, np.array([row(each) for each in poses]), CONFIG, LEAST
    )
    assert found is not None
    assert not is_apart(found.pose, row(there), 0.05, 0.02)
    assert found.submap in (0, 1)
    assert 0.8 < found.score <= 1.0


def test_where_two_places_look_alike_none_is_best_but_of_the_others_one_is() -> None:
    poses = [Pose(2.0, 2.0, 0.0), Pose(6.2, 2.0, 0.0)]
    submaps = [submap(pose, ALIKE) for pose in poses]
    rows = np.array([row(each) for each in poses])
    clouds = [submap(Pose(1.5, 1.0, 1.0), ALIKE).cloud, submap(Pose(2.0, 1.4, 0.5)).cloud]
    assert clearly_best(clouds, submaps, rows, CONFIG, LEAST)[0] is None
    one, none = clearly_best(clouds, submaps[:1], rows[:1], CONFIG, 0.8)
    assert one is not None
    assert not is_apart(one.pose, row(Pose(1.5, 1.0, 1.0)), 0.05, 0.02)
    assert none is None  # of another home


def test_on_a_map_without_points_nothing_is_found() -> None:
    cloud = submap(Pose(1.5, 1.0, 0.0)).cloud
    assert clearly_best([cloud], [Submap(0.0)], np.zeros((1, 3)), CONFIG, LEAST) == [None]
    assert clearly_best([], [submap(Pose(1.5, 1.0, 0.0))], np.zeros((1, 3)), CONFIG, LEAST) == []
