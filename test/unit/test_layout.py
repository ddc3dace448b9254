"""Tests mirror the modules: each has a file of tests, or an entry here with the reason.

``test/unit/a/b/test_c.py`` tests ``src/roomba/a/b/c.py``, ``test/ros/b/test_c.py``
``src/roomba_ros/b/c.py``, and ``test/unit/roomba_bench/b/test_c.py`` ``src/roomba_bench/b/c.py``.
Folders stay small enough to be looked over.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest
from running.suites import SUITES

ROOT = Path(__file__).resolve().parents[2]
SOURCE, TEST = ROOT / "src", ROOT / "test"
MOST_FILES = 15
MOST_LINES = 400
MOST_LONG_FILES = 32

LIVE = "lives under a client"
PART = "a compiled or private part of one stage, tested through it"
VALUES = "values without behaviour of their own"
COMMAND = "a part of one command, tested by running it"
PICTURES = "a picture is drawn with all others, and its figures are looked at"
WORLD = "a part of the simulated world, tested by what the robot meets there"
MISSION = "a part of the mission, tested by commanding and ticking it"
NODE = "a part of a node, tested with the node in a graph"
WARM = "compiles ahead of time what others test"
MEASURED = "what a topic of the benchmarks measures, tested by its rows"
FORM = (
    "runs where it is measured, or in a peer's process; that it has the form of its kind is tested"
)

TESTED_BY: dict[str, tuple[str, str]] = {
    "roomba_ros/plain/details": ("ros/rosbridge/test_programs.py", NODE),
    "roomba_ros/rosbridge/": ("ros/rosbridge/test_bridge.py", NODE),
    "roomba/client/events": ("unit/ui/web/streams/test_events.py", "kept and streamed there"),
    "roomba/client/floor_map": ("unit/ui/smart_home/test_map_picture.py", "drawn there"),
    "roomba/client/token": ("unit/ui/web/test_kept_token.py", "read as it is written"),
    "roomba/ui/smart_home/switch": ("unit/ui/smart_home/test_smart_home.py", "switches it on"),
    "roomba/ui/smart_home/topics": ("unit/ui/smart_home/test_announcement.py", VALUES),
    "roomba/ui/web/routes/wishes": ("unit/ui/web/test_app.py", VALUES),
    "roomba/ui/web/routes/examples": ("unit/ui/web/test_guarded_routes.py", VALUES),
    "roomba/ui/web/guarded_requests": ("unit/ui/web/test_guarded_routes.py", "guards every route"),
    "roomba/ui/web/bounded/limits": ("unit/ui/web/bounded/test_connections.py", VALUES),
    "roomba/ui/web/streams/listening": ("unit/ui/web/streams/test_events.py", "their route"),
    "roomba/ui/web/rosbridge_route": ("unit/ui/web/test_guarded_routes.py", "guards a bridge"),
    "roomba/ui/web/streams/told": ("unit/ui/web/bounded/test_connections.py", VALUES),
    "roomba/ui/web/viewers": ("unit/ui/web/bounded/test_connections.py", "tested by viewers"),
    "roomba_ros/supervision/enter": ("system/test_isolation.py", NODE),
    "roomba_ros/supervision/isolation": ("system/test_isolation.py", NODE),
    "roomba_ros/supervision/namespace": ("system/test_isolation.py", NODE),
    "roomba_ros/supervision/launch_xml": ("ros/supervision/test_launch_file.py", VALUES),
    "roomba/client/clock": ("unit/client/fake/test_robot.py", VALUES),
    "roomba/client/fake/": ("unit/client/fake/test_robot.py", "one robot in three files"),
    "roomba/client/household": ("unit/household/test_household.py", "an interface"),
    "roomba/planning/coverage/tour/bends": (
        "unit/planning/coverage/tour/test_rounding.py",
        PART,
    ),
    "roomba/arrays": ("unit/raster/test_regions.py", "types alone"),
    "roomba/client/ports": ("unit/commands/status/test_command.py", VALUES),
    "roomba/client/protocol": ("unit/client/fake/test_robot.py", "an interface"),
    "roomba/client/observed": ("unit/ui/web/test_app.py", "an interface"),
    "roomba_bench/": ("unit/roomba_bench/test_command.py", COMMAND),
    "roomba_bench/coverage/": ("unit/roomba_bench/coverage/test_rows.py", MEASURED),
    "roomba_bench/localization/": (
        "unit/roomba_bench/localization/test_localization.py",
        MEASURED,
    ),
    "roomba_bench/mapping/": ("unit/roomba_bench/mapping/test_mapping.py", MEASURED),
    "roomba_bench/page/": ("unit/roomba_bench/test_topics.py", FORM),
    "roomba_bench/peers/": ("unit/roomba_bench/test_topics.py", FORM),
    "roomba_bench/rooms/": ("unit/roomba_bench/rooms/test_rooms.py", MEASURED),
    "roomba_bench/ros/": ("unit/roomba_bench/test_topics.py", FORM),
    "roomba_bench/slam/": ("unit/roomba_bench/slam/test_slam.py", MEASURED),
    "roomba_bench/topics/": ("unit/roomba_bench/test_topics.py", FORM),
    "roomba/commands/campaign/": ("unit/commands/campaign/test_command.py", COMMAND),
    "roomba/ui/live_bar": ("unit/ui/test_progress.py", "drawn with what it shows"),
    "roomba/commands/demonstration/command": (
        "unit/commands/demonstration/test_course.py",
        COMMAND,
    ),
    "roomba/commands/demonstration/listener": (
        "unit/commands/demonstration/test_course.py",
        COMMAND,
    ),
    "roomba/commands/demonstration/programs": (
        "unit/commands/demonstration/test_course.py",
        COMMAND,
    ),
    "roomba/commands/draw_homes": ("unit/world/layers/test_homes.py", COMMAND),
    "roomba/commands/exercise/": ("unit/commands/exercise/test_exercises.py", COMMAND),
    "roomba/commands/localize/": ("unit/commands/localize/test_command.py", COMMAND),
    "roomba/commands/map/": ("unit/commands/map/test_command.py", COMMAND),
    "roomba/commands/map/drive/": ("unit/commands/map/drive/test_command.py", COMMAND),
    "roomba/commands/pictures/": ("unit/commands/pictures/test_pictures.py", PICTURES),
    "roomba/commands/play/": ("unit/headless/live/test_client.py", COMMAND),
    "roomba/commands/progress": ("unit/commands/map/test_command.py", COMMAND),
    "roomba/commands/report/": ("unit/commands/report/test_command.py", COMMAND),
    "roomba/commands/sim/": ("unit/commands/sim/test_command.py", COMMAND),
    "roomba/commands/status/": ("unit/commands/status/test_command.py", COMMAND),
    "roomba/commands/trials/": ("unit/commands/trials/test_runs.py", COMMAND),
    "roomba/commands/valetudo/": ("unit/commands/valetudo/test_valetudo_commands.py", COMMAND),
    "roomba/commands/warm_up": ("system/test_one_command.py", WARM),
    "roomba/configuration/": ("unit/configuration/test_robot.py", "numbers with their limits"),
    "roomba/control/curve_kernels": ("unit/control/test_course.py", PART),
    "roomba/control/curve_speed_kernels": ("unit/control/test_course.py", PART),
    "roomba/control/tracking_kernels": ("unit/control/test_path_tracker.py", PART),
    "roomba/errors": ("unit/world/test_simulator.py", VALUES),
    "roomba/drivers/create2/body": ("realtime/test_create2_body.py", "in real time"),
    "roomba/drivers/driver": ("system/owned/test_line_faults.py", "an interface"),
    "roomba/drivers/reopened_line": (
        "system/owned/test_line_faults.py",
        "unplugged, plugged in",
    ),
    "roomba/emulators/create2/sensing": ("unit/emulators/create2/test_robot.py", PART),
    "roomba/emulators/create2/server": ("realtime/test_create2_body.py", "as the line"),
    "roomba/emulators/lidars/sender": ("realtime/test_create2_body.py", "as the line"),
    "roomba/emulators/living": ("realtime/test_create2_body.py", "as the line"),
    "roomba/commands/emulate/making": ("unit/commands/emulate/test_command.py", COMMAND),
    "roomba/drivers/neato/conversation": ("unit/drivers/neato/test_body.py", PART),
    "roomba/emulators/neato/dialects": ("unit/emulators/neato/test_robot.py", PART),
    "roomba/emulators/neato/server": ("unit/drivers/neato/test_body.py", "as the line"),
    "roomba/files/": ("unit/world/layers/test_layer.py", "read and written with what they hold"),
    "roomba/gym/": ("unit/gym/test_single.py", "one environment, tested by stepping it"),
    "roomba/headless/body": ("unit/robot/test_parts.py", "the robot's parts are tested in it"),
    "roomba/headless/odometry_kernels": ("unit/headless/test_odometry.py", PART),
    "roomba/headless/burst_kernels": ("unit/headless/test_burst.py", PART),
    "roomba/headless/embodied": ("unit/headless/test_mission.py", "what a simulated robot is, too"),
    "roomba/headless/live/bumping/robot": ("unit/headless/live/bumping/test_client.py", LIVE),
    "roomba/headless/live/bumping/view": ("unit/headless/live/bumping/test_client.py", LIVE),
    "roomba/headless/live/live_home": ("unit/headless/live/test_playing.py", LIVE),
    "roomba/headless/live/errand": ("unit/headless/live/test_robot_client.py", LIVE),
    "roomba/headless/live/errands": ("unit/headless/live/test_robot_client.py", LIVE),
    "roomba/headless/live/camera": ("unit/headless/live/test_client.py", LIVE),
    "roomba/headless/live/floor_plan": ("unit/headless/live/test_client.py", LIVE),
    "roomba/headless/live/snapshots": ("unit/headless/live/test_client.py", LIVE),
    "roomba/headless/burst_place_kernels": ("unit/headless/test_burst.py", PART),
    "roomba/headless/burst_state": ("unit/headless/test_burst.py", VALUES),
    "roomba/headless/plan_watch": (
        "unit/mission/inputs/test_planning_context.py",
        "around the plans that are made there",
    ),
    "roomba/headless/tick_rows": ("unit/headless/test_burst.py", VALUES),
    "roomba/mission/changed_home": ("unit/mission/test_mission_growing.py", MISSION),
    "roomba/mission/commands": ("unit/mission/test_mission.py", MISSION),
    "roomba/history/report/chart": ("unit/history/report/test_document.py", VALUES),
    "roomba/history/report/picture": ("unit/history/report/test_document.py", VALUES),
    "roomba/history/report/style": ("unit/history/report/test_document.py", VALUES),
    "roomba/history/report/words": ("unit/history/report/test_document.py", VALUES),
    "roomba/history/run": ("unit/history/test_run_file.py", VALUES),
    "roomba/mission/docking/beams": ("unit/mission/docking/test_track.py", VALUES),
    "roomba/mission/docking/step": ("unit/mission/docking/test_docking.py", VALUES),
    "roomba/mission/inputs/senses": ("unit/mission/test_mission.py", VALUES),
    "roomba/mission/phases/carpet_kernels": ("unit/mission/phases/test_carpet.py", PART),
    "roomba/mission/phases/dust_bin_kernels": ("unit/mission/phases/test_dust_bin.py", PART),
    "roomba/mission/phases/step": ("unit/mission/phases/test_returning.py", VALUES),
    "roomba/mission/steady": ("unit/headless/test_burst.py", MISSION),
    "roomba/mission/ticks": ("unit/mission/test_mission.py", MISSION),
    "roomba/mission/transitions": ("unit/mission/test_mission.py", MISSION),
    "roomba/perception/calibration/place_kernels": (
        "unit/perception/localization/test_localizer.py",
        PART,
    ),
    "roomba/perception/calibration/state": (
        "unit/perception/calibration/test_kernels.py",
        VALUES,
    ),
    "roomba/perception/localization/belief/belief": (
        "unit/perception/localization/belief/test_belief_kernels.py",
        "the belief and its kernels are one",
    ),
    "roomba/perception/localization/belief/correct_kernels": (
        "unit/perception/localization/belief/test_belief_kernels.py",
        "the belief and its kernels are one",
    ),
    "roomba/perception/localization/belief/reckon_kernels": (
        "unit/perception/localization/belief/test_belief_kernels.py",
        "the belief and its kernels are one",
    ),
    "roomba/perception/localization/belief/map_spread_kernels": (
        "unit/perception/localization/belief/test_map_errors.py",
        PART,
    ),
    "roomba/perception/localization/belief/trust_kernels": (
        "unit/perception/localization/belief/test_odometry_trust.py",
        PART,
    ),
    "roomba/perception/localization/estimate": (
        "unit/perception/localization/belief/test_belief_kernels.py",
        VALUES,
    ),
    "roomba/perception/localization/recent_sight_kernels": (
        "unit/perception/localization/test_recent_sight.py",
        PART,
    ),
    "roomba/perception/localization/search/search_kernels": (
        "unit/perception/localization/search/test_place_search.py",
        PART,
    ),
    "roomba/perception/matching/beams": ("unit/perception/matching/test_match_kernels.py", VALUES),
    "roomba/perception/matching/mounts": ("ros/convert/test_scan.py", "made of messages there"),
    "roomba/perception/slam/mapper_state": (
        "unit/perception/slam/test_mapper_taken_up.py",
        VALUES,
    ),
    "roomba/perception/slam/following/scan_follower": ("unit/perception/slam/test_mapper.py", PART),
    "roomba/perception/slam/scan_matching/surfel_kernels": (
        "unit/perception/slam/scan_matching/test_surfels.py",
        PART,
    ),
    "roomba/perception/slam/drawing/submap_drawing": ("unit/perception/slam/test_mapper.py", PART),
    "roomba/perception/slam/finishing/finish": ("unit/perception/slam/test_mapper.py", PART),
    "roomba/perception/slam/mapper_estimate": ("unit/perception/slam/test_mapper.py", VALUES),
    "roomba/perception/slam/submap_map": ("unit/perception/slam/test_mapper.py", PART),
    "roomba/perception/slam/scan_matching/tolerances": (
        "unit/perception/slam/scan_matching/test_surfels.py",
        VALUES,
    ),
    "roomba/perception/swept/coverage_bits": (
        "unit/perception/swept/test_coverage_map.py",
        VALUES,
    ),
    "roomba/perception/swept/coverage_kernels": (
        "unit/perception/swept/test_coverage_map.py",
        PART,
    ),
    "roomba/perception/slam/submaps/relocation": (
        "unit/perception/slam/test_mapper_foreign.py",
        PART,
    ),
    "roomba/perception/slam/finishing/refinement_kernels": (
        "unit/perception/slam/finishing/test_refinement.py",
        PART,
    ),
    "roomba/perception/slam/following/scan_kernels": ("unit/perception/slam/test_mapper.py", PART),
    "roomba/perception/things/kernels": ("unit/perception/things/test_layer.py", PART),
    "roomba/perception/things/state": ("unit/perception/things/test_layer.py", VALUES),
    "roomba/plots/": ("unit/plots/test_home.py", "a drawing of a home is made of them"),
    "roomba/recordings/": (
        "unit/recordings/drives/test_drive.py",
        "read with all others as one drive",
    ),
    "roomba/robot/": ("unit/robot/test_parts.py", "the parts of one robot"),
    "roomba/storage/maps_folder": ("system/owned/test_owned_robot.py", VALUES),
    "roomba/storage/map_bound": ("unit/storage/test_rooms.py", "a base of what it stores"),
    "roomba/ui/errand_progress": ("unit/ui/test_cleaning.py", "shown by the menu for cleaning"),
    "roomba/ui/state_words": ("unit/commands/status/test_command.py", "told by the command"),
    "roomba/ui/top/link": ("unit/ui/top/test_app.py", "what the view follows"),
    "roomba/ui/web/routes/api": ("unit/ui/web/test_app.py", "routes of the application"),
    "roomba/ui/prompt": ("unit/ui/test_menu.py", "asked by the menu"),
    "roomba/world/camera/": ("unit/world/camera/test_camera.py", WORLD),
    "roomba/world/catalogue/": ("unit/world/catalogue/test_furniture.py", WORLD),
    "roomba/world/engine/": ("unit/world/test_simulator.py", WORLD),
    "roomba/world/home/": ("unit/world/layers/test_layer.py", WORLD),
    "roomba/world/layers/": ("unit/world/layers/test_layer.py", WORLD),
    "roomba/world/observation": ("unit/world/test_simulator.py", VALUES),
    "roomba/world/random/": ("unit/world/random/test_home.py", WORLD),
    "roomba_ros/body/drive_link": ("safety/test_drive_link.py", "a part of the safety layer"),
    "roomba_ros/body/frames": ("ros/model/test_description.py", "beside the robot's model"),
    "roomba_ros/bags/": ("ros/bags/test_sim_command.py", COMMAND),
    "roomba_ros/camera/": ("ros/camera/test_turn_camera.py", NODE),
    "roomba_ros/client/": ("ros/client/test_ros_clean.py", NODE),
    "roomba_ros/exercises/": ("teaching/test_exercises.py", NODE),
    "roomba_ros/convert/": ("ros/mission/test_mission_node_conversions.py", NODE),
    "roomba_ros/dashboard/": ("web/graph/test_page_on_graph.py", NODE),
    "roomba_ros/localization/": ("ros/position/test_position_pub_node.py", NODE),
    "roomba_ros/maps/": ("ros/maps/test_map_topics.py", NODE),
    "roomba_ros/model/picture": ("missions/test_rviz.py", PICTURES),
    "roomba_ros/mission/": ("ros/mission/test_mission_node.py", NODE),
    "roomba_ros/rooms/": ("ros/position/test_position_pub_node.py", NODE),
    "roomba_ros/runtime/": ("ros/position/test_position_pub_node.py", NODE),
    "roomba_ros/simulation/": ("ros/simulation/test_home_sim_node.py", NODE),
    "roomba_ros/walking/": ("ros/walking/test_walk_to_point_action_server.py", NODE),
}
"""Modules, or folders of them, without files of their own: the test that would fail, and why."""

OWN_TESTS = {"roomba": "unit", "roomba_ros": "ros", "roomba_bench": "unit/roomba_bench"}
"""Of each package the folder whose tests mirror it."""

LARGE_FOLDERS = {
    "src/roomba/configuration": "one part of the configuration a file",
}


@cache
def modules() -> tuple[str, ...]:
    """Paths under ``src`` without the suffix."""
    return tuple(
        sorted(
            path.relative_to(SOURCE).with_suffix("").as_posix()
            for package in OWN_TESTS
            for path in (SOURCE / package).rglob("*.py")
            if path.stem not in ("__init__", "__main__")
        )
    )


@cache
def untested() -> dict[str, str | None]:
    """Modules without files of their own, each with its line of the table."""
    return {module: entry_of(module) for module in modules() if not own_test(module).exists()}


def own_test(module: str) -> Path:
    """The file that tests a module, whether it exists or not."""
    package, *folders, name = module.split("/")
    return TEST.joinpath(OWN_TESTS[package], *folders, f"test_{name}.py")


def entry_of(module: str) -> str | None:
    """The most particular line of the table that tells of a module."""
    lines = [
        key for key in TESTED_BY if module == key or (key[-1] == "/" and module.startswith(key))
    ]
    return max(lines, key=len, default=None)


@cache
def imported_by(path: Path) -> frozenset[Path]:
    """The files of the project that a file imports, anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    places = [base.joinpath(*name.split(".")) for name in names for base in (SOURCE, TEST)]
    files = [file for place in places for file in (place.with_suffix(".py"), place / "__init__.py")]
    return frozenset(file for file in files if file.is_file())


