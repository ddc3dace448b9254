"""The library outside its checkout: a wheel, in an environment that has no ROS."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from fixtures.interpreters import interpreter_of

from roomba.commands.doctor import SYSTEM_PYTHON
from roomba.files.shipped import HOMES

REPOSITORY = Path(__file__).resolve().parents[2]
INSTALL_DEADLINE = 600.0
"""s; the packages come from the network."""
RUN_DEADLINE = 1200.0
"""s; the first run compiles the loops, which takes two minutes of a core."""
ROS_MODULES = "rospy", "rosgraph", "genpy", "catkin_pkg", "roomba_robot"
CAMPAIGN = Path(__file__).with_name("campaign.yaml")
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


def run(
    command: Sequence[str | Path], folder: Path, environment: Mapping[str, str], deadline: float
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=dict(environment),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=deadline,
        check=False,
    )


class Installation:
    """An environment with the wheel and its extras, and a folder that is no checkout."""

    def __init__(
        self, folder: Path, python: str | Path = SYSTEM_PYTHON, extras: str = "gym"
    ) -> None:
        """Build the wheel of the sources as they are, and install it."""
        self.away = folder / "elsewhere"
        self.away.mkdir()
        self._bin = folder / "venv" / "bin"
        self._environment = {
            "HOME": os.environ["HOME"],  # pip keeps there what it has downloaded
            "LANG": "C.UTF-8",
            "PATH": "/usr/bin:/bin",
            "PYTHONNOUSERSITE": "1",
            "NUMBA_CACHE_DIR": str(folder / "numba"),  # compiled once for all steps
        }
        sources, wheels = folder / "sources", folder / "wheels"
        for name in ("pyproject.toml", "setup.py", "package.xml", "README.md", "LICENSE"):
            sources.mkdir(exist_ok=True)
            shutil.copy2(REPOSITORY / name, sources)
        ignored = shutil.ignore_patterns("__pycache__", "*.egg-info")
        shutil.copytree(REPOSITORY / "src", sources / "src", ignore=ignored)
        self._done([python, "-m", "venv", folder / "venv"])
        pip: list[str | Path] = [self._bin / "python", "-m", "pip", "--disable-pip-version-check"]
        self._done([*pip, "wheel", "--quiet", "--no-deps", "--wheel-dir", wheels, sources])
        (wheel,) = wheels.glob("*.whl")
        self._done([*pip, "install", "--quiet", "--prefer-binary", f"{wheel}[{extras}]"])

    def roomba(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Return what the installed program did, called from elsewhere."""
        return run([self._bin / "roomba", *arguments], self.away, self._environment, RUN_DEADLINE)

    def python(self, program: str) -> subprocess.CompletedProcess[str]:
        """Return what the environment's Python made of a program."""
        command: list[str | Path] = [self._bin / "python", "-c", program]
        return run(command, self.away, self._environment, RUN_DEADLINE)

    def _done(self, command: Sequence[str | Path]) -> None:
        done = run(command, self.away, self._environment, INSTALL_DEADLINE)
        assert done.returncode == 0, done.stdout + done.stderr


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


def test_it_cleans_a_home_from_another_folder(installed: Installation) -> None:
    done = installed.roomba("sim", "--home", "studio", "--seed", "1", "--json", "-")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert (told["outcome"], told["docked"]) == ("COMPLETED", True)


def test_it_maps_a_home_and_writes_the_map(installed: Installation) -> None:
    done = installed.roomba("map", "--home", "studio", "--out", "made")
    assert done.returncode == 0, done.stdout + done.stderr
    assert (installed.away / "made" / "map.yaml").is_file()


def test_it_makes_pictures(installed: Installation) -> None:
    done = installed.roomba("pictures", "--only", "home", "levels")
    assert done.returncode == 0, done.stdout + done.stderr
    made = {path.name for path in (installed.away / "pictures").iterdir()}
    assert made == {"home.png", "levels.png"}


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
    [("run", "needs ROS"), ("bench", "needs the sources"), ("bogus", "expected a command")],
)
def test_a_command_that_is_not_here_says_so_in_one_line(
    installed: Installation, command: str, said: str
) -> None:
    done = installed.roomba(command)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("version", ["3.10", "3.11", "3.12", "3.13"])
def test_every_python_cleans_and_compares(version: str, tmp_path: Path) -> None:
    """Each that is installed here: the library, its extra and a whole campaign in it."""
    python = interpreter_of(version)
    if python is None:
        pytest.skip(f"no Python {version} is installed")
    installed = Installation(tmp_path, python, "campaign")
    assert installed.python("import sys; print(*sys.version_info[:2], sep='.')").stdout.strip() == (
        version
    )
    done = installed.roomba("doctor", "--json")
    assert done.returncode == 0, done.stdout
    rows = {row["subject"]: row["state"] for row in json.loads(done.stdout)}
    assert (rows["pyarrow"], rows["distributed"]) == ("fine", "fine")
    shutil.copy(CAMPAIGN, installed.away / "made.yaml")
    done = installed.roomba("campaign", "made.yaml", "--cluster", "local:1", "--json", "--quiet")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert [run["figures"]["outcome"] for run in told["runs"]] == ["COMPLETED"] * 2
    assert (installed.away / "made.results" / "results.parquet").is_file()


def test_types_come_along(installed: Installation) -> None:
    program = "from pathlib import Path; import roomba; print(Path(roomba.__file__).parent)"
    assert (Path(installed.python(program).stdout.strip()) / "py.typed").is_file()
