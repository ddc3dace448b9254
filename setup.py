"""What catkin reads of the Python packages; all else about them is in pyproject.toml."""

from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

setup(
    # the version stands in package.xml alone
    version=ElementTree.parse(Path(__file__).resolve().parent / "package.xml").findtext("version"),
    packages=find_packages("src"),
    package_dir={"": "src"},
)
