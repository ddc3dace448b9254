"""Pictures are the same, to the bit, as those that were kept; a new look is a new kept picture.

``python3 test/unit/world/camera/test_kept_pictures.py``, in the environment, writes them anew.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from roomba.configuration.sensors import CameraConfig
from roomba.files.shipped import HOMES
from roomba.geometry import Pose
from roomba.world.camera.camera import Camera, Scene
from roomba.world.layers.layer import load_home
from roomba.world.simulator import Simulator

KEPT: Final = Path(__file__).with_name("kept_pictures.json")
SIZES: Final = (640, 480), (161, 123)
"""Pixels; a whole number of tiles, and not."""
SPILLED: Final = 20_000
"""µg per cell, at most, on a sixth of the cells."""
CPU_FLAGS: Final = Path("/proc/cpuinfo")


def digests(name: str, supersampling: int) -> list[str]:
    """Return a digest of each picture, colour and depth, of a home from its station and around."""
    home = load_home(name, HOMES)
    dirt = Simulator(home).dirt
    dirty = dirt.micrograms.copy()
    spilled = np.random.default_rng(3).integers(0, SPILLED, dirty[::3, ::2].shape)
    dirty[::3, ::2] += spilled.astype(dirty.dtype)
    scene = Scene.of(home)
    found = []
    for width, height in SIZES:
        camera = Camera(scene, CameraConfig(width=width, height=height), supersampling)
        for turn in range(8):
            pose = Pose(0.4, 0.1, 0.8 * turn)
            shot = camera.render(pose, 0.1 * (turn % 3), dirty, dirt.frame)
            content = shot.colour.tobytes() + np.ascontiguousarray(shot.depth).tobytes()
            found.append(hashlib.sha256(content).hexdigest()[:16])
    return found


def kept() -> dict[str, list[str]]:
    return {
        f"{name} {supersampling}": digests(name, supersampling)
        for name in ("flat", "apartment")
        for supersampling in (1, 2)
    }


@pytest.mark.skipif(
    " fma " not in CPU_FLAGS.read_text("ascii"), reason="sums are rounded otherwise without FMA"
)
@pytest.mark.parametrize("name", ["flat", "apartment"])
@pytest.mark.parametrize("supersampling", [1, 2])
def test_pictures_are_those_that_were_kept(name: str, supersampling: int) -> None:
    known = json.loads(KEPT.read_text("ascii"))[f"{name} {supersampling}"]
    assert len(set(known)) == len(known)
    assert digests(name, supersampling) == known


if __name__ == "__main__":
    KEPT.write_text(json.dumps(kept(), indent=1) + "\n", "ascii")
