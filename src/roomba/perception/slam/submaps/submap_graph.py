"""The graph of submaps: links tie them together, and its solution places them on the map."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.configuration.localization import LocalizationConfig
from roomba.configuration.mapping import MappingConfig
from roomba.perception.slam.submaps.agreement import is_backed, is_far
from roomba.perception.slam.submaps.heading_drift import HeadingDrift, heading_drift
from roomba.perception.slam.submaps.linking import Linker
from roomba.perception.slam.submaps.parts import (
    Carried,
    FoundPart,
    found_part,
    hanging_on,
    is_contradicted,
    part_labels,
)
from roomba.perception.slam.submaps.pose_graph import (
    Link,
    LinkKind,
    composed,
    inverse,
    optimised,
    relative_to,
)
from roomba.perception.slam.submaps.submap import KeptSubmap, Keyframe, Submap, moved

CLOUD: Final = 1500
"""Points of a submap that are matched to other submaps, at most."""
_RECENT: Final = 40
"""Links that may back a new one."""
_REFINEMENTS: Final = 2
"""Times that all links are looked for anew when the map is finished."""


class SubmapGraph:
    """``submaps`` and their ``poses``, float64 [n, 3], map frame; the newest is the last one.

    ``links`` are the measurements between submaps. The points of a submap are within ``reach``, m,
    of its origin; ``range_deviation``, m, is the standard deviation of a range.
    """

    def __init__(
        self, config: MappingConfig, localization: LocalizationConfig, start: Floats
    ) -> None:
        """Begin with an empty submap at ``start``, float64 [3]."""
        self._config, self._localization = config, localization
        self._linker: Linker | None = None
        self.reach, self.range_deviation = 0.0, 0.0
        self.submaps = [Submap(0.0)]
        self.poses = start[None].copy()
        self.links: list[Link] = []
        self._waiting: list[Link] = []
        self._carried_to: dict[int, bool] = {}
        """Number of each submap that began after the robot was carried -> whether it is to be
        found anywhere in any case, and not only where walls are seen through. Not saved."""
        self.laid = 0
        """Number of parts that :meth:`join_parts` found and laid."""

    def take_over(
        self, submaps: tuple[KeptSubmap, ...], poses: Floats, links: tuple[Link, ...]
    ) -> None:
        """Go on with the submaps, one or more, of a graph that another process had."""
        self.submaps = [Submap(each.way, list(each.keyframes)) for each in submaps]
        for whole in self.submaps[:-1]:
            whole.close(CLOUD)
        self.poses, self.links = poses.copy(), list(links)

    def use_reach(self, reach: float) -> None:
        """Take how far the points of a submap are from its origin at most, m."""
        self.reach = reach
        self._linker = Linker(self._config, reach)
        self._linker.use_noise(self.range_deviation)

    def use_odometry(self, localization: LocalizationConfig) -> None:
        """Go by the noise of other odometry from here on."""
        self._localization = localization

    def use_noise(self, deviation: float) -> None:
        """Go by the standard deviation of a range, m."""
        self.range_deviation = deviation
        if self._linker is not None:
            self._linker.use_noise(deviation)

    @property
    def newest(self) -> Submap:
        """The submap that the robot is in."""
        return self.submaps[-1]

    def placed(self, relative: Floats) -> Floats:
        """Return the pose, [3], map frame, of a pose in the newest submap's frame."""
        placed: Floats = composed(self.poses[-1:], relative[None])[0]
        return placed

    def begin(self, relative: Floats, way: float) -> None:
        """Begin a submap at a pose of the newest one, [3]; ``way`` is what was driven in all, m."""
        information = self._driven(way - self.newest.way)
        count = len(self.submaps)
        self.links.append(Link(count - 1, count, relative.copy(), information, LinkKind.DRIVEN))
        self._add(self.placed(relative), way)

    def begin_piece(
        self,
        relative: Floats,
        way: float,
        unsure_way: float,
        unsure_turn: float,
        *,
        carried: Carried | None = None,
    ) -> None:
        """Begin a submap at a pose of the newest one, [3].

        ``unsure_way``, m, and ``unsure_turn``, rad, were driven before it without a scan to confirm
        them. The submap may lie anywhere if the robot was ``carried``.
        """
        count = len(self.submaps)
        if carried is not None:
            self._carried_to[count] = carried is not Carried.SEEN
        piece = self._config.pieces
        away = piece.deviation + piece.share * unsure_way
        turn = piece.heading_deviation + piece.share * unsure_turn
        information = _information(away, turn)
        self.links.append(Link(count - 1, count, relative.copy(), information, LinkKind.GUESSED))
        self._add(self.placed(relative), way)

    def begin_at(self, pose: Floats, way: float) -> None:
        """Begin a submap at a reported pose, map frame, [3]."""
        parent = int(np.argmin(np.hypot(*(self.poses[:, :2] - pose[:2]).T)))
        relative = relative_to(self.poses[parent : parent + 1], pose[None])[0]
        piece = self._config.pieces
        information = _information(piece.told_deviation, piece.told_heading_deviation)
        self.links.append(Link(parent, len(self.submaps), relative, information, LinkKind.TOLD))
        self._add(pose, way)

    def close(self) -> None:
        """Link the newest submap to all that show the same walls, and optimise all poses."""
        child = len(self.submaps) - 1
        self.newest.close(CLOUD)
        known = len(self.links)
        self.links += self._agreeing(self._links_of(child, self.links), child)
        self.poses = optimised(self.poses, self.links, known)

    def ways_apart(self, way: float) -> list[float]:
        """Return how long the parts are that no scan joined to the first one, m.

        ``way`` is what was driven in all.
        """
        ends = [*(submap.way for submap in self.submaps[1:]), way]
        driven = np.array(ends) - [submap.way for submap in self.submaps]
        shows = np.array([bool(submap.keyframes) for submap in self.submaps])
        labels = part_labels(len(self.submaps), self.links)
        parts = np.unique(labels[shows]).tolist()[1:]
        return [float(driven[labels == part].sum()) for part in parts]

    def heading_drift(self) -> HeadingDrift:
        """Return how unsure the least sure heading of a submap is, against the first one's."""
        return heading_drift(self.poses, [submap.way for submap in self.submaps], self.links)

    def join_parts(self) -> None:
        """Lay the parts that began after the robot was carried where they fit on the rest.

        Other parts stay where dead reckoning puts them, even if they look like another place. So do
        parts before which the robot only seemed to be carried, unless beams contradict their place.
        """
        labels = part_labels(len(self.submaps), self.links)
        for part in sorted(self._carried_to.keys() & set(labels.tolist())):
            if not self._carried_to[part] and not is_contradicted(
                part, labels, self.submaps, self.poses, self._config
            ):
                continue
            found = found_part(part, labels, self.submaps, self.poses, self._config)
            if found is not None:
                self._lay_part(found, hanging_on(part, labels, self.links))
                labels = part_labels(len(self.submaps), self.links)

    def _lay_part(self, found: FoundPart, moved: NDArray[np.bool_]) -> None:
        """Move a part, and all that hangs on it, where it was found, if links confirm that."""
        poses = self.poses.copy()
        there = np.repeat(found.moved[None], int(np.count_nonzero(moved)), axis=0)
        poses[moved] = composed(there, poses[moved])
        links = [
            self._linker.link_at(parent, number, self.submaps, poses)
            for number, parent in found.parents.items()
            if self._linker is not None
        ]
        good = [link for link in links if link is not None]
        if not good:
            return
        # The guessed links to the part hold no more: they become what they are now.
        known = [
            _as_lies(link, poses)
            if link.kind is LinkKind.GUESSED and moved[link.parent] != moved[link.child]
            else link
            for link in self.links
        ]
        self.links = known + good
        self.poses = optimised(poses, self.links)
        self.laid += 1

    def link_anew(self) -> None:
        """Search for all links anew, near where the present links place the submaps."""
        backing = self._config.backing
        for _ in range(_REFINEMENTS):
            known = self.links
            self.links = [link for link in known if not link.may_be_wrong]
            children = range(1, len(self.submaps))
            found = [link for child in children for link in self._links_of(child, known)]
            self.links += [
                link
                for link in found
                if not is_far(link, self.poses, backing)
                or is_backed(link, found, self.poses, backing)
            ]
            self.poses = optimised(self.poses, self.links)

    def lay(self, number: int, poses: Floats) -> None:
        """Place a submap and its keyframes, so that these are at ``poses``, float64 [n, 3], map."""
        submap = self.submaps[number]
        origin = composed(poses[:1], inverse(submap.keyframes[0].pose)[None])
        self.poses[number] = origin[0]
        relative = relative_to(np.repeat(origin, len(poses), axis=0), poses)
        submap.keyframes = [
            replace(frame, pose=pose)
            for frame, pose in zip(submap.keyframes, relative, strict=True)
        ]
        submap.close(CLOUD)
        if self._linker is not None:
            self._linker.forget(number)

    def keyframes(self) -> Iterator[tuple[Keyframe, Floats]]:
        """Go through all keyframes and their poses, [3], map frame, in the order of time."""
        for submap, pose in zip(self.submaps, self.poses, strict=True):
            yield from zip(submap.keyframes, submap.poses(pose), strict=True)

    def driven_ways(self) -> list[list[Floats]]:
        """Return where the robot was, [2], m, map frame, at the keyframes of each way it drove.

        A way ends where the robot was carried, or its place was lost.
        """
        followed = {link.child for link in self.links if link.kind is LinkKind.DRIVEN}
        ways = list[list[Floats]]()
        for number, (submap, pose) in enumerate(zip(self.submaps, self.poses, strict=True)):
            if number not in followed:
                ways.append([])
            ways[-1].extend(place[:2] for place in submap.poses(pose))
        return ways

    def keyframes_beside(self, numbers: list[int]) -> Iterator[tuple[Keyframe, Floats]]:
        """Go through the keyframes of some submaps, with poses, [3], in the newest one's frame."""
        for number in numbers:
            relative = relative_to(self.poses[-1:], self.poses[number : number + 1])[0]
            submap = self.submaps[number]
            yield from zip(submap.keyframes, submap.poses(relative), strict=True)

    def cloud(self) -> Floats:
        """Return points of all submaps, float64 [n, 4], map frame."""
        poses = zip(self.submaps, self.poses, strict=True)
        return np.concatenate([moved(submap.cloud, pose) for submap, pose in poses])

    def newest_keyframe(self) -> tuple[int, Floats]:
        """Return how many keyframes there are, and the pose of the newest, [3], map frame.

        Raises ValueError without one.
        """
        count = sum(len(submap.keyframes) for submap in self.submaps)
        if not count:
            raise ValueError("expected a map with a keyframe or more, got an empty one")
        last = max(index for index, submap in enumerate(self.submaps) if submap.keyframes)
        pose: Floats = self.submaps[last].poses(self.poses[last])[-1]
        return count, pose

    def near(self, pose: Floats) -> list[int]:
        """Return the numbers of the submaps that lie near a pose, [3], map frame."""
        away = np.hypot(*(self.poses[:, :2] - pose[:2]).T)
        found: list[int] = np.flatnonzero(away < self._config.link_radius).tolist()
        return found

    def _add(self, pose: Floats, way: float) -> None:
        self.poses = np.vstack((self.poses, pose))
        self.submaps.append(Submap(way))

    def _links_of(self, child: int, known: list[Link]) -> list[Link]:
        if self._linker is None:
            return []
        return self._linker.links_to(child, child, self.submaps, self.poses, known)

    def _agreeing(self, found: list[Link], child: int) -> list[Link]:
        """Return the new links that need no backing or have it, and older ones that get it now."""
        backing = self._config.backing
        agreeing = [link for link in found if not is_far(link, self.poses, backing)]
        waiting = self._waiting + [link for link in found if is_far(link, self.poses, backing)]
        loops = [link for link in self.links[-_RECENT:] if link.may_be_wrong]
        others = waiting + loops + agreeing
        backed = [is_backed(link, others, self.poses, backing) for link in waiting]
        agreeing += [link for link, yes in zip(waiting, backed, strict=True) if yes]
        self._waiting = [
            link
            for link, yes in zip(waiting, backed, strict=True)
            if not yes and link.child > child - backing.neighbours
        ]
        return agreeing

    def _driven(self, way: float) -> Floats:
        """Return the information of a link along which ``way``, m, was driven."""
        numbers = self._localization
        deviations = np.array([numbers.way_noise, numbers.way_noise, numbers.turn_noise])
        information: Floats = np.diag((deviations * math.sqrt(max(way, 0.1))) ** -2.0)
        return information


def _as_lies(link: Link, poses: Floats) -> Link:
    """Return a link changed to how its submaps lie now."""
    relative = relative_to(poses[link.parent][None], poses[link.child][None])[0]
    return replace(link, relative=relative)


def _information(deviation: float, heading_deviation: float) -> Floats:
    """Return the information matrix of a pose by its standard deviations, m and rad."""
    information: Floats = np.diag([deviation**-2, deviation**-2, heading_deviation**-2])
    return information
