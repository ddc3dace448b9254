"""The answers of made-up Neatos about themselves have the form of real ones."""

from __future__ import annotations

import pytest
from fixtures.robots.neato_rig import neato_world

from roomba.emulators.neato.dialects import Model
from roomba.emulators.neato.records import DAYS, RECORDS, schedule
from roomba.emulators.neato.robot import NeatoRobot


def said(model: Model, command: str) -> list[str]:
    answer = NeatoRobot(neato_world(), model).answer(command)
    return answer.removesuffix("\x1a").split("\r\n")[1:-1]


def labels(model: Model, command: str) -> list[str]:
    return [line.split(",")[0] for line in said(model, command)]


def test_only_the_older_ones_tell_the_software_of_their_board() -> None:
    assert "MainBoard Software,23179,1," in said(Model.XV11, "GetVersion")
    botvac = said(Model.BOTVAC, "GetVersion")
    assert not any(line.startswith("MainBoard Software") for line in botvac)
    assert "Software,4,5,3,189,0" in botvac
    assert "Model,BotVacD5Connected,905-0358," in botvac


@pytest.mark.parametrize("model", Model)
def test_all_tell_a_serial_number_that_is_none(model: Model) -> None:
    assert any(line.startswith("Serial Number,EMULATED,") for line in said(model, "GetVersion"))


def test_the_buttons_of_each_are_told_and_none_is_pressed() -> None:
    assert labels(Model.XV11, "GetButtons") == [
        "Button Name", "BTN_SOFT_KEY", "BTN_SCROLL_UP", "BTN_START", "BTN_BACK", "BTN_SCROLL_DOWN",
    ]  # fmt: skip
    botvac = said(Model.BOTVAC, "GetButtons")
    assert len(botvac) == 17
    assert all(line.endswith(",0") for line in botvac[1:])
    assert "IR_BTN_RIGHT_ARC,0" in botvac


def test_the_calibration_has_its_labels() -> None:
    older = labels(Model.XV11, "GetCalInfo")
    assert older[:2] == ["Parameter", "LDSOffset"]
    assert older[7:10] == ["RDropMin", "RDropMid", "RDropMax"]
    newer = labels(Model.BOTVAC, "GetCalInfo")
    assert newer[0].startswith("calibration file")
    assert newer[-1] == "WallSensor_CalibrationData"


def test_settings_are_a_botvacs_and_the_schedule_an_xvs() -> None:
    assert "Eco Mode, OFF " in said(Model.BOTVAC, "GetUserSettings")
    assert said(Model.BOTVAC, "GetUserSettings")[-1] == "Schedule is Disabled"
    assert said(Model.BOTVAC, "GetSchedule") == ["Unknown Cmd: 'GetSchedule'"]
    assert said(Model.XV11, "GetUserSettings") == ["Unknown Cmd: 'GetUserSettings'"]
    week = said(Model.XV11, "GetSchedule")
    assert week == ["Schedule is Disabled", *(f"{day} 00:00 - None -" for day in DAYS)]


def test_a_day_of_the_schedule_is_asked_for_by_its_number() -> None:
    assert said(Model.XV11, "GetSchedule Day 6") == ["Schedule is Disabled", "Sat 00:00 - None -"]
    assert said(Model.XV11, "GetSchedule Day 7") == ["expected a Day from 0 to 6"]
    assert schedule(0)[1].startswith("Sun")


def test_counters_are_hexadecimal_and_of_a_fixed_width() -> None:
    assert RECORDS[Model.XV11].warranty(3600.4) == ["00000e10", "0000", "00000000"]
    assert RECORDS[Model.BOTVAC].warranty(59.6) == [
        "Item,Value",
        "CumulativeCleaningTimeInSecs,0000003c",
        "CumulativeBatteryCycles,0000",
        "ValidationCode,00000000",
    ]


def test_where_nothing_is_wrong_an_older_one_tells_no_error() -> None:
    assert said(Model.XV11, "GetErr") == []
    assert said(Model.BOTVAC, "GetErr")[:2] == ["Error", "200 -  (UI_ALERT_INVALID)"]
