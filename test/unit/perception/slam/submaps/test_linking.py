"""Links between submaps: where they show the same walls, and nowhere else."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fixtures.homes.rooms import room_home
from fixtures.robots.located import Eye
from fixtures.robots.mapped import FURNISHED, points_of, row

from roomba.configuration.mapping import MappingConfig
from roomba.geometry import Pose, wrap_angle
from roomba.perception.slam.submaps.linking import Linker
from roomba.perception.slam.submaps.pose_graph import Link, LinkKind, relative_to
from roomba.perception.slam.submaps.submap import Keyframe, Submap
from roomba.world.home.home import Home

CONFIG = MappingConfig()
KNOWN = 1e4 * np.eye(3)
"""1/m2, 1/rad2; of a link over which scans led."""
HERE, THERE = Pose(2.5, 1.2, 0.0), Pose(1.6, 2.6, 1.9)


def submap(at: Pose, home: Home = FURNISHED, seed: int = 0) -> Submap:
    """Four scans on half a metre from a pose on, with the lidar's noise."""
    eye, random = Eye(home), np.random.default_rng(seed)
    made = Submap(0.0)
    for step in range(4):
        inner = Pose(0.15 * step, 0.0, 0.1 * step)
        points = points_of(eye.scan(at.compose(inner), random))
        made.keyframes.append(Keyframe(points.astype(np.float32), row(inner)))
    made.close(1500)
    return made


def linked(
    submaps: list[Submap],
    poses: list[Pose],
    links: list[Link] | None = None,
    config: MappingConfig = CONFIG,
) -> list[Link]:
    rows = np.array([row(pose) for pose in poses])
    child = len(poses) - 1
    return Linker(config, 16.0).links_to(child, child, submaps, rows, links or [])


def driven(poses: list[Pose]) -> list[Link]:
    """What links a chain of poses, as they are thought to be."""
    rows = np.array([row(pose) for pose in poses])
    return [
        Link(
            at,
            at + 1,
            relative_to(rows[at : at + 1], rows[at + 1 : at + 2])[0],
            KNOWN,
            LinkKind.DRIVEN,
        )
        for at in range(len(poses) - 1)
    ]


def error(link: Link, parent: Pose, child: Pose) -> tuple[float, float]:
    true = parent.inverse().compose(child)
    x, y, theta = link.relative.tolist()
    return math.hypot(x - true.x, y - true.y), abs(wrap_angle(theta - true.theta))


@pytest.mark.parametrize(
    "off",
    [Pose(), Pose(0.1, -0.08, 0.03), Pose(-0.12, 0.05, -0.05)],
    ids=["on it", "left", "right"],
)
def test_two_views_of_a_room_are_linked_exactly(off: Pose) -> None:
    thought = [HERE, THERE.compose(off)]
    (link,) = linked([submap(HERE), submap(THERE, seed=1)], thought, driven(thought))
    assert (link.parent, link.child, link.may_be_wrong) == (0, 1, True)
    away, turned = error(link, HERE, THERE)
    assert away < 0.008
    assert turned < 0.004


@pytest.mark.parametrize(("off", "is_kept"), [(0.002, True), (0.02, False)])
def test_a_link_that_tells_where_submaps_lie_is_not_looked_for_again(
    off: float, is_kept: bool
) -> None:
    thought = [HERE, THERE]
    submaps, chain = [submap(HERE), submap(THERE, seed=1)], driven(thought)
    relative = chain[0].relative + np.array([off, 0.0, 0.0])
    before = Link(0, 1, relative, KNOWN)
    (link,) = linked(submaps, thought, [*chain, before])
    assert (link is before) == is_kept
    # What was driven is no match of what was seen.
    (matched,) = linked(submaps, thought, chain)
    assert matched is not chain[0]
    assert error(matched, HERE, THERE)[0] < 0.008


def test_no_link_is_surer_than_beams_that_err_alike() -> None:
    thought = [HERE, THERE]
    (link,) = linked([submap(HERE), submap(THERE, seed=1)], thought, driven(thought))
    least = np.diag([CONFIG.least_link_deviation**-2] * 2 + [CONFIG.least_link_turn**-2])
    # The difference has no negative direction.
    assert np.linalg.eigvalsh(least - link.information).min() > -1e-6 * least.max()
    assert np.linalg.eigvalsh(link.information).min() > 0.0


