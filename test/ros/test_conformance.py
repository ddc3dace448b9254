"""The node classes do what the headless robot does: same home, same seed, same outcome."""

from pathlib import Path

import pytest
from fixtures.nodes.node_compositions import in_lockstep
from fixtures.processes.forked import run_forked
from fixtures.robots.compositions import REFERENCE, Case, Outcome, assert_same, assert_same_end
from fixtures.robots.missions import HOME, TWO_ROOMS
from fixtures.thoroughness import core_first

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.vocabulary import Phase
from roomba.world.layers.layer import load_home

BEGIN = 5.0
"""s; by then all nodes are ready."""
THING = (1.03, 0.77, 0.10)
"""x, y and radius, m, of something that the map of HOME does not show."""
TURNING = "lds_02"
"""A lidar that measures one beam after the other: it turns 5 times a second."""
ALIKE = 90.0
"""s for which a noisy clean while mapping is the same. A rounding of 1e-14 m grows to 1e-7 m in
about 165 s, on some processors in 150 s. Then the encoders count a tick more or less, 0.2 mm, and a
turn ends a tick earlier soon: from there on the two robots are 15 mm apart, and part. A touch
amplifies as much within two seconds."""
STUDIO = load_home("studio", HOMES, SimulatedRobotConfig().body)
IDEAL = {
    "clean": Case(HOME, sensors="ideal", begin=BEGIN),
    "clean around a thing": Case(HOME, sensors="ideal", things=(THING,), seed=3, begin=BEGIN),
    "begin to clean a studio": Case(STUDIO, sensors="ideal", seconds=100.0, begin=BEGIN),
    "clean while mapping": Case(TWO_ROOMS, sensors="ideal", is_mapped=False, begin=BEGIN),
    "walk": Case(HOME, sensors="ideal", goal=(2.6, 2.1), begin=BEGIN),
    "clean with worn wheels": Case(HOME, sensors="ideal", wheels="worn", begin=BEGIN),
    "clean with a lidar that turns": Case(HOME, sensors="ideal", lidar=TURNING, begin=BEGIN),
    # What the nodes do not know of the wheels' calibration grows to 10 mm around a thing in 105 s.
    "begin to clean around a thing with a lidar that turns": Case(
        HOME, sensors="ideal", lidar=TURNING, things=(THING,), seed=3, seconds=100.0, begin=BEGIN
    ),
    "explore with a lidar that turns": Case(
        TWO_ROOMS, sensors="ideal", lidar=TURNING, is_mapped=False, explores=True, begin=BEGIN
    ),
}
NOISY = {
    "clean": Case(TWO_ROOMS, begin=BEGIN),
    "walk": Case(TWO_ROOMS, goal=(3.0, 2.0), begin=BEGIN),
    # The same to 1e-6 m for 145 s; then roundings, of 1e-15 m until there, grow to a centimetre
    # within a minute.
    "begin to clean slowly around a thing": Case(
        HOME, things=(THING,), seed=3, speed=0.2, seconds=140.0, begin=BEGIN
    ),
    # Of seeds 1 to 8 two part by 5 cm where the thing is first seen: 1e-14 m decides between ways.
    "walk around a thing": Case(HOME, goal=(1.4, 0.4), things=(THING,), seed=6, begin=BEGIN),
    "walk with a lidar that turns": Case(TWO_ROOMS, lidar=TURNING, goal=(3.0, 2.0), begin=BEGIN),
    "clean with a lidar that turns": Case(TWO_ROOMS, lidar=TURNING, begin=BEGIN),
}
CORE = {"clean", "walk", "clean with a lidar that turns"}
"""The cases that are always tried; with noise the whole graph is, in test/system."""
EDGE = 0.002
"""Share of the swept floor; noise amplifies the last bits of stamps to tenths of a millimetre."""


@pytest.mark.parametrize("name", core_first(IDEAL, CORE))
def test_in_lockstep_the_nodes_drive_the_headless_path(name: str, tmp_path: Path) -> None:
    case = IDEAL[name]
    run_forked(lambda: assert_same(in_lockstep(case, tmp_path), REFERENCE(case), ticks=1))


@pytest.mark.parametrize("name", core_first(NOISY, {"walk", "walk with a lidar that turns"}))
def test_with_noise_they_do_so_as_well(name: str, tmp_path: Path) -> None:
    case = NOISY[name]

    def compare() -> None:
        assert_same(in_lockstep(case, tmp_path), REFERENCE(case), ticks=1, edge=EDGE)

    run_forked(compare)


@pytest.mark.thorough
def test_with_noise_a_clean_while_mapping_begins_and_ends_as_the_headless_one(
    tmp_path: Path,
) -> None:
    case = Case(TWO_ROOMS, is_mapped=False, seed=6, begin=BEGIN)

    def compare() -> None:
        nodes, reference = in_lockstep(case, tmp_path), REFERENCE(case)
        assert_same(nodes.until(ALIKE), reference.until(ALIKE))
        assert_same_end(nodes, reference, edge=0.02, figures=0.1)
        assert nodes.told == "COMPLETED"
        assert nodes.hits == 0

    run_forked(compare)


@pytest.mark.parametrize("sensors", core_first(["ideal", "noisy"], {"ideal"}))
def test_they_explore_by_the_headless_path(sensors: str, tmp_path: Path) -> None:
    case = Case(TWO_ROOMS, sensors=sensors, is_mapped=False, explores=True, begin=BEGIN)

    def compare() -> None:
        assert_same(in_lockstep(case, tmp_path), REFERENCE(case), ticks=1, edge=EDGE)

    run_forked(compare)


@pytest.mark.thorough
def test_with_little_charge_they_go_home(tmp_path: Path) -> None:
    case = Case(HOME, charge=0.09, charge_at=60.0, seconds=200.0, begin=BEGIN)
    # The battery is told once a second, so that they turn back later.
    run_forked(lambda: assert_charging(in_lockstep(case, tmp_path), REFERENCE(case)))


def assert_charging(nodes: Outcome, reference: Outcome) -> None:
    assert nodes.phase is reference.phase is Phase.CHARGING
    assert nodes.hits == reference.hits == 0


@pytest.mark.thorough
def test_the_same_seed_gives_the_same_trace_and_another_one_another(tmp_path: Path) -> None:
    def compare() -> None:
        traces = [
            in_lockstep(
                Case(HOME, seed=seed, begin=BEGIN, seconds=60.0), tmp_path / str(run)
            ).poses.tobytes()
            for run, seed in enumerate((3, 3, 4))
        ]
        assert traces[0] == traces[1]
        assert traces[0] != traces[2]

    run_forked(compare)
