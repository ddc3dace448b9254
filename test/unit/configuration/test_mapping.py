from pathlib import Path

import pytest

from roomba.configuration.mapping import MappingConfig, load_mapping_config
from roomba.errors import ConfigError
from roomba.files.shipped import CONFIGURATION

SHIPPED = CONFIGURATION / "mapping.yaml"


def test_the_shipped_file_says_what_the_library_takes_without_a_file() -> None:
    assert load_mapping_config(SHIPPED) == MappingConfig()


def test_the_shipped_file_has_every_value() -> None:
    assert load_mapping_config(SHIPPED).model_fields_set == set(MappingConfig.model_fields)


def test_every_value_of_the_shipped_file_has_a_reason_beside_it() -> None:
    lines = SHIPPED.read_text(encoding="utf-8").splitlines()
    values = [line for line in lines if line and not line.startswith("#")]
    keys = [line for line in values if not line.startswith(" ")]
    assert len(keys) == len(MappingConfig.model_fields)
    assert [line for line in values if "#" not in line] == []


@pytest.mark.parametrize(
    "text",
    [
        "resolution: 0.0",
        "keyframe_way: -1.0",
        "link_met: 1.5",
        "submap_keyframes: 3",
        "occupied_beams: 0",
        "drift: .nan",
    ],
)
def test_a_broken_value_is_refused_by_name(tmp_path: Path, text: str) -> None:
    path = tmp_path / "mapping.yaml"
    path.write_text(f"{text}\n", encoding="utf-8")
    with pytest.raises(ConfigError, match=rf"mapping\.yaml: {text.split(':')[0]}"):
        load_mapping_config(path)


def test_what_it_does_not_know_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "mapping.yaml"
    path.write_text("colour: red\n", encoding="utf-8")
    with pytest.raises(ConfigError, match="colour"):
        load_mapping_config(path)
