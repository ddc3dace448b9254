"""A line over time as SVG."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Final

import numpy as np
from numpy.typing import NDArray

_WIDTH, _HEIGHT = 640, 160
_LEFT, _RIGHT, _TOP, _BOTTOM = 48, 8, 12, 24
_MOST: Final = 640
"""Points of a line; more are not seen."""


def chart_svg(
    title: str,
    times: NDArray[np.float64],
    values: NDArray[np.float64],
    ends: Sequence[str],
    highest: float | None = None,
) -> str:
    """Return a chart from 0 on; ``ends`` are what stands at its first and last time."""
    stride = max(1, len(times) // _MOST)
    times, values = times[::stride], values[::stride]
    top = highest or max(float(values.max(initial=0.0)), 1e-9)
    span = max(float(times[-1] - times[0]), 1e-9) if len(times) else 1.0
    wide, high = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    x = _LEFT + wide * (times - times[0] if len(times) else times) / span
    y = _TOP + high * (1.0 - np.clip(values / top, 0.0, 1.0))
    points = " ".join(f"{px:.1f},{py:.1f}" for px, py in zip(x.tolist(), y.tolist(), strict=True))
    marks = "".join(
        f'<circle class="mark" cx="{px:.1f}" cy="{py:.1f}" r="3"/>'
        for px, py in zip(x.tolist(), y.tolist(), strict=True)
        if len(times) <= 60
    )
    base = _TOP + high
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="chart" role="img" '
        f'viewBox="0 0 {_WIDTH} {_HEIGHT}"><title>{escape(title)}</title>'
        f'<path class="axis" d="M{_LEFT} {_TOP}V{base}H{_WIDTH - _RIGHT}"/>'
        f'<text x="{_LEFT - 6}" y="{_TOP + 8}" class="end">{top:.3g}</text>'
        f'<text x="{_LEFT - 6}" y="{base}" class="end">0</text>'
        f'<text x="{_LEFT}" y="{_HEIGHT - 6}">{escape(ends[0])}</text>'
        f'<text x="{_WIDTH - _RIGHT}" y="{_HEIGHT - 6}" class="end">{escape(ends[1])}</text>'
        f'<polyline class="line" points="{points}"/>{marks}</svg>'
    )
