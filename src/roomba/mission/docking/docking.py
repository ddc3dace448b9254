"""Docking: driving into the charging station by its beams, until current comes.

No clock and no I/O: it is ticked with what the robot senses and answers with what it wants.
"""

from __future__ import annotations

from typing import Final

from roomba.clock import RobotTime
from roomba.configuration.body import BodyConfig
from roomba.configuration.docking import DockingConfig
from roomba.configuration.sensors import StationConfig
from roomba.geometry import STANDSTILL, Pose, Twist, wrap_angle
from roomba.mission.docking.search import BeamSearch, drive_to, is_at_staging, steered
from roomba.mission.docking.step import DockSenses, DockState, DockStep, Trouble
from roomba.mission.docking.track import StationTrack

__all__ = ["DockSenses", "DockState", "DockStep", "Docking", "Trouble", "staging_pose"]

_DOCKED_BLIND: Final = "docked without its beams: wipe the robot's infrared receiver"


def staging_pose(station: Pose, distance: float) -> Pose:
    """Return the pose, map frame, that path planning should bring the robot to before it docks.

    It is ``distance`` m before the station, and faces it.
    """
    return station.compose(Pose(-distance, 0.0, 0.0))


class Docking:
    """One docking at ``station``; it ends docked or failed, at the latest at the time limit."""

    def __init__(
        self,
        config: DockingConfig,
        body: BodyConfig,
        beams: StationConfig,
        station: Pose,
        senses: DockSenses,
    ) -> None:
        """Begin; ``station`` is where the docked robot stands, its nose to the station, map frame.

        Raises ValueError for a pose that is not finite.
        """
        if not station.is_finite:
            raise ValueError(f"expected a finite pose of the station, got {station}")
        self._config = config
        self._track = StationTrack(body, beams, config, station)
        self._has_beams = beams.has_beams
        self._time = RobotTime(senses.now)
        self._state = DockState.SEARCHING
        self._trouble: Trouble | None = None
        self._reason = ""
        self._attempts = 0
        self._search: BeamSearch | None = None
        self._is_blind = False
        self._lines_up = False
        self._arrived: float | None = None
        self._wanted = STANDSTILL
        self._dt = 0.0
        # When something was so for the last time, s since the beginning.
        self._entered = self._led = self._known = self._moved = self._no_current = 0.0
        self._entered_at = self._moved_at = Pose()
        self._is_first = True

    def tick(self, senses: DockSenses) -> DockStep:
        """Return what is wanted now."""
        wanted = STANDSTILL
        if self._state not in (DockState.DOCKED, DockState.FAILED):
            self._follow(senses)
            self._notice(senses)
            wanted = self._act(senses)
        self._wanted = wanted
        return DockStep(self._state, wanted, self._reason, self._attempts, self._trouble)

    def _follow(self, senses: DockSenses) -> None:
        """Follow time, place and beams."""
        self._dt = self._time.tick(senses.now)
        is_known = senses.is_known and senses.pose.is_finite
        self._track.move(senses.pose if is_known else None, self._wanted, self._dt)
        self._track.see(senses.beams)
        now = self._time.elapsed
        if self._is_led(senses):
            self._led = now
        if is_known:
            self._known = now
        if not senses.is_charging:
            self._no_current = now
        self._follow_motion(is_known)

    def _is_led(self, senses: DockSenses) -> bool:
        """Whether the robot sees the station's beams, or must go by its pose as there are none."""
        return senses.beams.leads or not self._has_beams

    def _follow_motion(self, is_known: bool) -> None:
        pose, before, config = self._track.pose, self._moved_at, self._config
        moved = pose.distance_to(before.x, before.y) > config.standstill_way
        moved |= abs(wrap_angle(pose.theta - before.theta)) > config.standstill_turn
        if moved or not is_known:
            self._moved, self._moved_at = self._time.elapsed, pose

    @property
    def _is_stuck(self) -> bool:
        return self._time.elapsed - self._moved > self._config.stuck_timeout

    def _notice(self, senses: DockSenses) -> None:
        """Notice what changes everything, in any phase."""
        is_first, self._is_first = self._is_first, False
        if senses.is_charging:
            if is_first:
                self._dock()
            elif self._state is not DockState.TOUCHING:
                self._enter(DockState.TOUCHING)
        elif self._time.elapsed > self._config.time_limit:
            because = f": {self._trouble.value}" if self._trouble else ""
            self._fail(Trouble.TIMEOUT, because)
        elif self._track.is_known and self._track.away > self._config.farthest:
            self._fail(Trouble.FAR, f" ({self._track.away:.1f} m)")

    def _act(self, senses: DockSenses) -> Twist:
        match self._state:
            case DockState.SEARCHING:
                return self._look_for_beams(senses)
            case DockState.APPROACHING:
                return self._approach(senses)
            case DockState.TOUCHING:
                return self._wait_for_current(senses)
            case DockState.BACKING_OFF:
                return self._back_off(senses)
            case DockState.WAITING:
                return self._wait_for_free_way()
            case _:
                return STANDSTILL

    def _look_for_beams(self, senses: DockSenses) -> Twist:
        if not self._track.is_known or not (senses.is_known or senses.beams.leads):
            if self._time.elapsed - self._known > self._config.lost_timeout:
                self._fail(Trouble.LOST)
            return STANDSTILL
        if self._is_led(senses):
            return self._begin_attempt(is_blind=False)
        if self._search is None:
            self._search = BeamSearch(self._config)
        if senses.bumper or senses.cliff:
            return self._give_up_attempt(None)
        if self._is_stuck:
            self._search.skip()
            self._moved = self._time.elapsed
        wanted = self._search.tick(self._track, self._dt)
        return self._begin_attempt(is_blind=True) if wanted is None else wanted

    def _begin_attempt(self, *, is_blind: bool) -> Twist:
        """Begin to drive at the station.

        A blind attempt goes by the believed pose alone, and only finds out what is wrong.
        """
        config = self._config
        if self._attempts >= config.max_attempts:
            self._fail(self._trouble or Trouble.BEAMS_LOST)
            return STANDSTILL
        self._attempts += 1
        self._search = self._arrived = None
        self._is_blind = is_blind
        if is_blind:
            self._track.forget_beams()
        left, aside = self._track.left, abs(self._track.pose.y)
        shortest = config.shortest_way
        self._lines_up = left < shortest or aside > config.narrow * left
        self._led = self._time.elapsed
        if abs(left) < shortest and aside < shortest and self._looks_at_station:
            return self._give_up_attempt(None)
        self._enter(DockState.APPROACHING)
        return STANDSTILL

    @property
    def _looks_at_station(self) -> bool:
        return abs(self._track.pose.theta) < self._config.most_aside

    def _approach(self, senses: DockSenses) -> Twist:
        config, track = self._config, self._track
        if senses.cliff:
            return self._give_up_attempt(Trouble.CLIFF)
        if senses.bumper:
            if track.left > config.contact_margin or self._lines_up:
                return self._give_up_attempt(Trouble.HIDDEN if self._is_blind else Trouble.BLOCKED)
            self._enter(DockState.TOUCHING)
            return STANDSTILL
        if self._is_stuck:
            return self._give_up_attempt(Trouble.STUCK)
        if self._lines_up:
            if not is_at_staging(track, config):
                return drive_to(track, config, -config.staging_distance, 0.0)
            self._lines_up, self._led = False, self._time.elapsed
        if senses.beams.leads:
            self._is_blind = False
        elif not self._is_blind and self._time.elapsed - self._led > config.beam_wait:
            self._trouble = Trouble.BEAMS_LOST
            self._enter(DockState.SEARCHING)
            return STANDSTILL
        if track.left < -config.overrun:
            return self._give_up_attempt(
                Trouble.NOT_THERE if self._is_blind else Trouble.NO_CONTACT
            )
        return STANDSTILL if self._awaits_current() else self._drive_at_station()

    def _awaits_current(self) -> bool:
        """Whether the robot waits where it should be docked, since current may be told late.

        Without the wait, on a slow line, it would be past the contacts by the time that current is
        told, and press against the station.
        """
        now = self._time.elapsed
        if self._arrived is None and self._track.left <= 0.0:
            self._arrived = now
        if self._arrived is None or now - self._arrived >= self._config.contact_wait:
            return False
        self._moved = now  # it stands of its own will
        return True

    def _drive_at_station(self) -> Twist:
        config, left = self._config, max(self._track.left, 0.0)
        speed = config.creep_speed + config.braking * (left - config.creep_distance)
        speed = min(max(speed, config.creep_speed), config.speed)
        if self._arrived is not None:
            speed = config.feeling_speed
        reach = max(config.shortest_reach, 0.6 * left)
        aside = min(config.most_aside, config.least_aside + 1.2 * left)
        wrong = self._track.steering(reach, aside)
        return steered(config, speed, wrong)

    def _wait_for_current(self, senses: DockSenses) -> Twist:
        now, config = self._time.elapsed, self._config
        if senses.is_charging:
            if now - self._no_current >= config.settle_time:
                self._dock()
        elif now - self._entered > config.contact_wait:
            return self._give_up_attempt(Trouble.NO_POWER if self._is_blind else Trouble.NO_CURRENT)
        return STANDSTILL

    def _dock(self) -> None:
        self._reason = _DOCKED_BLIND if self._is_blind else ""
        self._enter(DockState.DOCKED)

    def _give_up_attempt(self, trouble: Trouble | None) -> Twist:
        self._trouble = trouble
        self._enter(DockState.BACKING_OFF)
        return STANDSTILL

    def _back_off(self, senses: DockSenses) -> Twist:
        config, search = self._config, self._search
        gone = self._track.pose.distance_to(self._entered_at.x, self._entered_at.y)
        if gone < (config.side_step if search else config.back_distance) and not self._is_stuck:
            is_near = self._trouble in (Trouble.NO_CURRENT, Trouble.NO_POWER)
            if is_near and gone < config.nudge:
                return Twist(-config.creep_speed, 0.0)
            side = 1.0 if self._attempts % 2 else -1.0
            turning = side * config.back_turn / config.back_distance
            return Twist(-config.speed, turning * config.speed)
        if senses.bumper or senses.cliff:
            self._fail(Trouble.CLIFF if senses.cliff else Trouble.BUMPER_STUCK)
        elif search:
            search.skip()
            self._enter(DockState.SEARCHING)
        elif self._is_blind or self._attempts >= config.max_attempts:
            self._fail(self._trouble or Trouble.STUCK)
        elif self._trouble is Trouble.BLOCKED:
            self._enter(DockState.WAITING)
        else:
            self._enter(DockState.SEARCHING)
        return STANDSTILL

    def _wait_for_free_way(self) -> Twist:
        if self._time.elapsed - self._entered > self._config.blocked_wait:
            self._enter(DockState.SEARCHING)
        return STANDSTILL

    def _enter(self, state: DockState) -> None:
        self._state = state
        self._entered = self._moved = self._time.elapsed
        self._entered_at = self._moved_at = self._track.pose

    def _fail(self, trouble: Trouble, more: str = "") -> None:
        self._trouble = trouble
        tries = f" ({self._attempts} attempts)" if self._attempts > 1 else ""
        self._reason = f"{trouble.value}{more}{tries}"
        self._enter(DockState.FAILED)
