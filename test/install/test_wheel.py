"""The library outside its checkout: a wheel, in an environment that has no ROS."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fixtures.installation import REPOSITORY, Installation

from roomba.files.shipped import HOMES

ROS_MODULES = "rospy", "rosgraph", "genpy", "catkin_pkg", "roomba_robot"
AGENT = """
import sys
import gymnasium
import numpy as np
import roomba.gym

environment = gymnasium.make("RoombaClean-v0", home="studio")
observation, _ = environment.reset(seed=1)
environment.action_space.seed(1)
for _ in range(5):
    observation, reward, *_ = environment.step(environment.action_space.sample())
assert np.isfinite(reward)
print(roomba.gym.__file__)
print(*sorted({name.split(".")[0] for name in sys.modules}))
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Installation:
    return Installation(tmp_path_factory.mktemp("wheel"))


def test_the_homes_and_the_configuration_come_along(installed: Installation) -> None:
    program = """
from roomba.configuration.simulation import SimulatedRobotConfig, load_simulated_config
from roomba.files.shipped import CONFIGURATION, HOMES
read = load_simulated_config(CONFIGURATION / "robot.yaml", CONFIGURATION / "simulation.yaml")
assert read == SimulatedRobotConfig()
print(*sorted(path.relative_to(HOMES) for path in HOMES.rglob("*.*")))
"""
    done = installed.python(program)
    assert done.returncode == 0, done.stderr
    ours = sorted(str(path.relative_to(HOMES)) for path in HOMES.rglob("*.*"))
    assert done.stdout.split() == ours


def test_it_tells_the_version_of_package_xml(installed: Installation) -> None:
    version = ElementTree.parse(REPOSITORY / "package.xml").findtext("version")
    assert installed.roomba("--version").stdout == f"roomba_robot {version}\n"


def test_it_cleans_a_home_from_another_folder(installed: Installation) -> None:
    done = installed.roomba("sim", "--home", "studio", "--seed", "1", "--json", "-")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert (told["outcome"], told["docked"]) == ("COMPLETED", True)


def test_with_the_oldest_numba_that_may_be_there_a_clean_is_the_same(
    installed: Installation, tmp_path: Path
) -> None:
    """The newest one comes by itself: both ends of the range are tried."""
    asked = """
from importlib.metadata import requires
print(next(each for each in requires("roomba_robot") if each.startswith("numba")))
"""
    oldest = re.search(r">=([\d.]+)", installed.python(asked).stdout)
    assert oldest is not None
    older = Installation(tmp_path)
    pip = ["-m", "pip", "install", "--quiet", f"numba=={oldest[1]}.*"]
    program = f"import subprocess, sys; subprocess.run([sys.executable, *{pip}], check=True)"
    assert older.python(program).returncode == 0
    cleans = []
    for each in (installed, older):
        done = each.roomba("sim", "--home", "studio", "--seed", "1", "--json", "-")
        assert done.returncode == 0, done.stderr
        cleans.append(json.loads(done.stdout))
    assert cleans[0]["outcome"] == cleans[1]["outcome"] == "COMPLETED"
    for figure in ("hits", "fraction", "path_ratio"):
        assert cleans[0][figure] == pytest.approx(cleans[1][figure], rel=1e-6), figure


def test_it_maps_a_home_and_writes_the_map(installed: Installation) -> None:
    done = installed.roomba("map", "--home", "studio", "--out", "made")
    assert done.returncode == 0, done.stdout + done.stderr
    assert (installed.away / "made" / "map.yaml").is_file()


def test_it_makes_pictures(installed: Installation) -> None:
    done = installed.roomba("pictures", "--only", "home", "levels")
    assert done.returncode == 0, done.stdout + done.stderr
    made = {path.name for path in (installed.away / "pictures").iterdir()}
    assert made == {"home.png", "levels.png"}


def test_it_measures_ours_and_names_the_peers_that_are_not_there(installed: Installation) -> None:
    words = ("--quick", "plan", "--json", "plan.json", "--markdown", "plan.md")
    done = installed.roomba("bench", *words)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = json.loads((installed.away / "plan.json").read_text(encoding="utf-8"))
    assert {row["figure"] for row in rows if row["value"] is None} == {
        "shortest 8-connected path: times better than pyastar2d"
    }
    reasons = [peer["error"] for row in rows for peer in row["peers"]]
    assert len(reasons) == 20
    assert all("name one that has " in reason for reason in reasons)
    assert "pyastar2d: not measured (" in (installed.away / "plan.md").read_text(encoding="utf-8")
    assert (installed.away / "bench.results" / "plan.png").is_file()


def test_a_python_of_the_peers_runs_them_with_nothing_of_the_robot(installed: Installation) -> None:
    """The one that is named is empty: numpy of the robot's own packages is not taken."""
    assert installed.python("import venv; venv.create('none')").returncode == 0
    words = ("--quick", "plan", "--peers", "none/bin/python3", "--json", "plan.json")
    done = installed.roomba("bench", *words)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = json.loads((installed.away / "plan.json").read_text(encoding="utf-8"))
    reasons = {peer["error"] for row in rows for peer in row["peers"]}
    missing = {f"ModuleNotFoundError: No module named '{name}'" for name in ("networkx", "numpy")}
    assert reasons == missing


def test_the_environment_for_agents_works_and_loads_no_ros(installed: Installation) -> None:
    done = installed.python(AGENT)
    assert done.returncode == 0, done.stderr
    where, loaded = done.stdout.splitlines()
    assert "site-packages" in where
    assert set(loaded.split()) & set(ROS_MODULES) == set()


def test_the_doctor_finds_nothing_missing(installed: Installation) -> None:
    done = installed.roomba("doctor")
    assert done.returncode == 0, done.stdout
    assert "gymnasium" in done.stdout
    assert "missing" not in done.stdout


@pytest.mark.parametrize(
    ("command", "said"),
    [("run", "needs ROS"), ("exercise", "needs the sources"), ("bogus", "expected a command")],
)
def test_a_command_that_is_not_here_says_so_in_one_line(
    installed: Installation, command: str, said: str
) -> None:
    done = installed.roomba(command)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_types_come_along(installed: Installation) -> None:
    program = "from pathlib import Path; import roomba; print(Path(roomba.__file__).parent)"
    assert (Path(installed.python(program).stdout.strip()) / "py.typed").is_file()
