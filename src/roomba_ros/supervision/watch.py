"""Decides about one process: when it is restarted, ended, or given up."""

from __future__ import annotations

import math

from roomba.configuration.nodes import SupervisionConfig


class Watch:
    """Follows one process. All times are s of wall time."""

    def __init__(self, name: str, config: SupervisionConfig) -> None:
        """Begin with a process that is to be started."""
        self.name, self._config = name, config
        self._start_at = -math.inf
        self._beaten = math.inf
        self.up_since = math.inf
        """When its first sign of life came; infinite while the process does not work."""
        self._stopped_since: float | None = None
        self.started_at, self._short_lives = -math.inf, 0
        self._last_end = ""
        self.is_running = False
        self.is_given_up = False

    def started(self, now: float) -> None:
        """Note that the process was started; its first sign of life may take long."""
        self.is_running, self._beaten, self._stopped_since = True, math.inf, None
        self.started_at = now

    def beat(self, now: float) -> None:
        """Note a sign of life."""
        self._beaten, self.up_since = now, min(self.up_since, now)

    def has_no_heart(self) -> None:
        """Note that no signs of life will come: it ends, or is a program of another package."""
        self._beaten, self._last_end = math.inf, ""

    def seen(self, now: float, *, is_stopped: bool) -> None:
        """Note whether it is stopped by a signal or a debugger."""
        if not is_stopped:
            self._stopped_since = None
        elif self._stopped_since is None:
            self._stopped_since = now

    def ended(self, now: float, how: str, *, counts: bool = True) -> None:
        """Note that the process ended, and how; it is restarted soon, or given up.

        It is given up after several short lives in a row. One that does not ``counts`` is left out.
        """
        config = self._config
        self.is_running, self._stopped_since, self._last_end = False, None, how
        self.up_since = math.inf
        if now - self.started_at >= config.short_life:
            self._short_lives = 0
        elif counts:
            self._short_lives += 1
        self.is_given_up = self._short_lives >= config.most_short_lives
        self._start_at = now + config.back_after

    def wants_start(self, now: float) -> bool:
        """Whether to start the process now."""
        return not self.is_running and not self.is_given_up and now >= self._start_at

    def wants_end(self, now: float) -> bool:
        """Whether to end the process now, because it hangs or is stopped."""
        return self.is_running and (
            self._stopped_for(now) > self._config.stopped or self._silence(now) > self._config.hung
        )

    def trouble(self, now: float) -> str:
        """Return what is wrong and what is done about it, in words; empty when all is well."""
        if self.is_given_up:
            return (
                f"{self.name} keeps ending ({self._last_end}) and is not started any more: see its "
                "log, and start the robot anew"
            )
        if not self.is_running:
            return f"{self.name} {self._last_end}; it is started anew" if self._last_end else ""
        if self._stopped_since is not None:
            return f"{self.name} is stopped; if it stays so, it is started anew"
        if self._silence(now) > self._config.busy:
            return f"{self.name} has not answered for {round(self._silence(now))} s"
        if math.isinf(self._beaten) and self._last_end:
            return f"{self.name} {self._last_end}; it is starting"
        return ""

    def _stopped_for(self, now: float) -> float:
        return 0.0 if self._stopped_since is None else now - self._stopped_since

    def _silence(self, now: float) -> float:
        return now - self._beaten
