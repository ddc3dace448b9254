"""What headless robots have in common."""

import pytest
from fixtures.missions import HOME

from roomba.errors import RoombaError
from roomba.headless.parts import require_end


def test_a_clean_may_last_the_longer_the_more_floor_there_is() -> None:
    area = HOME.map.free_area
    longest = 12 * 3600.0 + 150.0 * area
    require_end(longest - 1.0, HOME)
    with pytest.raises(RoombaError, match="still under way"):
        require_end(longest + 1.0, HOME)
