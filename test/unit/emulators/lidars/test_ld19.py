"""A made-up LD19: its frames, and what they show."""

from __future__ import annotations

import math

import numpy as np
from fixtures.robots.create2_rig import create2_in_studio

from roomba.drivers.lidars.ld19 import SIZE, LidarFrame, frame_of
from roomba.emulators.lidars.ld19 import Ld19Emulator
from roomba.emulators.living import STEP
from roomba.geometry import STANDSTILL


def frames_of(sent: bytes) -> list[LidarFrame]:
    pieces = [sent[place : place + SIZE] for place in range(0, len(sent), SIZE)]
    frames = [frame_of(piece) for piece in pieces]
    assert None not in frames
    return [frame for frame in frames if frame is not None]


def test_it_turns_clockwise_ten_times_a_second_and_shows_what_is_there() -> None:
    simulator = create2_in_studio()
    lidar = Ld19Emulator(simulator)
    sent = b""
    for _ in range(round(1.0 / STEP)):
        simulator.advance(STANDSTILL, STEP, 1)
        sent += lidar.advance()
    frames = frames_of(sent)
    assert len(frames) == 4500 // 12
    assert {frame.speed for frame in frames} == {3600}
    beams = simulator.config.lidar.beams
    newest = simulator.ranges
    off = []
    for frame in frames[-30:]:
        for place, distance in enumerate(frame.ranges):
            clockwise = frame.first + place * frame.step
            true = float(newest[round(-clockwise / 360.0 * beams) % beams])
            if math.isfinite(distance) and math.isfinite(true):
                off.append(abs(distance - true))
    assert len(off) > 200
    assert np.max(off) <= 0.001
    assert (frames[-1].time - frames[0].time) == 997
