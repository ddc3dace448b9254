"""For any input the menu asks again or obeys; the end of input leaves it with status 0."""

from __future__ import annotations

import io
import os
from typing import Final

from fixtures.spoiled import TOKENS
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rich.console import Console

from roomba.client.fake.robot import FakeRobot
from roomba.ui.menu import OPTIONS, Menu

MORE: Final = int(os.environ.get("ROOMBA_EXAMPLES", "0"))
LINES: Final = st.one_of(
    st.sampled_from([*(str(number) for number in range(-1, len(OPTIONS) + 2)), "1.5", "-0.5"]),
    st.sampled_from([token.decode("utf-8", errors="replace") for token in TOKENS]),
    st.text(max_size=40),
)


@settings(
    max_examples=MORE or 60,
    derandomize=not MORE,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
@given(st.lists(LINES, max_size=12))
def test_any_input_ends_with_status_0_in_few_lines(lines: list[str]) -> None:
    left, output, robot = list(lines), io.StringIO(), FakeRobot()

    def answer(_: str) -> str:
        if not left:
            raise EOFError
        return left.pop(0)

    menu = Menu(robot, answer, Console(file=output, force_terminal=False), clock=robot.clock)
    assert menu.run() == 0
    assert not left
    assert len(output.getvalue().splitlines()) <= 40 * (len(lines) + 1)
