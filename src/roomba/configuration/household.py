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
    """At most; a bin that fills sooner is due sooner."""
    soon: Ratio = 0.1
    """Share of a part's time that is left when it is told that it is due soon."""


class PlansConfig(Frozen):
    """When a plan waits, and how often it tries again: share of the battery, s."""

    least_battery: Ratio = 0.3
    """With less no clean begins by a plan."""
    retry_after: Duration = 1800.0
    """Before a clean that ended too early is tried again."""
    most_tries: AtLeastOne = 3
    """Tries of one time of a plan."""
    longest_pause: Duration = 1800.0
    """On the floor while a person is at home; then the robot goes home to its station."""
    on_time: Duration = 120.0
    """A clean that begins later than this after its plan's time was missed."""


class DueConfig(Frozen):
    """Which rooms are due by their dirt: shares 0..1, days."""

    least_share: Ratio = 0.8
    """Share of a room that must be swept for the room to count as cleaned."""
    learning: Ratio = 0.4
    """Weight of the newest clean in how fast a room becomes dirty."""
    shortest: Positive = 0.2
    """Least time between two cleans of a room for the second to tell how fast it becomes dirty."""
    longest: Positive = 7.0
    """Longest time between two cleans of any room."""
    spare: Ratio = 0.2
    """Share by which a room may become dirtier than the dirtiest room does between two times of a
    plan: of the dirtiest room the sensor counts too few grains."""


class EmptyingConfig(Frozen):
    """When a station that empties the bin is let do so on its own."""

    least: Positive = 1.0
    """g; with less in the bin, emptying it is not worth the noise."""
    level: Ratio = 0.7
    """Share of the bin's capacity with which it is emptied after a run, if by level."""
    nearly_full: Ratio = 0.9
    """Share of the station's bag from which on the owner is told that an empty bag is wanted."""


class HouseholdConfig(Frozen):
    """What an owner expects of a robot from day to day."""

    upkeep: UpkeepConfig = UpkeepConfig()
    plans: PlansConfig = PlansConfig()
    due: DueConfig = DueConfig()
    emptying: EmptyingConfig = EmptyingConfig()
