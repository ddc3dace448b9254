"""Many robots at once: any number of worlds, each with its own dirt and one or more robots.

The robots of one world see and bump each other; worlds know nothing of each other, so threads
share them out. A robot's trace is the same, bit for bit, alone and among a thousand.
"""

from __future__ import annotations

import hashlib
import itertools
import math
import os
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.errors import HomeError
from roomba.geometry import Pose
from roomba.world.engine.contact_kernels import gap_at
from roomba.world.engine.layout import layout_of
from roomba.world.engine.lidar.projection import ScanBuffers, buffers_for
from roomba.world.engine.populate import first_state, starts_of
from roomba.world.engine.state.arrays import MOST_DISCS, RENEWED, Fault, Rows, Solid, State
from roomba.world.engine.state.numbers import numbers_of
from roomba.world.engine.state.random_kernels import normal_quantiles
from roomba.world.engine.step_kernels import advance
from roomba.world.home.dirt import DirtField
from roomba.world.home.home import Home
from roomba.world.workers import Workers

_CHUNKS_PER_THREAD = 4
"""Parts of the worlds for each thread: several, since some take longer than others."""
_WORTH_A_THREAD = 32
"""World-steps from which on threads pay."""


class Fleet:
    """Worlds with their robots; :meth:`step` is the only thing that lets time pass.

    Robots are numbered world by world. ``robots``, ``poses`` and ``ranges`` are views of the
    fleet's own memory, which changes: copy what is to be kept.
    """

    def __init__(
        self,
        homes: Sequence[Home],
        config: SimulatedRobotConfig | None = None,
        *,
        robots_per_home: int = 1,
        seeds: Sequence[int] | None = None,
        max_speed: float = 0.5,
        starts: NDArray[np.float64] | None = None,
        threads: int | None = None,
    ) -> None:
        """Make a world of each home, and put its robots in.

        ``seeds`` has one for each world (default 0, 1, ...). ``starts`` is float64 [robots, 3]:
        x, y, theta, map frame; by default the first robot of a world stands at the station, others
        at free places found by the seed. ``threads``: at most so many work (default: all cores).
        A home that was turned is taken in its own axes, and so are all places in it.
        Raises HomeError where a body does not fit, ValueError for other numbers that make no sense.
        """
        homes = [home.exact for home in homes]
        _check_counts(homes, robots_per_home, seeds, threads)
        _check_speed(max_speed)
        self.config = config or SimulatedRobotConfig()
        self.homes = tuple(homes)
        self.threads = threads or os.cpu_count() or 1
        self.seeds = tuple(seeds) if seeds is not None else tuple(range(len(homes)))
        self._distinct = list({id(home): home for home in homes}.values())
        self._layout = layout_of(self._distinct, self.config)
        self._max_speed = max_speed
        number_of = {id(home): number for number, home in enumerate(self._distinct)}
        self._numbers, self._quantiles = numbers_of(self.config), normal_quantiles()
        self._state = first_state(
            self._layout,
            self._distinct,
            [number_of[id(home)] for home in homes],
            self.config,
            self.seeds,
            robots_per_home,
            max_speed,
        )
        self._buffers: list[ScanBuffers] = []
        self._workers = Workers(self.threads)
        self._place(starts, robots_per_home)

    @property
    def robots(self) -> Rows:
        """All numbers of the robots: ROBOT of :mod:`roomba.world.engine.state.arrays`."""
        return self._state.solid.robots

    @property
    def worlds(self) -> Rows:
        """All numbers of the worlds: WORLD of :mod:`roomba.world.engine.state.arrays`."""
        return self._state.worlds

    @property
    def poses(self) -> NDArray[np.float64]:
        """True poses, float64 [robots, 3]: x, y (m), theta (rad), map frame; a view."""
        return self.robots.view(np.float64).reshape(len(self.robots), -1)[:, :3]

    @property
    def ranges(self) -> NDArray[np.float32]:
        """The lidars' last scans, float32 [robots, beams], m: see :class:`roomba.world.lidar`."""
        return self._state.ranges

    @property
    def bytes_per_robot(self) -> float:
        """Memory that grows with the robots and their worlds, bytes for each robot."""
        return sum(part.nbytes for part in self._changing.values()) / len(self.robots)

    def step(self, twists: NDArray[np.float64], dt: float, steps: int = 1) -> None:
        """Let ``steps`` times ``dt`` s pass while the drives are asked for ``twists``.

        ``twists`` is float64 [robots, 2]: m/s and rad/s. Raises ValueError for twists or a time
        that are not finite or of another shape, a time not above 0, or no step.
        """
        wanted = np.asarray(twists, np.float64)
        expected = (len(self.robots), 2)
        if wanted.shape != expected or not np.isfinite(wanted).all():
            raise ValueError(
                f"expected finite twists of shape {expected}, got shape {wanted.shape} or numbers "
                "that are not finite"
            )
        if not math.isfinite(dt) or dt <= 0.0 or steps < 1:
            raise ValueError(f"expected dt > 0 s and 1 step or more, got dt={dt}, steps={steps}")
        self.robots["wanted_linear"], self.robots["wanted_angular"] = wanted.T
        self._advance(dt, steps)

    def reset_world(self, world: int, seed: int) -> None:
        """Let a world begin anew, as a world of this seed begins in a new fleet without ``starts``.

        Raises ValueError for a negative seed.
        """
        if seed < 0:
            raise ValueError(f"expected a seed of 0 or more, got {seed}")
        state, row, home = self._state, self.worlds[world], self.homes[world]
        robots = slice(row["robots_at"], row["robots_end"])
        things = slice(row["things_at"], row["things_end"])
        count = int(row["robots_end"] - row["robots_at"])
        starts = starts_of([home], [seed], count, self.config.body)
        fresh = first_state(
            self._layout,
            self._distinct,
            [int(row["home"])],
            self.config,
            [seed],
            count,
            self._max_speed,
        )
        for name in RENEWED:
            row[name] = fresh.worlds[name][0]
        row["discs_end"] = row["discs_at"]
        state.solid.discs[row["discs_at"] : row["discs_at"] + MOST_DISCS] = fresh.solid.discs
        state.dirt.micrograms[row["dirt_at"] : row["dirt_end"]] = fresh.dirt.micrograms
        state.dirt.falls[row["falls_at"] : row["falls_end"]] = fresh.dirt.falls
        state.solid.robots[robots], state.ranges[robots] = fresh.solid.robots, fresh.ranges
        state.made[robots], state.underway[robots] = fresh.made, fresh.underway
        # The seed shifts the times of tracks, but tracks have the same length with every seed.
        tracks_at = state.solid.things["last_row"][things.start - 1] + 1 if things.start else 0
        state.tracks[tracks_at : tracks_at + len(fresh.tracks)] = fresh.tracks
        state.solid.things[things] = fresh.solid.things
        for name in ("row", "last_row"):
            state.solid.things[name][things] += tracks_at
        self.poses[robots] = starts
        self.seeds = (*self.seeds[:world], seed, *self.seeds[world + 1 :])

    def dirt(self, world: int) -> DirtField:
        """Return the dirt of a world as it lies now: a view, not a copy."""
        row = self.worlds[world]
        cells = self._state.dirt.micrograms[row["dirt_at"] : row["dirt_end"]]
        return DirtField.of(self.homes[world], cells)

    def things(self, world: int) -> NDArray[np.float64]:
        """Return where a world's moving things are, float64 [things, 4]: x, y, theta, present."""
        row = self.worlds[world]
        things = self._state.solid.things[row["things_at"] : row["things_end"]]
        return np.stack([things[name] for name in ("x", "y", "theta", "present")], axis=1)

    def discs(self, world: int) -> NDArray[np.float64]:
        """Return round things that were put into a world, float64 [discs, 3]: x, y, radius, m."""
        row = self.worlds[world]
        discs = self._state.solid.discs[row["discs_at"] : row["discs_end"]]
        return np.stack([discs[name] for name in ("x", "y", "radius")], axis=1)

    def keep_thing(self, world: int, thing: int, *, is_present: bool) -> None:
        """Let a moving thing stay where it is for the rest of the day, present or not.

        It becomes present as soon as no robot is in its way.
        """
        row = self._state.solid.things[self.worlds[world]["things_at"] + thing]
        rest = self._state.tracks[row["row"] : row["last_row"] + 1]
        rest[:, 1:] = row["x"], row["y"], row["theta"], float(is_present)

    def put_discs(self, world: int, discs: NDArray[np.float64]) -> None:
        """Stand round things on the floor of a world: float64 [discs, 3], x, y and radius, m.

        Raises ValueError, and puts none of them, where a robot stands, for numbers that make no
        sense, and for more than MOST_DISCS things in all.
        """
        if not np.isfinite(discs).all() or (discs[:, 2] <= 0.0).any():
            raise ValueError(f"expected places and radii above 0 m, got {discs.tolist()}")
        row = self.worlds[world]
        for robot_x, robot_y, _ in self.poses[row["robots_at"] : row["robots_end"]].tolist():
            away = np.hypot(discs[:, 0] - robot_x, discs[:, 1] - robot_y)
            if (away < discs[:, 2] + self.config.body.radius).any():
                raise ValueError(
                    f"the robot itself stands at ({robot_x:.2f}, {robot_y:.2f}); choose another "
                    "place"
                )
        first, last = int(row["discs_end"]), int(row["discs_end"]) + len(discs)
        if last - row["discs_at"] > MOST_DISCS:
            raise ValueError(f"expected at most {MOST_DISCS} things; remove some")
        for column, name in enumerate(("x", "y", "radius")):
            self._state.solid.discs[name][first:last] = discs[:, column]
        row["discs_end"] = last

    def remove_discs(self, world: int) -> None:
        """Take all round things out of a world."""
        self.worlds["discs_end"][world] = self.worlds["discs_at"][world]

    def gap(self, robot: int) -> float:
        """Return how far a robot's rim is from the nearest solid thing, m, up to one radius."""
        radius = self.config.body.radius
        x, y, _ = self.poses[robot].tolist()
        number = int(np.searchsorted(self.worlds["robots_at"], robot, "right")) - 1
        # The compiled step's own function, run as the plain Python that it is.
        solid = Solid(*(rows.view(np.recarray) for rows in self._state.solid))
        world = self._state.worlds.view(np.recarray)[number]
        home = self._state.homes.view(np.recarray)[world.home]
        return float(gap_at(solid, home, world, robot, radius, x, y, radius))

    def save(self) -> dict[str, NDArray[np.generic]]:
        """Return a copy of all that can change, by name: restored, all goes on as it would have."""
        return {name: values.copy() for name, values in self._changing.items()}

    def restore(self, saved: Mapping[str, NDArray[np.generic]]) -> None:
        """Bring back what :meth:`save` returned; raises ValueError if it is not of such a fleet."""
        for name, values in self._changing.items():
            came = saved[name] if name in saved else np.zeros(0)
            if came.shape != values.shape or came.dtype != values.dtype:
                raise ValueError(
                    f"expected {name} to be {values.dtype} {values.shape}, got {came.dtype} "
                    f"{came.shape}; restore it into a fleet of the same homes"
                )
        for name, values in self._changing.items():
            values[...] = saved[name]

    def digest(self) -> str:
        """Return a SHA-256 over everything that can change, hexadecimal."""
        hashed = hashlib.sha256()
        for name, values in self._changing.items():
            hashed.update(name.encode())
            hashed.update(values.tobytes())
        return hashed.hexdigest()

    @property
    def compiled(self) -> tuple[State, Rows, NDArray[np.float32], ScanBuffers]:
        """The state, numbers, quantiles and buffers that the compiled step takes, of one thread."""
        self._make_buffers(1)
        return self._state, self._numbers, self._quantiles, self._buffers[0]

    def close(self) -> None:
        """End the threads, if there are any; the fleet may still be used."""
        self._workers.close()

    def inject(self, robot: int, fault: Fault, value: float) -> None:
        """Set a fault of a robot; raises ValueError for a value that is not of 0..1."""
        if not 0.0 <= value <= 1.0:
            raise ValueError(f"{fault.name.lower()}: expected a value from 0 to 1, got {value}")
        self.robots[fault.value][robot] = value

    def limit_speed(self, speed: float) -> None:
        """Set what all drives do at most, m/s; raises ValueError if it is not above 0."""
        _check_speed(speed)
        self._max_speed = speed
        self.robots["max_speed"] = speed

    def put(self, robot: int, pose: Pose) -> None:
        """Put a robot down somewhere else, standing; raises HomeError where it does not fit.

        Its odometry stays as it was.
        """
        before = self.robots[robot].copy()
        row = self.robots[robot]
        row["x"], row["y"], row["theta"] = pose.x, pose.y, pose.theta
        for name in ("linear", "angular", "hit", "ground_linear", "ground_angular"):
            row[name] = 0.0
        is_finite = all(map(math.isfinite, (pose.x, pose.y, pose.theta)))
        if not is_finite or self.gap(robot) < 0.0:
            self.robots[robot] = before
            raise HomeError(
                f"the robot does not fit at ({pose.x:.2f}, {pose.y:.2f}); expected free floor for "
                f"a body of {self.config.body.diameter} m"
            )

    @property
    def _changing(self) -> dict[str, NDArray[np.generic]]:
        state = self._state
        return {
            "worlds": state.worlds,
            "robots": state.solid.robots,
            "things": state.solid.things,
            "discs": state.solid.discs,
            "dirt": state.dirt.micrograms,
            "falls": state.dirt.falls,
            "tracks": state.tracks,
            "ranges": state.ranges,
            "made": state.made,
            "underway": state.underway,
        }

    def _place(self, starts: NDArray[np.float64] | None, robots_per_home: int) -> None:
        if starts is None:
            starts = starts_of(self.homes, self.seeds, robots_per_home, self.config.body)
        if starts.shape != (len(self.robots), 3) or not np.isfinite(starts).all():
            raise ValueError(
                f"expected finite starts of shape {(len(self.robots), 3)}, got {starts.shape}"
            )
        self.poses[:] = starts
        for robot, (x, y, _) in enumerate(starts.tolist()):
            home = self.homes[robot // robots_per_home]
            if self.gap(robot) < 0.0:
                raise HomeError(
                    f"home {home.name}: the robot does not fit at ({x:.2f}, {y:.2f}); expected "
                    f"free floor for a body of {self.config.body.diameter} m; its station is at "
                    f"({home.station.x:.2f}, {home.station.y:.2f})"
                )

    def _advance(self, dt: float, steps: int) -> None:
        count = len(self.homes)
        threads = min(self.threads, count, max(1, count * steps // _WORTH_A_THREAD))
        self._make_buffers(threads)
        if threads == 1:
            self._work(0, count, self._buffers[0], dt, steps)
            return
        chunks = np.linspace(0, count, threads * _CHUNKS_PER_THREAD + 1).astype(int).tolist()
        waiting = list(itertools.pairwise(chunks))

        def work(buffers: ScanBuffers) -> None:
            while waiting:
                try:
                    first, last = waiting.pop()
                except IndexError:
                    return
                self._work(first, last, buffers, dt, steps)

        self._workers.run(work, self._buffers[:threads])

    def _work(self, first: int, last: int, buffers: ScanBuffers, dt: float, steps: int) -> None:
        advance(self._state, first, last, self._numbers, self._quantiles, buffers, dt, steps)

    def _make_buffers(self, threads: int) -> None:
        while len(self._buffers) < threads:
            self._buffers.append(buffers_for(self._state.edges, self.ranges.shape[1]))


def _check_counts(
    homes: Sequence[Home], robots_per_home: int, seeds: Sequence[int] | None, threads: int | None
) -> None:
    if not homes or robots_per_home < 1:
        raise ValueError(
            f"expected a home or more, with a robot or more each, got {len(homes)} homes with "
            f"{robots_per_home}"
        )
    if seeds is not None and (len(seeds) != len(homes) or min(seeds) < 0):
        raise ValueError(
            f"expected a seed of 0 or more for each of {len(homes)} worlds, got {list(seeds)[:8]}"
        )
    if threads is not None and threads < 1:
        raise ValueError(f"expected 1 thread or more, got {threads}")


def _check_speed(speed: float) -> None:
    if not math.isfinite(speed) or speed <= 0.0:
        raise ValueError(f"max_speed: expected a speed above 0 m/s, got {speed}")
