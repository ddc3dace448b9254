import math

import pytest

from roomba.configuration.seed import SeedParameters, parse_seed_parameters
from roomba.errors import ConfigError


def test_missing_parameters_have_the_reports_values() -> None:
    assert parse_seed_parameters({}) == SeedParameters(
        robot_name="roomba_robot",
        robot_max_speed=0.5,
        initial_post_x=0.0,
        initial_post_y=0.0,
        min_cordinate=-100.0,
        max_cordinate=100.0,
    )


def test_the_reports_other_spellings_mean_the_same() -> None:
    parsed = parse_seed_parameters(
        {"initial_pos_x": 1, "initial_pos_y": 2.5, "min_coordinate": -7, "max_coordinate": 7}
    )
    assert (parsed.initial_post_x, parsed.initial_post_y) == (1.0, 2.5)
    assert (parsed.min_cordinate, parsed.max_cordinate) == (-7.0, 7.0)


def test_where_both_spellings_are_set_the_other_one_was_set_by_the_operator() -> None:
    assert parse_seed_parameters({"max_coordinate": 7, "max_cordinate": 9}).max_cordinate == 7.0


@pytest.mark.parametrize(
    "wrong",
    [
        {"robot_max_speed": -0.5},
        {"robot_max_speed": 0},
        {"robot_max_speed": "fast"},
        {"robot_max_speed": math.nan},
        {"robot_max_speed": math.inf},
        {"robot_max_speed": True},
        {"initial_post_x": math.nan},
        {"min_cordinate": 5, "max_cordinate": 5},
        {"min_cordinate": [1]},
        {"robot_name": 3},
        {"robot_name": ""},
    ],
)
def test_a_wrong_parameter_is_refused_in_one_line_that_names_it(wrong: dict[str, object]) -> None:
    with pytest.raises(ConfigError) as refusal:
        parse_seed_parameters(wrong)
    message = str(refusal.value)
    assert "\n" not in message
    assert any(name in message for name in wrong)


def test_limits_hold_for_both_coordinates_and_refuse_what_is_no_number() -> None:
    limits = SeedParameters(min_cordinate=-1.0, max_cordinate=2.0)
    assert limits.allows(-1.0, 2.0)
    assert not limits.allows(-1.01, 0.0)
    assert not limits.allows(0.0, 2.01)
    assert not limits.allows(math.nan, 0.0)
    assert not limits.allows(0.0, -math.inf)
