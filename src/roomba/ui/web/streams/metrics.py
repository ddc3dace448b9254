"""Metrics of a robot for Prometheus, at ``/metrics`` of the page's server."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

from fastapi import APIRouter, HTTPException, Response

from roomba.client.events import RobotEvent
from roomba.client.observed import ObservedRobot, TickTimes, Timed
from roomba.client.view import RobotView

if TYPE_CHECKING:
    from prometheus_client.metrics_core import Metric

STATES: Final = ("cleaning", "docked", "paused", "idle", "returning", "error")
_SUMS: Final = (
    ("roomba_cleaned_square_metres", "Floor that was cleaned in runs that ended", "covered"),
    ("roomba_dirt_grams", "Dirt that was picked up in runs that ended", "dirt"),
    ("roomba_driven_metres", "Way that was driven in runs that ended", "distance"),
    ("roomba_run_seconds", "Time that runs took that ended", "duration"),
)
_MISSING: Final = (
    "expected prometheus_client, which is optional; to mend it: pip install "
    "'roomba_robot[smart-home]'"
)


class RobotMetrics:
    """The newest state and what was counted since the server began; a collector of Prometheus.

    Metrics are collected in the thread of a request, and looks come in the server's own thread:
    each look is one assignment, so no lock is needed.
    """

    def __init__(self, robot: ObservedRobot) -> None:
        """Begin before the first look."""
        self._timed = robot if isinstance(robot, Timed) else None
        self._view: RobotView | None = None
        self._runs: Counter[str] = Counter()
        self._sums = {key: 0.0 for _, _, key in _SUMS}
        self._troubles = 0

    def look(self, view: RobotView | None, events: Iterable[RobotEvent]) -> None:
        """Take what a look saw, None for a silent robot, and the events that it found."""
        self._view = view
        for event in events:
            if event.kind == "ended":
                self._runs[event.values["outcome"]] += 1
                for _, _, key in _SUMS:
                    self._sums[key] += event.values[key] or 0.0
            elif event.kind == "trouble" and event.values["message"]:
                self._troubles += 1

    def collect(self) -> Iterator[Metric]:
        """Yield all metrics; Prometheus prescribes the method's name."""
        from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily

        view = self._view
        yield GaugeMetricFamily("roomba_up", "1 while the robot answers", float(view is not None))
        if view is not None:
            for name, text, value in _gauges(view):
                if math.isfinite(value):
                    yield GaugeMetricFamily(name, text, value)
            state = GaugeMetricFamily("roomba_state", "1 for the present state", labels=["state"])
            for known in STATES:
                state.add_metric([known], float(view.vacuum.state == known))
            yield state
        runs = CounterMetricFamily("roomba_runs", "Runs that ended", labels=["outcome"])
        for outcome, count in sorted(self._runs.items()):
            runs.add_metric([outcome], count)
        yield runs
        for name, text, key in _SUMS:
            yield CounterMetricFamily(name, text, self._sums[key])
        yield CounterMetricFamily(
            "roomba_troubles", "Times that something was wrong", self._troubles
        )
        if self._timed is not None:
            yield _tick_histogram(self._timed.tick_times())


def _gauges(view: RobotView) -> Iterator[tuple[str, str, float]]:
    vacuum = view.vacuum
    yield "roomba_battery_ratio", "Charge of the battery, 0 to 1", vacuum.battery
    yield "roomba_area_square_metres", "Floor that the run cleaned so far", vacuum.covered
    yield "roomba_wanted_square_metres", "Floor that the run is to clean", vacuum.wanted
    yield "roomba_bin_grams", "Dirt that was picked up since the bin was emptied", view.dirt
    yield "roomba_speed_metres_per_second", "How fast it drives", view.speed
    yield "roomba_clock_seconds", "The robot's clock", view.time


def _tick_histogram(times: TickTimes) -> Metric:
    from prometheus_client.core import HistogramMetricFamily

    buckets, total = [], 0
    for bound, count in zip((*times.bounds, math.inf), times.counts, strict=True):
        total += count
        buckets.append(("+Inf" if math.isinf(bound) else str(bound), float(total)))
    text = "Time that a tick of the robot took to compute"
    return HistogramMetricFamily("roomba_tick_seconds", text, buckets, times.seconds)


def metrics_api(metrics: RobotMetrics) -> APIRouter:
    """Return the route of a robot's metrics."""
    api = APIRouter()
    exposed: Callable[[], bytes] | None = None
    try:
        from prometheus_client import CollectorRegistry, exposition
    except ImportError:
        kind = "text/plain"
    else:
        kind = exposition.CONTENT_TYPE_LATEST
        registry = CollectorRegistry(auto_describe=False)
        registry.register(metrics)
        exposed = partial(exposition.generate_latest, registry)

    @api.get(
        "/metrics",
        summary="Metrics for Prometheus, in its text format",
        response_class=Response,
        responses={200: {"content": {"text/plain": {"example": "roomba_battery_ratio 0.93\n"}}}},
    )
    def scrape() -> Response:
        if exposed is None:
            raise HTTPException(501, _MISSING)
        return Response(exposed(), media_type=kind)

    return api