def reached_from(path: Path) -> set[Path]:
    """The files that are imported by a file, and by those, and so on."""
    found, todo = {path}, [path]
    while todo:
        new = imported_by(todo.pop()) - found
        found |= new
        todo += new
    return found


def test_every_module_has_a_test_of_its_own_or_a_reason() -> None:
    missing = [
        f"{own_test(module).relative_to(ROOT)} for src/{module}.py"
        for module, entry in untested().items()
        if entry is None
    ]
    assert not missing, "expected a test for each module; write, or name with a reason: " + str(
        missing
    )


def test_no_line_of_the_table_is_needless() -> None:
    assert set(TESTED_BY) == set(untested().values()) - {None}


@pytest.mark.parametrize("entry", sorted(TESTED_BY))
def test_what_tests_a_module_in_place_of_a_file_of_its_own_loads_it(entry: str) -> None:
    """Nodes and peers are started as programs; of what is imported the way is followed."""
    test, reason = TESTED_BY[entry]
    assert (TEST / test).is_file()
    if reason in (FORM, NODE, WARM):
        return
    reached = reached_from(TEST / test)
    told_here = [module for module, line in untested().items() if line == entry]
    assert any(SOURCE / f"{module}.py" in reached for module in told_here)
    if not entry.endswith("/"):
        assert SOURCE / f"{entry}.py" in reached


