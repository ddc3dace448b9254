"""Checks what a layer file says against its map and the catalogues, and names the line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from roomba.files.strict_yaml import Location, YamlFile, suggestion
from roomba.grid import GridFrame
from roomba.world.home.home import Rectangle
from roomba.world.home.materials import MATERIALS, Material


@dataclass(frozen=True, slots=True)
class Checker:
    """A file's checks; each raises HomeError (``file:line: reason``) of a value's location."""

    file: YamlFile
    frame: GridFrame

    def point(self, location: Location, x: float, y: float) -> None:
        """Refuse a point, m, that is not on the map."""
        x_min, x_max, y_min, y_max = self.frame.extent
        if not (x_min - 1e-9 <= x <= x_max + 1e-9 and y_min - 1e-9 <= y <= y_max + 1e-9):
            raise self.file.error(
                location,
                f"{location[0]}: expected a place on the map (x {x_min:g} to {x_max:g}, "
                f"y {y_min:g} to {y_max:g}), got ({x:g}, {y:g}); move it",
            )

    def rectangle(self, location: Location, corners: list[float]) -> Rectangle:
        """Return lower left and upper right corner as a rectangle; both must be on the map."""
        self.point(location, corners[0], corners[1])
        self.point(location, corners[2], corners[3])
        return Rectangle(*corners)

    def material(
        self, location: Location, name: str, known: Mapping[str, Material] = MATERIALS
    ) -> str:
        """Return a material's name; it must be known."""
        if name not in known:
            hint = suggestion(name, known)
            raise self.file.error(location, f"expected a known material, got {name!r}; {hint}")
        return name
