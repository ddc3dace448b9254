"""Other programs' results on published drives, as published or recorded once on these files.

Kümmerle: R. Kümmerle et al., On measuring the accuracy of SLAM algorithms, Autonomous Robots 27
(2009), tables 1 and 2. Cartographer: W. Hess, D. Kohler, H. Rapp, D. Andor, Real-time loop closure
in 2D LIDAR SLAM, ICRA 2016, with parameters for each drive. gmapping (30 particles, one
configuration for all) and Karto (live) were run once on drives made of the same logs, whose
relations are those of which both times name a single scan: near to the published set, not equal.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Reached:
    """Mean error of translation, m; its deviation; mean error of rotation, degrees."""

    name: str
    translation: float
    deviation: float | None = None
    rotation: float | None = None


@dataclass(frozen=True, slots=True)
class Aims:
    """What is aimed at: mean translation, m, mean rotation, degrees, and largest translation, m."""

    translation: float | None = None
    rotation: float | None = None
    largest: float | None = None


def _kuemmerle(matching: float, particles: float, graph: float) -> tuple[Reached, ...]:
    return (
        Reached("scan matching, Kümmerle 2009", matching),
        Reached("RBPF, 50 particles, Kümmerle 2009", particles),
        Reached("graph mapping, Kümmerle 2009", graph),
    )


_GMAPPING, _KARTO, _CARTOGRAPHER = "gmapping, 30 particles", "Karto", "Cartographer 2016"
_PEERS: Final[dict[str, tuple[Reached, ...]]] = {
    "intel": (
        Reached(_GMAPPING, 0.0241, 0.0153, 0.62),
        Reached(_KARTO, 0.081, 0.189),
        Reached(_CARTOGRAPHER, 0.0229, 0.0239, 0.453),
        *_kuemmerle(0.220, 0.070, 0.031),
    ),
    "fr079": (
        Reached(_GMAPPING, 0.0371, 0.0267, 0.58),
        Reached(_CARTOGRAPHER, 0.0452, 0.0354, 0.538),
        *_kuemmerle(0.258, 0.061, 0.056),
    ),
    "csail": (
        Reached(_GMAPPING, 0.0397, 0.0304, 1.37),
        Reached(_KARTO, 0.0346, 0.0298),
        Reached(_CARTOGRAPHER, 0.0319, 0.0363, 0.369),
        *_kuemmerle(0.106, 0.049, 0.004),
    ),
    "aces": (Reached(_CARTOGRAPHER, 0.0375), *_kuemmerle(0.173, 0.060, 0.044)),
    "killian": (Reached(_CARTOGRAPHER, 0.0395), *_kuemmerle(1.651, 0.122, 0.050)),
}
_AIMS: Final = {
    "intel": Aims(0.023, 0.45, 0.10),
    "fr079": Aims(0.036, 0.54),
}


@dataclass(frozen=True, slots=True)
class Located:
    """Median error of the place, m, and the share of poses more than 0.5 m off, 0..1."""

    name: str
    median: float
    far: float


_AMCL: Final = {
    "intel": (
        Located("AMCL, its defaults, on gmapping's map", 16.2, 0.92),
        Located("AMCL, tuned on this drive, on gmapping's map", 0.096, 0.0),
    ),
}
_AT_WALLS: Final = {"wean": (("AMCL, worst", 77.0), ("AMCL, best", 86.0))}
"""AMCL was run once on the same files; % of the beams, over some runs."""


def amcl_of(log: str) -> tuple[Located, ...]:
    """Return what AMCL reached on a drive, by a word of the log's name."""
    return next((each for word, each in _AMCL.items() if word in log.lower()), ())


def amcl_at_walls(log: str) -> tuple[tuple[str, float], ...]:
    """Return the names of runs of AMCL and the share of beams at walls, %, by the log's name."""
    return next((each for word, each in _AT_WALLS.items() if word in log.lower()), ())


def peers_of(log: str) -> tuple[Reached, ...]:
    """Return what others reach on a drive, by a word of the log's name."""
    return next((peers for word, peers in _PEERS.items() if word in log.lower()), ())


def aims_of(log: str) -> Aims:
    """Return the aims for a drive; none for unknown drives."""
    return next((aims for word, aims in _AIMS.items() if word in log.lower()), Aims())
