"""The command line of ``./roomba sim``: what it means, and what it refuses in one line."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from roomba.clean_request import CleanRequest
from roomba.commands.options import UsageError
from roomba.commands.sim.options import options_of, repeating
from roomba.commands.trials.trial import MOST_THINGS, RANDOM, Trial
from roomba.geometry import Pose
from roomba.vocabulary import CleanMode, FanLevel
from roomba.world.engine.state.arrays import MOST_DISCS


def request_of(*words: str) -> CleanRequest:
    return options_of(list(words)).trial.request


def test_without_arguments_the_flat_is_cleaned_as_a_whole() -> None:
    options = options_of([])
    assert options.trial == Trial(home="flat", request=CleanRequest(in_order=True))
    assert (options.homes, options.json, options.plot, options.bag) == (None, None, None, None)
    assert not options.quiet


def test_everything_that_can_be_asked_for_arrives(tmp_path: Path) -> None:
    config = tmp_path / "robot.yaml"
    config.write_text("sensors: ideal\n", encoding="utf-8")
    words = "--home studio --station -1e-05 2 -3.1 --seed 7 --sensors ideal --things 3 --passes 2 "
    words += "--fan strong --battery 0.5 --shut-doors --no-go 0 0 1 1 --no-go -2 -2 -1 -1 --quiet "
    words += "--turned -17.5 --plan swaths=mine:swaths --plan order=their.code:best.order "
    words += f"--json --plot {tmp_path}/a.png --bag {tmp_path}/a.bag --config {config}"
    options = options_of(words.split())
    assert options.trial == Trial(
        home="studio",
        seed=7,
        request=CleanRequest(passes=2, fan=FanLevel.STRONG, in_order=True),
        sensors="ideal",
        no_go=((0.0, 0.0, 1.0, 1.0), (-2.0, -2.0, -1.0, -1.0)),
        things=3,
        shut_doors=True,
        battery=0.5,
        station=Pose(-1e-05, 2.0, -3.1),
        config=config,
        turned=-17.5,
        stages=(("order", "their.code:best.order"), ("swaths", "mine:swaths")),
        code=Path.cwd(),
    )
    assert options.json == "-"
    assert options.quiet


def test_what_is_named_says_the_mode() -> None:
    rooms = request_of("--room", "kitchen", "--room", "bathroom")
    assert (rooms.mode, rooms.rooms, rooms.in_order) == (
        CleanMode.ROOMS,
        ("kitchen", "bathroom"),
        True,
    )
    assert request_of("--zone", "0", "0", "1", "2").zones == ((0.0, 0.0, 1.0, 2.0),)
    assert request_of("--spot", "-1", "2").spot == (-1.0, 2.0)
    assert request_of("--mode", "spot").spot is None
    assert request_of("--mode", "edges").mode is CleanMode.EDGES


def test_many_homes_are_random_ones() -> None:
    options = options_of(["--homes", "3", "--seed", "5", "--mode", "dirtiest"])
    assert (options.homes, options.trial.home, options.trial.seed) == (3, RANDOM, 5)


REFUSED = {
    "--home flat --map x.yaml": "--home or --map, got both",
    "--map no/such.yaml": "--map: expected a file of a map_server map, got 'no/such.yaml'",
    "--seed -1": "--seed: expected a whole number from 0 to",
    "--seed 1.5": "got '1.5'",
    "--homes 0": "--homes: expected a whole number from 1 to",
    "--homes 2 --home flat": "--home: expected one home, got --homes 2",
    "--homes 2 --plot a.png": "--plot: expected one home, got --homes 2",
    "--homes 2 --room kitchen": "--room: expected one home, got --homes 2",
    "--sensors good": "--sensors: expected noisy, ideal, got 'good'",
    "--mode all": "--mode: expected whole, rooms, zones, spot, edges, dirtiest, got 'all'",
    "--mode rooms": "--mode rooms: expected --room NAME, got none",
    "--mode zones": "--mode zones: expected --zone X0 Y0 X1 Y1, got none",
    "--mode whole --room kitchen": "--room: expected --mode rooms, or none, got whole",
    "--room a --spot 0 0": "expected one of --room, --zone and --spot, got --room and --spot",
    "--zone 1 0 0 1": "--zone: expected lowest x, lowest y, highest x, highest y, got 1 0 0 1",
    "--no-go 1 0 0 1": "--no-go: expected lowest x",
    "--zone 1 0 0": "--zone: expected 4 arguments",
    "--spot nan 0": "--spot: expected finite numbers (m, rad), got 'nan'",
    "--turned nan": "--turned: expected a finite number (degrees), got 'nan'",
    "--passes 6": "--passes: expected a whole number from 1 to 5, got '6'",
    "--fan turbo": "--fan: expected quiet, standard, strong, got 'turbo'",
    "--things 17": f"--things: expected a whole number from 0 to {MOST_THINGS}, got '17'",
    "--battery 80": "--battery: expected a share from 0 to 1, got '80'",
    "--plot a.jpg": "--plot: expected a name that ends with .png, got a.jpg",
    "--json no/such/file": "--json: expected a file in a folder that is there, got no/such/file",
    "--json a.png --plot a.png": "--plot: a.png is the file of --json already",
    "--config no.yaml": "--config: expected a file like robot.yaml, got no.yaml",
    "--plan mine:swaths": "--plan: expected STAGE=MODULE:FUNCTION, got 'mine:swaths'",
    "--plan order=a:b --plan order=c:d": "--plan: expected each stage once, got order twice",
    "--speed 3": "unrecognized arguments: --speed 3",
    "--see 3": "unrecognized arguments: --see 3",
}


@pytest.mark.parametrize("words", REFUSED)
def test_what_cannot_be_is_refused_in_one_line(words: str) -> None:
    with pytest.raises(UsageError) as caught:
        options_of(words.split())
    assert REFUSED[words] in str(caught.value)
    assert "\n" not in str(caught.value)


def test_as_many_things_as_a_world_takes_may_be_asked_for() -> None:
    assert MOST_THINGS == MOST_DISCS


def test_the_command_that_repeats_one_of_many_runs_asks_for_the_same(tmp_path: Path) -> None:
    config = tmp_path / "my robot.yaml"
    config.touch()
    of_each = (
        *("--sensors", "ideal", "--lidar", "rplidar_a1", "--wheels", "worn", "--things", "2"),
        *("--turned", "-1e-05", "--battery=0.5", "--bin", "40", "--empty-after", "7"),
        *("--config", str(config), "--plan", "tour=mine:tour", "--shut-doors"),
        *("--passes", "2", "--fan", "quiet", "--carpets", "as-elsewhere", "--edges", "last"),
    )
    of_many = ("--homes", "9", "--seed=4", "--json", "-", "--quiet", "--no-history")
    words = [*of_many[:2], *of_each, *of_many[2:]]
    again = shlex.split(repeating(words))
    assert not {"--homes", "--seed=4", "--json", "--quiet"} & set(again)
    one = options_of([*again[again.index("--home") :], "--seed", "6"])
    assert one.trial == options_of(words).trial.with_seed(6)
    assert (one.homes, one.json) == (None, None)
