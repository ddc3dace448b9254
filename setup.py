"""Python packages of roomba_robot, for catkin and for pip; package.xml alone has the version."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

REPOSITORY = Path(__file__).resolve().parent
REQUIREMENTS = (REPOSITORY / "requirements.txt").read_text(encoding="utf-8").splitlines()

setup(
    name="roomba_robot",
    version=ElementTree.parse(REPOSITORY / "package.xml").findtext("version"),
    packages=find_packages("src"),
    package_dir={"": "src"},
    python_requires=">=3.10",
    install_requires=[line for line in REQUIREMENTS if line and not line.startswith("#")],
    extras_require={"gym": ["gymnasium>=1.1"]},
)
