"""The node classes do what the headless robot does: same home, same seed, same outcome."""

from pathlib import Path

import pytest
from fixtures.compositions import REFERENCE, Case, Outcome, assert_same, assert_same_end
from fixtures.forked import run_forked
from fixtures.missions import HOME, TWO_ROOMS
from fixtures.node_compositions import in_lockstep

from roomba.configuration.simulation import SimulatedRobotConfig
from roomba.files.shipped import HOMES
from roomba.mission.phases.machine import Phase
from roomba.world.layers.layer import load_home

BEGIN = 5.0
"""s; by then all nodes are ready."""
THING = (1.0, 0.75, 0.10)
"""x, y and radius, m, of something that the map of HOME does not show."""
STUDIO = load_home("studio", HOMES, SimulatedRobotConfig().body)
IDEAL = {
    "clean": Case(HOME, sensors="ideal", begin=BEGIN),
    "clean around a thing": Case(HOME, sensors="ideal", things=(THING,), seed=3, begin=BEGIN),
    "begin to clean a studio": Case(STUDIO, sensors="ideal", seconds=100.0, begin=BEGIN),
    "walk": Case(HOME, sensors="ideal", goal=(2.6, 2.1), begin=BEGIN),
}
NOISY = {
    "clean": Case(TWO_ROOMS, begin=BEGIN),
    "clean slowly around a thing": Case(HOME, things=(THING,), seed=3, speed=0.2, begin=BEGIN),
    "walk": Case(TWO_ROOMS, goal=(3.0, 2.0), begin=BEGIN),
    "walk around a thing": Case(HOME, goal=(1.4, 0.4), things=(THING,), seed=3, begin=BEGIN),
}
SURE = 60.0
"""s; for so long noise does not amplify the last bits, in which stamps of two clocks differ."""


@pytest.mark.parametrize("name", IDEAL)
def test_in_lockstep_the_nodes_drive_the_headless_path(name: str, tmp_path: Path) -> None:
    case = IDEAL[name]
    run_forked(lambda: assert_same(in_lockstep(case, tmp_path), REFERENCE(case), ticks=1))


@pytest.mark.parametrize("name", NOISY)
def test_with_noise_they_do_so_for_a_minute_and_then_come_to_the_same_end(
    name: str, tmp_path: Path
) -> None:
    case = NOISY[name]

    def compare() -> None:
        nodes, reference = in_lockstep(case, tmp_path), REFERENCE(case)
        assert_same(nodes.until(SURE), reference.until(SURE))
        assert_same_end(nodes, reference)

    run_forked(compare)


def test_they_explore_the_same_floor(tmp_path: Path) -> None:
    case = Case(TWO_ROOMS, sensors="ideal", is_mapped=False, explores=True, begin=BEGIN)

    def compare() -> None:
        nodes, reference = in_lockstep(case, tmp_path), REFERENCE(case)
        # Maps are told once a second: the nodes look at another frontier first.
        assert (nodes.told, nodes.hits, nodes.phase) == (
            reference.told,
            reference.hits,
            reference.phase,
        )
        assert nodes.figures["known"] == pytest.approx(reference.figures["known"], rel=0.01)

    run_forked(compare)


def test_with_little_charge_they_go_home(tmp_path: Path) -> None:
    case = Case(HOME, charge=0.09, charge_at=60.0, seconds=200.0, begin=BEGIN)
    # The battery is told once a second, so that they turn back later.
    run_forked(lambda: assert_charging(in_lockstep(case, tmp_path), REFERENCE(case)))


def assert_charging(nodes: Outcome, reference: Outcome) -> None:
    assert nodes.phase is reference.phase is Phase.CHARGING
    assert nodes.hits == reference.hits == 0


def test_while_they_make_the_map_they_clean_all_the_same(tmp_path: Path) -> None:
    case = Case(TWO_ROOMS, sensors="ideal", is_mapped=False, begin=BEGIN)

    def compare() -> None:
        # Maps are told once a second; headless it looks at the newest one whenever it stands.
        assert_same_end(in_lockstep(case, tmp_path), REFERENCE(case), duration=0.05)

    run_forked(compare)


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
