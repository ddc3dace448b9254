"""A clean that a made-up Neato does by itself: what it is about, and the ways that it drives.

A real one maps a home and cleans it in rows. This one bumps and goes, or drives a spiral on the
spot: enough for a program that starts it, looks, and stops it. It does not drive home.
Sources: the programmer's manual (Clean), and OpenNeato's page of the serial protocol (the names
of the states; that Stop pauses first and ends then; 200 mm/s while it cleans).
"""

from __future__ import annotations

import math
from enum import Enum
from typing import Final

from roomba.emulators.neato.drive import WheelDrive
from roomba.world.observation import Observation

_SPEED: Final = 200
"""mm/s."""
_AHEAD: Final = 5000
"""mm of a way ahead, which a touch ends."""
_BACK: Final = -150
"""mm that it backs off."""
_LEAST_TURN: Final = 1.2
"""rad that it turns away from what it touched, at least."""
_MORE_TURN: Final = 1.6
"""rad that it turns more, at most: another part of it each time, so as not to go round for ever."""
_GOLDEN: Final = 0.618
"""Share of ``_MORE_TURN`` by which each turn differs from the one before."""
_FIRST_RADIUS, _LAST_RADIUS = 150.0, 700.0
"""mm, of the spiral's half turns: some 1.4 m wide, and a robot’s width more."""
_WIDER: Final = 60.0
"""mm by which the radius of each half turn grows."""
_LOW: Final = 0.2
"""Level of the battery below which a clean ends."""


class OwnState(Enum):
    """The state of its own clean, as GetState tells it: that of its page, and that of the robot."""

    STANDBY = "UIMGR_STATE_STANDBY", "ST_C_Standby"
    """It cleans nothing."""
    HOUSE = "UIMGR_STATE_HOUSECLEANINGRUNNING", "ST_F_Cleaning"
    """It cleans all."""
    HOUSE_PAUSED = "UIMGR_STATE_HOUSECLEANINGPAUSED", "ST_C_Standby"
    """It would clean all, and stands."""
    SPOT = "UIMGR_STATE_SPOTCLEANINGRUNNING", "ST_G_SpotCleaning"
    """It cleans where it was put."""
    SPOT_PAUSED = "UIMGR_STATE_SPOTCLEANINGPAUSED", "ST_C_Standby"
    """It would clean there, and stands."""

    @property
    def is_running(self) -> bool:
        """Whether it drives and sweeps."""
        return self in _PAUSES


_PAUSES: Final = {OwnState.HOUSE: OwnState.HOUSE_PAUSED, OwnState.SPOT: OwnState.SPOT_PAUSED}
_RESUMED: Final = {paused: running for running, paused in _PAUSES.items()}


class OwnCleaning:
    """Starts, pauses, ends a clean, and steers its ``drive``. ``seconds`` counts how long it ran.

    Wheels that drop pause it, as a hand that lifts the robot does.
    """

    def __init__(self, drive: WheelDrive) -> None:
        """Clean nothing yet."""
        self._drive = drive
        self.phase = OwnState.STANDBY
        self.seconds = 0.0
        self._is_backing = False
        self._turn_due = 0.0
        self._touches = 0
        self._radius = _FIRST_RADIUS

    def press_start(self) -> None:
        """Clean all, or go on with what is paused: a press of the button."""
        if self.phase is OwnState.STANDBY:
            self.clean_house()
        elif not self.phase.is_running:
            self._run(_RESUMED[self.phase])

    def clean_house(self) -> None:
        """Clean all, from the beginning."""
        self._begin_anew()
        self._run(OwnState.HOUSE)

    def clean_spot(self) -> None:
        """Clean a spot here, or go on with one that is paused."""
        if self.phase is not OwnState.SPOT_PAUSED:
            self._begin_anew()
        self._run(OwnState.SPOT)

    def pause(self) -> None:
        """Stand, and keep what is under way."""
        self._stand(_PAUSES.get(self.phase, self.phase))

    def stop(self) -> None:
        """Pause a clean; end one that is paused already."""
        self._stand(_PAUSES.get(self.phase, OwnState.STANDBY))

    def end(self) -> None:
        """Clean nothing more."""
        self._stand(OwnState.STANDBY)

    def steer(self, seen: Observation, seconds: float) -> None:
        """Let the drive go on its way for ``seconds``, by what is ``seen``."""
        if not self.phase.is_running:
            return
        self.seconds += seconds
        if seen.wheels.dropped:
            self.stop()
        elif seen.battery.level < _LOW:
            self.end()
        elif (seen.bumper.pressed or seen.cliff.any) and not self._is_backing:
            self._back_off(seen)
        elif self._drive.is_idle:
            self._go_on()

    def _run(self, phase: OwnState) -> None:
        self.phase, self._drive.is_enabled = phase, True

    def _begin_anew(self) -> None:
        self._stand(OwnState.STANDBY)
        self._radius, self._turn_due, self._is_backing = _FIRST_RADIUS, 0.0, False

    def _stand(self, phase: OwnState) -> None:
        if self.phase.is_running:
            self._drive.halt()
        self.phase = phase

    def _back_off(self, seen: Observation) -> None:
        self._touches += 1
        away = 1.0 if seen.bumper.right or seen.cliff.right or seen.cliff.front_right else -1.0
        more = math.fmod(_GOLDEN * self._touches, 1.0) * _MORE_TURN
        self._turn_due = away * (_LEAST_TURN + more)
        self._is_backing = True
        self._drive.halt()
        self._drive.go(_BACK, _BACK, _SPEED, None)

    def _go_on(self) -> None:
        self._is_backing = False
        if self._turn_due:
            way = round(500.0 * self._drive.track * self._turn_due)
            self._turn_due = 0.0
            self._drive.go(-way, way, _SPEED, None)
        elif self.phase is OwnState.HOUSE:
            self._drive.go(_AHEAD, _AHEAD, _SPEED, None)
        elif self._radius < _LAST_RADIUS:
            half = 500.0 * self._drive.track
            inner, outer = (math.pi * (self._radius + side) for side in (-half, half))
            self._radius += _WIDER
            self._drive.go(round(inner), round(outer), _SPEED, None)
        else:
            self.end()
