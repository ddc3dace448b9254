"""Folders, their imports and their layers, of graphs made by hand."""

import grimp
import pytest

from roomba.commands.pictures.import_graph import (
    Import,
    folders_in,
    imports_in,
    layers_of,
    reduced,
)

DIAMOND = {"top": {"left", "right", "bottom"}, "left": {"bottom"}, "right": {"bottom"}}


def test_a_folder_is_a_package_or_a_module_beside_packages() -> None:
    graph = grimp.ImportGraph()
    for module in ("roomba", "roomba.grid", "roomba.brain", "roomba.brain.maps", "roomba_ros"):
        graph.add_module(module)
    graph.add_import(importer="roomba.brain.maps", imported="roomba.grid")
    assert folders_in(graph) == {"roomba.grid", "roomba.brain"}
    assert imports_in(graph) == [
        Import("roomba.brain.maps", "roomba.grid", "roomba.brain", "roomba.grid")
    ]


def test_each_layer_lies_one_above_all_that_it_imports() -> None:
    assert layers_of(DIAMOND) == [["bottom"], ["left", "right"], ["top"]]


def test_a_circle_has_no_layers() -> None:
    with pytest.raises(ValueError, match="no circle"):
        layers_of({"left": {"right"}, "right": {"left"}})


def test_what_a_longer_way_says_is_left_out() -> None:
    assert reduced(DIAMOND) == {"top": {"left", "right"}, "left": {"bottom"}, "right": {"bottom"}}
