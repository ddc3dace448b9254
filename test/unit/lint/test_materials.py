"""Packages of the distribution and of PyPI, and what they need."""

from importlib.metadata import version
from pathlib import Path

from lint.materials import Material, python_materials, system_materials

DPKG = """\
installed\tpython3-rospy\t1.15.15\t, python3:any, python3-yaml (>= 5) | python3-other, libc6\t
installed\tpython3\t3.11.2\tpython3-minimal (= 3.11), \tpython3-profiler
installed\tpython3-yaml\t6.0\t, ros-yaml-abi\t
installed\tlibyaml\t0.2\t, \tros-yaml-abi (= 1)
not-installed\tpython3-other\t1\t, \t
installed\tunrelated\t7\t, libc6\t
"""
"""What dpkg tells: status, name, version, what it needs, what it stands for."""


def test_packages_of_the_distribution_come_with_all_that_they_need() -> None:
    found = system_materials(["python3-rospy", "not-there"], lambda: DPKG)
    assert found == [
        Material("deb", "libyaml", "0.2"),
        Material("deb", "python3", "3.11.2"),
        Material("deb", "python3-rospy", "1.15.15", needs=("python3", "python3-yaml")),
        Material("deb", "python3-yaml", "6.0", needs=("libyaml",)),
    ]


def made_package(folder: Path, name: str, *needs: str) -> None:
    made = folder / f"{name}-2.1.dist-info"
    made.mkdir()
    lines = ["Metadata-Version: 2.4", f"Name: {name}", "Version: 2.1", "License-Expression: MIT"]
    lines += [f"Requires-Dist: {need}" for need in needs]
    made.joinpath("METADATA").write_text("\n".join(lines), "utf-8")


def test_packages_of_pypi_come_with_what_they_need_here(tmp_path: Path) -> None:
    made_package(
        tmp_path,
        "Page_Server",
        "sockets>=1",
        "colours ; extra == 'pretty'",
        "old-python; python_version < '3'",
    )
    for name in ("sockets", "colours", "old-python", "unrelated"):
        made_package(tmp_path, name)
    requirements = tmp_path / "requirements.txt"
    requirements.write_text("# why\npage-server>=2  # a page\nof-the-distribution\n", "utf-8")
    assert python_materials(tmp_path, requirements) == [
        Material("pypi", "page-server", "2.1", "MIT", ("sockets",)),
        Material("pypi", "sockets", "2.1", "MIT"),
    ]


def test_what_is_installed_here_is_found() -> None:
    (rospy,) = [
        found for found in system_materials(["python3-rospy"]) if found.name == "python3-rospy"
    ]
    assert rospy.version.startswith(version("rospy"))
    assert "python3-rosgraph" in rospy.needs
