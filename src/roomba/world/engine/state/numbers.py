"""The numbers of the robot as the kernels read them: one row, made from its configuration.

SI units but for energy (Wh) and dirt (micrograms); what is noise is 0 for ideal sensors.
"""

from __future__ import annotations

import math

import numpy as np

from roomba.configuration.simulation import SimulatedBattery, SimulatedRobotConfig
from roomba.world.catalogue.furniture import STATION_GAP
from roomba.world.engine.state.arrays import Rows
from roomba.world.home.dirt import MICROGRAMS_PER_GRAM


def numbers_of(config: SimulatedRobotConfig) -> Rows:
    """Return a configuration's numbers, an array of one row."""
    body, lidar, truth = config.body, config.lidar, config.simulation
    brush, battery, around = truth.brush, truth.battery, truth.surroundings
    noise = 1.0 if truth.sensors == "noisy" else 0.0
    fields: dict[str, float] = {
        "noisy": noise,
        "worn": 1.0 if truth.condition == "worn" else 0.0,
        "radius": body.radius,
        "track": body.wheel_separation,
        "wheel_radius": 0.5 * body.wheel_diameter,
        "max_angular_speed": body.max_angular_speed,
        "acceleration": body.max_acceleration,
        "deceleration": body.max_deceleration,
        "angular_acceleration": body.max_angular_acceleration,
        "angular_deceleration": body.max_angular_deceleration,
        "radians_per_count": noise * 2.0 * math.pi / config.wheels.counts_per_turn,
        "slip": noise * truth.wheels.slip,
        "carpet_slip": noise * truth.wheels.carpet_slip,
        # The sum of a process with this spread and length varies by slip_noise over each metre.
        "slip_spread": noise * truth.wheels.slip_noise / math.sqrt(2.0 * truth.wheels.slip_length),
        "slip_length": truth.wheels.slip_length,
        "blocked_slip": noise * truth.wheels.blocked_slip,
        "gyro_noise": noise * truth.gyro.noise,
        "gyro_walk": noise * truth.gyro.bias_walk,
        "acceleration_noise": noise * truth.gyro.acceleration_noise,
        "most_acceleration": truth.gyro.most_acceleration,
        "brush_width": config.brush.width,
        "brush_depth": brush.depth,
        "pickup": brush.pickup,
        "carpet_pickup": brush.carpet_pickup,
        "brush_power": brush.power,
        "carpet_power": brush.carpet_power,
        "current_noise": noise * brush.current_noise,
        "voltage": config.battery.nominal_voltage,
        "fan_pickup": truth.fan.pickup,
        "fan_power": truth.fan.power,
        "bin_capacity": config.brush.bin_capacity * MICROGRAMS_PER_GRAM,
        "grain": config.dirt_sensor.grain,
        "most_grains": config.dirt_sensor.most,
        "counting_time": config.dirt_sensor.window,
        "crumb": around.crumb,
        "capacity": config.battery.capacity,
        "idle_power": battery.idle_power,
        "drive_power": 0.5 * battery.drive_power / battery.drive_speed,
        "stall_power": battery.stall_power,
        "charge_power": charge_power(config.battery.capacity, battery),
        "taper_from": battery.taper_from,
        "taper_to": battery.taper_to,
        "ambient": battery.ambient,
        "heating": battery.heating,
        "heating_time": battery.heating_time,
        "station_ahead": body.radius + STATION_GAP,
        "contacts": math.pi if body.docks_backwards else 0.0,
        "halo": config.station.halo if config.station.has_beams else 0.0,
        "beam": config.station.beam if config.station.has_beams else 0.0,
        "beam_angle": math.radians(config.station.beam_angle),
        "half_overlap": math.radians(0.5 * config.station.overlap),
        "position_tolerance": truth.station.position_tolerance,
        "angle_tolerance": math.radians(truth.station.angle_tolerance),
        "min_range": lidar.min_range,
        "max_range": lidar.max_range,
        "scan_period": 1.0 / lidar.rate,
        "range_noise": noise * truth.lidar.noise,
        "misses": noise * truth.lidar.misses,
        "lidar_height": lidar.mount_height,
        "lidar_ahead": lidar.mount_ahead,
        "is_swept": 1.0 if config.is_swept else 0.0,
        "first_angle": lidar.first_angle,
        "beam_step": lidar.beam_step,
        "sweep_time": lidar.sweep_time,
        "time_increment": lidar.time_increment,
        "scan_delay": truth.lidar.delay,
        "noise_growth": noise * truth.lidar.noise_growth,
        "grazing_noise": noise * truth.lidar.grazing_noise,
        "range_step": noise * truth.lidar.range_step,
        "angle_rounding": noise * math.radians(truth.lidar.angle_rounding),
        "spot": noise * math.radians(0.5 * truth.lidar.spot),
        "white_reach": noise * truth.lidar.white_reach,
        "dark": truth.lidar.dark,
        "shiny": truth.lidar.shiny,
        "patch": around.patch,
        "black": around.black,
        "dimmest": around.dimmest,
        "white": around.white,
        "movable": around.movable,
        "shiny_cosine": around.shiny_cosine,
        "glass": around.glass,
        "glass_cosine": around.glass_cosine,
        "clear": around.clear,
        "fading": around.fading,
        "edge": around.edge,
    }
    for name, angle in zip("abcd", config.cliff.angles, strict=True):
        fields[f"cliff_{name}_ahead"] = config.cliff.radius * math.cos(math.radians(angle))
        fields[f"cliff_{name}_aside"] = config.cliff.radius * math.sin(math.radians(angle))
    numbers = np.zeros(1, np.dtype([(name, "f8") for name in fields]))
    for name, value in fields.items():
        numbers[name] = value
    return numbers


def charge_power(capacity: float, battery: SimulatedBattery) -> float:
    """Return the power, W, that fills ``capacity`` Wh in ``charge_hours``, ever slower at the end.

    From ``taper_from`` on the power falls evenly with the charge; that part takes
    ln(1 / taper_to) / (1 - taper_to) times as long as it would at full power.
    """
    begin, end = battery.taper_from, battery.taper_to
    taper = (1.0 - begin) * math.log(1.0 / end) / (1.0 - end)
    return capacity * (begin + taper) / battery.charge_hours