@pytest.mark.parametrize(
    "drift", [(0.5, 0.35, 0.05), (0.5, 0.35, 0.15), (-0.9, 0.4, -0.1), (1.0, 0.0, 0.05)]
)
def test_after_a_long_way_it_is_looked_for_farther_around(
    drift: tuple[float, float, float],
) -> None:
    """On 120 m of way it may drift so much; after 5 m that is no drift but another place."""
    drifted = THERE.compose(Pose(*drift))
    submaps = [submap(HERE), Submap(0.0), submap(THERE, seed=1)]
    for far, count in ((60.0, 1), (2.0, 0)):
        between = Pose(HERE.x + far, HERE.y, 0.0)
        thought = [HERE, between, drifted]
        found = linked(submaps, thought, driven(thought))
        assert len(found) == count
        for link in found:
            assert error(link, HERE, THERE)[0] < 0.01


@pytest.mark.parametrize("shortcut", [((0, 2), (2, 3)), ((2, 0), (3, 2)), ((2, 3), (0, 2))])
def test_the_shortest_chain_of_links_tells_how_far_it_may_have_drifted(
    shortcut: tuple[tuple[int, int], ...],
) -> None:
    """At the end of 120 m it is found 0.6 m off; not if links over 3 m join the two as well."""
    drifted, far = THERE.compose(Pose(0.5, 0.35, 0.05)), Pose(HERE.x + 60.0, HERE.y, 0.0)
    thought = [HERE, far, Pose(HERE.x, HERE.y + 1.0, 0.0), drifted]
    submaps = [submap(HERE), Submap(0.0), Submap(0.0), submap(THERE, seed=1)]
    around = ((0, 1), (1, 3))
    for ends, count in ((around, 1), ((*around, *shortcut), 0)):
        links = [Link(*each, np.zeros(3), KNOWN, LinkKind.DRIVEN) for each in ends]
        assert len(linked(submaps, thought, links)) == count


def test_other_rooms_are_not_linked() -> None:
    """Of another size, or with walls where the other has none."""
    other = room_home(3.4, 5.3, ((1.0, 3.0, 2.0, 3.6),))
    thought = [HERE, THERE]
    submaps = [submap(HERE), submap(Pose(1.2, 1.5, 0.3), other)]
    assert linked(submaps, thought, driven(thought)) == []


def test_what_lies_far_away_is_not_matched() -> None:
    thought, submaps = [HERE, THERE], [submap(HERE), submap(THERE, seed=1)]
    away = HERE.distance_to(THERE.x, THERE.y)
    for radius, count in ((away - 0.01, 0), (away + 0.01, 1)):
        config = CONFIG.model_copy(update={"link_radius": radius})
        assert len(linked(submaps, thought, driven(thought), config)) == count


@pytest.mark.parametrize(("least", "count"), [(0.5, 1), (0.9, 0)])
def test_as_much_as_wanted_must_be_seen_again(least: float, count: int) -> None:
    """A third of the walls of a room that is 0.6 m longer are nowhere in the other."""
    longer = room_home(5.0, 4.6, ((3.3, 3.1, 3.8, 4.6),))
    submaps, thought = [submap(HERE), submap(THERE, longer, 1)], [HERE, THERE]
    config = CONFIG.model_copy(update={"link_met": least})
    assert len(linked(submaps, thought, driven(thought), config)) == count


@pytest.mark.parametrize(("least", "count"), [(0.4, 1), (0.8, 0)])
def test_a_link_needs_points_close_to_the_surfaces(least: float, count: int) -> None:
    """Of a third of the points the walls stand 6 cm nearer."""
    submaps, thought = [submap(HERE), submap(THERE, seed=1)], [HERE, THERE]
    cloud = submaps[1].cloud
    cloud[::3, :2] += 0.06 * cloud[::3, 2:]
    config = CONFIG.model_copy(update={"link_close": least})
    assert len(linked(submaps, thought, driven(thought), config)) == count


def cut(made: Submap, points: int) -> Submap:
    made.cloud = made.cloud[:points]
    return made


@pytest.mark.parametrize(("parent", "child"), [(0, 1500), (1500, 0), (1500, 100)])
def test_too_little_in_sight_is_no_link(parent: int, child: int) -> None:
    thought = [HERE, THERE]
    submaps = [cut(submap(HERE), parent), cut(submap(THERE, seed=1), child)]
    assert linked(submaps, thought, driven(thought)) == []


def test_a_corridor_says_nothing_along_itself() -> None:
    """Its ends out of sight, a link leaves open how far along it lies."""
    corridor = room_home(30.0, 1.2, station=Pose(15.0, 0.6, 0.0))
    here, there = Pose(15.0, 0.6, 0.0), Pose(15.6, 0.6, 0.0)
    (link,) = linked(
        [submap(here, corridor), submap(there, corridor, 1)], [here, there], driven([here, there])
    )
    across, along = link.information[1, 1], link.information[0, 0]
    assert across > 20.0 * along
