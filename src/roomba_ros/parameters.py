"""The seed's parameters on the ROS parameter server: read, validated, and watched while it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import rospkg
import rospy

from roomba.config import (
    SEED_SPELLINGS,
    RobotConfig,
    SeedParameters,
    load_robot_config,
    parse_seed_parameters,
)
from roomba.errors import ConfigError


def read_seed_parameters() -> SeedParameters:
    """Return the parameters as set now; raises ConfigError for a wrong one."""
    found = {}
    for spellings in SEED_SPELLINGS.values():
        for spelling in spellings:
            key = rospy.search_param(spelling)
            if key is not None:
                found[spelling] = rospy.get_param(key)
    return parse_seed_parameters(found)


def read_robot_config() -> RobotConfig:
    """Return the configuration named by the parameter ``robot_config``, or the shipped one."""
    key = rospy.search_param("robot_config")
    path = rospy.get_param(key) if key else package_folder() / "config" / "robot.yaml"
    return load_robot_config(Path(path))


def package_folder() -> Path:
    """Return where this package's launch, config and homes folders are."""
    return Path(rospkg.RosPack().get_path("roomba_robot"))


class LiveSeedParameters:
    """The parameters in force: a good change is obeyed, a bad one is refused with a warning.

    The master tells this node of changes; reading costs no call.
    """

    def __init__(self, *, restores: bool = False) -> None:
        """Read them all; raises ConfigError. ``restores`` puts a refused parameter back."""
        self._restores = restores
        self.values = read_seed_parameters()
        self._keys = self._find_keys()
        self._seen = self._raw()

    def refresh(self) -> SeedParameters:
        """Take over what was changed since the last call; return what is in force."""
        raw = self._raw()
        if raw == self._seen:
            return self.values
        changed = {name: raw.get(name) for name in raw if raw.get(name) != self._seen.get(name)}
        self._seen = raw
        try:
            self.values = parse_seed_parameters(raw)
            rospy.loginfo("parameters changed: %s", changed)
        except ConfigError as error:
            rospy.logwarn("refused: %s; the old value stays in force", error)
            if self._restores:
                self._restore(changed)
        return self.values

    @staticmethod
    def _find_keys() -> dict[str, str]:
        """Return the key of each spelling that is set, and of each parameter's own.

        No others: what is not set costs a call of the master each time it is read.
        """
        keys = {}
        for name, spellings in SEED_SPELLINGS.items():
            for spelling in spellings:
                key = rospy.search_param(spelling)
                if key is not None:
                    keys[spelling] = key
            if not keys.keys() & set(spellings):
                keys[name] = rospy.resolve_name(name)
        return keys

    def _raw(self) -> dict[str, Any]:
        raw = {}
        for spelling, key in self._keys.items():
            try:
                value = rospy.get_param_cached(key)
            except KeyError:
                continue
            # An empty dictionary is how the master tells that a parameter is not set.
            if value != {}:
                raw[spelling] = value
        return raw

    def _restore(self, changed: dict[str, Any]) -> None:
        for name, spellings in SEED_SPELLINGS.items():
            for spelling in spellings:
                if spelling in changed:
                    rospy.set_param(self._keys[spelling], getattr(self.values, name))
        self._seen = self._raw()
