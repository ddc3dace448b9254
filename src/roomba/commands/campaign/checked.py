"""Checks a campaign before its first run: an error is reported at once, not after hours."""

from __future__ import annotations

import importlib.util

from roomba.commands.campaign.running.machines import Machines
from roomba.commands.campaign.running.specification import Campaign
from roomba.commands.options import UsageError
from roomba.commands.trials.runs import docking_config, mission_config, robot_config_of
from roomba.commands.trials.stages import stages_of
from roomba.errors import ConfigError


def check_campaign(campaign: Campaign, machines: Machines) -> None:
    """Refuse numbers, stages and a cluster that no run can use; raises UsageError."""
    for name, variant in campaign.file.variants.items():
        trial = variant.trial(campaign.file.homes[0], 0, campaign.folder)
        try:
            robot = robot_config_of(trial)
            mission_config(robot, trial.numbers).require_possible(robot.body)
            docking_config(trial.numbers)
            stages_of(trial.stages, trial.code)
        except (ConfigError, UsageError) as error:
            raise UsageError(f"variant {name}: {error}") from error
    if machines.cluster is not None:
        check_extra(machines.cluster)


def check_extra(cluster: str) -> None:
    """Refuse a cluster when dask is not installed, and a wrong address; raises UsageError."""
    if importlib.util.find_spec("distributed") is None:
        raise UsageError(
            "--cluster: expected dask.distributed, found none; pip install "
            "'roomba_robot[campaign]', or leave --cluster out for this machine's cores"
        )
    from roomba.commands.campaign.running.cluster import check_cluster

    check_cluster(cluster)
