"""The last stages of a map: links anew, keyframes that agree, and walls along the axes."""

from __future__ import annotations

import math

import numpy as np

from roomba.configuration.mapping import MappingConfig
from roomba.perception.slam.finishing.axis_alignment import phase_of_walls, turn_of_walls
from roomba.perception.slam.finishing.refinement import refined
from roomba.perception.slam.submaps.pose_graph import Link
from roomba.perception.slam.submaps.submap_graph import SubmapGraph


def finish(graph: SubmapGraph, config: MappingConfig) -> tuple[float, float]:
    """Bring all submaps and their keyframes to agree, and lay walls along the map's axes.

    Returns where, x and y, m, walls then lie between the cells of a grid.
    """
    graph.join_parts()
    graph.link_anew()
    refine_keyframes(graph, config.point_deviation)
    return align_axes(graph, config.resolution, math.radians(config.oblique))


def refine_keyframes(graph: SubmapGraph, point_deviation: float) -> None:
    """Move each keyframe by itself, so that it agrees with all others that show the same walls.

    ``point_deviation``, m, is the standard deviation of a point.
    """
    frames, poses = zip(*graph.keyframes(), strict=True)
    after = refined(
        list(frames),
        np.array(poses),
        _steps_between_submaps(graph),
        graph.reach,
        graph.range_deviation,
        point_deviation,
    )
    first = 0
    for number, submap in enumerate(graph.submaps):
        last = first + len(submap.keyframes)
        if last > first:
            graph.lay(number, after[first:last])
        first = last


def align_axes(graph: SubmapGraph, resolution: float, oblique: float) -> tuple[float, float]:
    """Turn all submaps around the first one, so that walls lie along the axes.

    Returns where, x and y, m, walls then lie between the cells of a grid of ``resolution``, m.
    Walls that are turned by more than ``oblique``, rad, stay so.
    """
    turn = turn_of_walls(graph.cloud(), oblique)
    around = graph.poses[0, :2].copy()
    cosine, sine = math.cos(turn), math.sin(turn)
    back = np.array([[cosine, -sine], [sine, cosine]])
    graph.poses[:, :2] = (graph.poses[:, :2] - around) @ back + around
    graph.poses[:, 2] -= turn
    return phase_of_walls(graph.cloud(), resolution)


def _steps_between_submaps(graph: SubmapGraph) -> dict[int, Link]:
    """Return the links that lead into submaps, by the number of their first keyframe."""
    firsts = np.cumsum([0, *(len(submap.keyframes) for submap in graph.submaps)])
    return {
        int(firsts[link.child]): link
        for link in graph.links
        if not link.may_be_wrong and graph.submaps[link.child].keyframes
    }
