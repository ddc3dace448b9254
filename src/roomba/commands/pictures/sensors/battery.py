"""The battery over a run, and what brush and fan do at each power level."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from roomba.arrays import Floats
from roomba.commands.pictures.sensors.drives import DriveRecording, wander
from roomba.configuration.simulation import SimulatedRobotConfig, pickup_share
from roomba.geometry import Pose, Twist
from roomba.plots.style import BLUE, GREEN, INK, ORANGE, drawn, empty_figure, stacked
from roomba.world.home.home import Home
from roomba.world.power import battery_state, noise_level
from roomba.world.simulator import Simulator

_LOW = 0.1
"""0..1; charge at which it is taken to its station."""
_DT, _STEPS = 0.1, 10
"""s, and how many of them lie between two points of the plot."""
_SECONDS = 60
"""Points that are averaged to one while driving, as the power changes with each turn."""
_HOUR = 3600.0


@drawn
def picture_of_battery(home: Home, most_hours: float = 6.0) -> Figure:
    """Draw charge, voltage, power and temperature: cleaning to 10 %, then on the station."""
    config = SimulatedRobotConfig()
    recording = DriveRecording(Simulator(home, config))
    world = recording.simulator
    world.put(home.station.compose(Pose(-0.3, 0.0, 2.0)))
    empty = _LOW * config.battery.capacity
    while world.numbers["charge"] > empty and world.time < most_hours * _HOUR:
        wander(recording, 60.0, _DT, _STEPS, seed=int(world.time))
    docked_at = world.time / _HOUR
    world.put(home.station)
    while world.numbers["charge"] < config.battery.capacity and world.time < most_hours * _HOUR:
        recording.drive(Twist(), 60.0, _DT, 100)
    hours, charge, power, temperature = (
        _by_minutes(recording.of(name), recording.of("docked") > 0.0)
        for name in ("time", "charge", "power", "temperature")
    )
    hours /= _HOUR
    figure = empty_figure(1000, 800)
    panels = stacked(figure, 4)
    for axes, values, label in (
        (panels[0], 100.0 * charge / config.battery.capacity, "charge, %"),
        (panels[1], _voltages(config, charge, power), "voltage, V"),
        (panels[2], power, "power out, W"),
        (panels[3], temperature, "temperature, °C"),
    ):
        axes.plot(hours, values, color=BLUE, linewidth=1.0)
        axes.axvline(docked_at, color=INK, linewidth=0.8, linestyle="--")
        axes.set(ylabel=label)
    panels[0].set_title(
        "Cleaning from a full battery; at 10 % put on the station (dashed); means of a minute"
    )
    panels[3].set(xlabel="time, h", xlim=(0.0, hours[-1]))
    return figure


def _by_minutes(values: Floats, docked: NDArray[np.bool_]) -> Floats:
    """Return means over whole minutes of driving; later values stay as they are."""
    minutes = int(np.count_nonzero(~docked) / _SECONDS)
    driven = values[: minutes * _SECONDS].reshape(minutes, _SECONDS).mean(axis=1)
    return np.concatenate([driven, values[docked]])


def _voltages(config: SimulatedRobotConfig, charge: Floats, power: Floats) -> Floats:
    capacity, resistance = config.battery.capacity, config.simulation.battery.resistance
    states = (
        battery_state(
            capacity,
            resistance,
            config.battery.cells,
            charge=c,
            power=p,
            temperature=0.0,
            is_docked=False,
        )
        for c, p in zip(charge.tolist(), power.tolist(), strict=True)
    )
    return np.array([state.voltage for state in states])


@drawn
def picture_of_levels(home: Home, points: int = 101) -> Figure:
    """Draw what a pass picks up, what it takes and how loud it is, by the fan's duty."""
    config = SimulatedRobotConfig()
    brush, fan = config.simulation.brush, config.simulation.fan
    duty = np.linspace(0.0, 1.0, points)
    figure = empty_figure(1100, 380)
    share, power, noise = figure.subplots(1, 3)
    for part, colour, name in (
        (brush.pickup, BLUE, "brush on hard floor"),
        (brush.carpet_pickup, GREEN, "brush on carpet"),
        (0.0, ORANGE, "no brush"),
    ):
        picked = [pickup_share(part, fan.pickup * value) for value in duty]
        share.plot(duty, picked, color=colour, label=name)
    for part, colour in ((brush.power, BLUE), (brush.carpet_power, GREEN), (0.0, ORANGE)):
        power.plot(duty, part + fan.power * duty**3, color=colour)
    for part, colour in ((1.0, BLUE), (0.0, ORANGE)):
        levels = [noise_level(config.simulation, (part, float(value))) for value in duty]
        noise.plot(duty, levels, color=colour)
    share.set(ylabel="share that one pass picks up", ylim=(0.0, 1.0))
    power.set(ylabel="power of brush and fan, W", ylim=(0.0, None))
    noise.set(ylabel="noise 1 m away, dB(A)")
    for axes in (share, power, noise):
        axes.axvline(config.fan.duty, color=INK, linewidth=0.8, linestyle="--")
        axes.set(xlabel="duty of the fan", xlim=(0.0, 1.0))
    figure.legend(*share.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    figure.suptitle("Power levels; dashed: the fan's duty at the start")
    return figure
