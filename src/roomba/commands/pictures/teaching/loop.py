"""Closing a loop: poses of a drive around a block, before and after links make them agree."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.figure import Figure

from roomba.arrays import Floats
from roomba.perception.slam.submaps.pose_graph import (
    Link,
    LinkKind,
    composed,
    optimised,
    relative_to,
)
from roomba.plots.style import BLUE, GREEN, GREY, INK, RED, drawn, empty_figure
from roomba.world.home.home import Home

_SIDE: Final = 5
"""Submaps along each side of the block."""
_STEP: Final = 2.0
"""m from one to the next."""
_NOISE: Final = (0.05, 0.05, 0.03)
"""m, m, rad; of the odometry between two."""
_CLOSE: Final = (0.02, 0.02, 0.01)
"""The same of a link that a match found."""
_WRONG: Final = (3, 12, (0.5, 0.5, 0.3))
"""A link that is wrong: between which two, and what it says; m, rad."""


@drawn
def picture_of_loop_closing(_: Home) -> Figure:
    """Draw a drive around a block: by odometry, closed, and closed beside a link that is wrong."""
    true = _block()
    random = np.random.default_rng(5)
    steps = relative_to(true[:-1], true[1:])
    measured = steps + random.normal(size=steps.shape) * _NOISE
    poses = [true[0]]
    for step in measured:
        poses.append(composed(poses[-1][None], step[None])[0])
    drifted = np.array(poses)
    odometry = [
        Link(number, number + 1, step, np.diag(1.0 / np.square(_NOISE)), LinkKind.DRIVEN)
        for number, step in enumerate(measured)
    ]
    closing = [_link(true, 0, len(true) - 1), _link(true, 1, len(true) - 1)]
    wrong = Link(*_WRONG[:2], np.array(_WRONG[2]), np.diag(1.0 / np.square(_CLOSE)))
    results = (
        ("by odometry", drifted, (), RED),
        ("two links close the loop", optimised(drifted, [*odometry, *closing]), closing, BLUE),
        (
            "beside one that is wrong",
            optimised(drifted, [*odometry, *closing, wrong]),
            [*closing, wrong],
            GREEN,
        ),
    )
    figure = empty_figure(1150, 430)
    for axes, (name, found, links, colour) in zip(figure.subplots(1, 3), results, strict=True):
        axes.plot(true[:, 0], true[:, 1], color=GREY, lw=1.0, label="truth")
        axes.plot(found[:, 0], found[:, 1], "o-", color=colour, ms=4, label="found")
        for link in links:
            ends = found[[link.parent, link.child]]
            axes.plot(ends[:, 0], ends[:, 1], color=INK, ls=":", lw=1.5)
        off = np.hypot(*(found - true)[:, :2].T)
        axes.set_title(f"{name}: {100.0 * off.max():.0f} cm off at most")
        axes.set_aspect("equal")
        axes.set(xlabel="x, m", ylabel="y, m")
        axes.legend(loc="center")
    return figure


def _link(poses: Floats, parent: int, child: int) -> Link:
    relative = relative_to(poses[parent][None], poses[child][None])[0]
    return Link(parent, child, relative, np.diag(1.0 / np.square(_CLOSE)))


def _block() -> Floats:
    """Return poses around a square, float64 [n, 3], the last one a step before the first."""
    poses, x, y = [], 0.0, 0.0
    for side in range(4):
        heading = side * np.pi / 2.0
        for _ in range(_SIDE):
            poses.append((x, y, heading))
            x, y = x + _STEP * np.cos(heading), y + _STEP * np.sin(heading)
    return np.array(poses)
