"""The wheel in an empty environment of each Python that it is made for, called from elsewhere.

A Python that is not installed here is skipped, and the skip says so.
"""

from __future__ import annotations

import json
import re
import shutil
import signal
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path

import pytest
from fixtures.drives.made_logs import Item, drive, write_bag, write_carmen
from fixtures.installation import Installation
from fixtures.interpreters import interpreter_of

VERSIONS = "3.10", "3.11", "3.12", "3.13"
CAMPAIGN = Path(__file__).with_name("campaign.yaml")
SECONDS = 20.0
"""s; of the made drive, once around."""
ENDED = 20.0
"""s; the longest that a program may take to end once Ctrl-C was pressed."""
AGENT = """
import gymnasium
import numpy as np
import roomba.gym

environment = gymnasium.make("RoombaClean-v0", home="studio")
environment.action_space.seed(1)
first, _ = environment.reset(seed=1)
rewards = [environment.step(environment.action_space.sample())[1] for _ in range(20)]
again, _ = environment.reset(seed=1)
assert np.array_equal(first, again), (first, again)
assert np.isfinite(rewards).all() and len(set(rewards)) > 1, rewards
print(len(rewards))
"""
MODULES = """
import importlib, pkgutil
import roomba

count = 0
for module in pkgutil.walk_packages(roomba.__path__, "roomba."):
    if not module.name.endswith(".__main__"):
        importlib.import_module(module.name)
        count += 1
print(count)
"""


@pytest.fixture(scope="module", params=VERSIONS)
def installed(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Installation:
    python = interpreter_of(request.param)
    if python is None:
        pytest.skip(f"no Python {request.param} is installed, on PATH or by pyenv")
    folder = tmp_path_factory.mktemp("python")
    installation = Installation(folder, python, "campaign,gym,smart-home")
    told = installation.python("import sys; print(*sys.version_info[:2], sep='.')").stdout
    assert told.strip() == request.param
    return installation


def test_every_module_can_be_imported(installed: Installation) -> None:
    done = installed.python(MODULES)
    assert done.returncode == 0, done.stderr
    sources = Path(__file__).parents[2] / "src" / "roomba"
    ours = [path for path in sources.rglob("*.py") if path.name != "__main__.py"]
    assert int(done.stdout) == len(ours) - 1  # roomba itself


def test_it_cleans_a_home(installed: Installation) -> None:
    done = installed.roomba("sim", "--home", "studio", "--seed", "1", "--json", "-")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert (told["outcome"], told["docked"]) == ("COMPLETED", True)


@pytest.mark.parametrize(("name", "write"), [("made.bag", write_bag), ("made.log", write_carmen)])
def test_it_maps_a_recorded_drive(
    installed: Installation, name: str, write: Callable[[Path, list[Item]], Path]
) -> None:
    write(installed.away / name, drive(SECONDS))
    figures, home = f"{name}.json", f"{name}.home"
    done = installed.roomba("map", "--bag", name, "--json", figures, "--out", home)
    assert done.returncode == 0, done.stdout + done.stderr
    told = json.loads((installed.away / figures).read_text("utf-8"))
    assert told["scans"] == 5.0 * SECONDS
    assert (installed.away / home / "map.yaml").is_file()


def test_a_robot_lives_on_a_page_until_ctrl_c(installed: Installation) -> None:
    words = ("--home", "studio", "--no-open", "--port", "0")
    with installed.running("play", *words) as program:
        assert program.stdout is not None
        printed = ""
        for line in program.stdout:
            printed += line
            if "Ctrl-C" in line:
                break
        found = re.search(r"(http://\S+?)#token=(\S+)", printed)
        assert found, printed
        address, token = found.groups()
        with urllib.request.urlopen(address, timeout=60.0) as page:
            assert (page.status, b"<html" in page.read()) == (200, True)
        with urllib.request.urlopen(f"{address}api/v1/home", timeout=60.0) as answer:
            assert json.load(answer)["rooms"]
        beep = urllib.request.Request(f"{address}api/v1/locate", b"", method="POST")
        with pytest.raises(urllib.error.HTTPError, match="401"):
            urllib.request.urlopen(beep, timeout=60.0)
        beep.add_header("Authorization", f"Bearer {token}")
        with urllib.request.urlopen(beep, timeout=60.0) as answer:
            assert answer.status == 200
        program.send_signal(signal.SIGINT)
        rest, _ = program.communicate(timeout=ENDED)
    assert program.returncode == 0, printed + rest
    assert "Traceback" not in printed + rest


def test_the_environment_for_agents_steps_and_begins_anew(installed: Installation) -> None:
    done = installed.python(AGENT)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["20"]


def test_it_measures_how_fast_it_plans(installed: Installation) -> None:
    done = installed.roomba("bench", "--quick", "plan", "--json", "plan.json")
    assert done.returncode == 0, done.stdout + done.stderr
    rows = json.loads((installed.away / "plan.json").read_text(encoding="utf-8"))
    times = [row["value"] for row in rows if row["unit"] == "ms"]
    assert len(times) > 2
    assert min(times) > 0.0


def test_it_compares_variants_on_a_cluster(installed: Installation) -> None:
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
