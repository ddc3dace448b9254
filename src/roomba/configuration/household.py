"""Numbers of a robot in a household, what wears and when a plan waits: ``household.yaml``."""

from __future__ import annotations

from roomba.configuration.frozen import AtLeastOne, Duration, Frozen, Positive, Ratio


class UpkeepConfig(Frozen):
    """After how much work a part is due, h."""

    brush: Positive = 300.0
    side_brush: Positive = 200.0
    filter: Positive = 150.0
    sensors: Positive = 30.0
    bin: Positive = 10.0
    """At most; one that fills sooner is due sooner."""
    soon: Ratio = 0.1
    """Share of a part's time that is left when it is told that it is due soon."""


class PlansConfig(Frozen):
    """When a plan waits, and how often it tries again: share of the battery, s."""

    least_battery: Ratio = 0.3
    """With less no clean begins by a plan."""
    retry_after: Duration = 1800.0
    """Before a clean that ended too early is tried again."""
    most_tries: AtLeastOne = 3
    """Of the same time of a plan."""
    longest_pause: Duration = 1800.0
    """On the floor while a person is at home; then the robot goes home to its station."""
    on_time: Duration = 120.0
    """What begins later than this was missed."""


class DueConfig(Frozen):
    """Which rooms are due by their dirt: shares 0..1, days."""

    least_share: Ratio = 0.8
    """Of a room that was swept, with which it counts as cleaned."""
    learning: Ratio = 0.4
    """Weight of the newest clean in how fast a room becomes dirty."""
    shortest: Positive = 0.2
    """Between two cleans of a room of which the second tells how fast it becomes dirty."""
    longest: Positive = 7.0
    """Between two cleans of any room."""
    spare: Ratio = 0.2
    """By so much a room may be told to become dirtier than the dirtiest one does between two times:
    of that the sensor counts too few grains."""


class EmptyingConfig(Frozen):
    """When a station that empties the bin is let do so on its own."""

    least: Positive = 1.0
    """g; with less it is not worth the noise."""
    level: Ratio = 0.7
    """Of what the bin takes, after a run, if it is emptied by level."""
    nearly_full: Ratio = 0.9
    """Of the station's bag, from which on it is told that an empty one is wanted."""


class HouseholdConfig(Frozen):
    """What an owner expects of a robot from day to day."""

    upkeep: UpkeepConfig = UpkeepConfig()
    plans: PlansConfig = PlansConfig()
    due: DueConfig = DueConfig()
    emptying: EmptyingConfig = EmptyingConfig()
