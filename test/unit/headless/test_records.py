"""What headless robots have in common: how long a clean may last."""

import pytest
from fixtures.robots.missions import HOME

from roomba.errors import RoombaError
from roomba.headless.records import longest_errand, require_end


def test_a_clean_may_last_the_longer_the_more_floor_there_is() -> None:
    longest = longest_errand(HOME)
    assert longest == 12 * 3600.0 + 150.0 * HOME.map.free_area
    require_end(longest - 1.0, longest)
    with pytest.raises(RoombaError, match="still under way"):
        require_end(longest + 1.0, longest)
