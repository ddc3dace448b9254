"""Surfaces by the names of materials."""

from __future__ import annotations

import pytest

from roomba.world.home.materials import MATERIALS
from roomba.world.home.surface import LOW, OF_MATERIAL, Finish, surface_of


def test_what_is_low_lets_every_beam_pass_over() -> None:
    assert LOW.is_clear
    assert LOW not in OF_MATERIAL.values()


def test_every_surface_is_that_of_a_material_that_has_a_look() -> None:
    assert set(OF_MATERIAL) <= set(MATERIALS)
    assert surface_of(None) is None
    assert surface_of("fabric_blue") is None


@pytest.mark.parametrize("name", OF_MATERIAL)
def test_a_cells_byte_tells_finish_and_percents(name: str) -> None:
    surface = OF_MATERIAL[name]
    if surface.is_clear:
        assert surface.finish in (Finish.GLASS, Finish.MIRROR)
        return
    assert 0 < surface.code < 256
    assert surface.code // 100 == surface.finish
    assert surface.code % 100 == pytest.approx(100.0 * surface.reflectivity)
