from pathlib import Path

import numpy as np
import pytest

from roomba.files.kept import unsealed
from roomba.grid import GridFrame, OccupancyMap
from roomba.perception.rooms.zones import Zone, ZoneKind, Zones, ZonesError
from roomba.storage.map_bound import map_digest
from roomba.storage.zones import load_zones, save_zones

FLOOR = OccupancyMap(GridFrame(0.05, -1.0, 2.0, 40, 60), np.zeros((40, 60), np.int8))
ZONES = Zones(
    (
        Zone("Küche: Napf", ZoneKind.NO_GO, ((0.1, 2.2), (0.6, 2.2), (0.6, 2.9), (0.1, 2.9))),
        Zone("door", ZoneKind.WALL, ((1.0, 2.0), (1.0, 3.0), (1.3, 3.7))),
    )
)


def test_zones_come_back_as_they_were(tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "zones.yaml"
    save_zones(ZONES, map_digest(FLOOR), path)
    assert load_zones(path, map_digest(FLOOR)) == ZONES
    save_zones(ZONES.without("door"), map_digest(FLOOR), path)
    assert load_zones(path, map_digest(FLOOR)).names == ("Küche: Napf",)
    names = sorted(file.name for file in path.parent.iterdir())
    assert names == ["zones.yaml", "zones.yaml.before"]


def test_a_map_without_drawn_zones_has_none(tmp_path: Path) -> None:
    assert load_zones(tmp_path / "zones.yaml", map_digest(FLOOR)) == Zones()


def test_zones_of_another_map_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "zones.yaml"
    save_zones(ZONES, map_digest(FLOOR), path)
    values = FLOOR.values.copy()
    values[3, 4] = 100
    with pytest.raises(ZonesError, match=r"zones\.yaml: expected the zones of this map"):
        load_zones(path, map_digest(OccupancyMap(FLOOR.frame, values)))


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ('"kind": "wall"', '"kind": "fence"', r"zones\.1\.kind"),
        ("zones:", "zonen:", "zones: Field required"),
        ("map:", "{", "in YAML"),
        ("[1.0, 3.0]", "[1.0, .nan]", r"zones\.1\.points"),
        ('"name": "door"', '"name": ""', "1 to 80 printable"),
        ("zones:", "zones: []\nzones:", "line 4: expected each key once, got 'zones' again"),
        ('"name": "door"', '"name": "x", "name": "door"', "got 'name' again; remove one"),
    ],
)
def test_a_file_that_makes_no_sense_is_named_with_the_reason(
    tmp_path: Path, old: str, new: str, reason: str
) -> None:
    path = tmp_path / "zones.yaml"
    save_zones(ZONES, map_digest(FLOOR), path)
    text = unsealed(path.read_bytes()).decode("utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ZonesError, match=reason) as error:
        load_zones(path, map_digest(FLOOR))
    assert str(error.value).startswith(str(path))