def test_tests_stand_in_the_folders_of_what_they_are_about() -> None:
    """Files named after behaviours too; what does not lie in ``src`` has folders of its own."""
    places = {own_test(module).parent.relative_to(TEST).as_posix() for module in modules()}
    folders = {place.partition("/")[2] for place in places}
    tops = {folder.partition("/")[0] for folder in folders}
    for path in (TEST / "unit").rglob("test_*.py"):
        folder = path.parent.relative_to(TEST / "unit").as_posix()
        assert folder in folders or folder.partition("/")[0] not in tops, path


def test_every_folder_of_tests_is_a_suite_of_the_command() -> None:
    folders = {path.name for path in TEST.iterdir() if any(path.rglob("test_*.py"))}
    assert set(SUITES) == folders | {"lint"}


def test_folders_can_be_looked_over() -> None:
    large = {
        folder.relative_to(ROOT).as_posix()
        for top in (SOURCE, TEST)
        for folder in (top, *top.rglob("*"))
        if folder.is_dir()
        and sum(path.name != "__init__.py" for path in folder.glob("*.py")) > MOST_FILES
    }
    assert large == set(LARGE_FOLDERS)


def test_files_fit_in_the_head() -> None:
    """A file of more than 300 lines has two subjects, most likely; no more such ones come."""
    lines = {path: len(path.read_text("utf-8").splitlines()) for path in SOURCE.rglob("*.py")}
    long = {path.relative_to(ROOT).as_posix() for path, count in lines.items() if count > 300}
    assert len(long) <= MOST_LONG_FILES, long
    assert max(lines.values()) <= MOST_LINES


def test_no_comment_is_a_banner() -> None:
    """What parts a file has, its names say; what needs parting is two files."""
    banner = re.compile(r"^\s*#\s*([-=*#])\1{4}", re.MULTILINE)
    found = [path for top in (SOURCE, TEST) for path in top.rglob("*.py")]
    assert [path for path in found if banner.search(path.read_text(encoding="utf-8"))] == []
