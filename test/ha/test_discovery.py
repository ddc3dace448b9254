"""What is announced passes the check that Home Assistant's MQTT integration makes of it."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

from roomba.ui.smart_home.announcement import announcements
from roomba.ui.smart_home.topics import MqttTopics

ROOT = Path(__file__).parents[2]
PYTHON = ROOT / ".venv-ha" / "bin" / "python3"
TOPICS = MqttTopics("roomba/robbie", "homeassistant")


def refusals(told: dict[str, Any]) -> list[str]:
    """Return what Home Assistant says of each, empty for what it takes."""
    done = subprocess.run(
        [PYTHON, ROOT / "test" / "ha" / "schemas.py"],
        input="\n".join(json.dumps(pair) for pair in told.items()),
        capture_output=True,
        text=True,
        timeout=120.0,
        check=True,
    )
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_home_assistant_takes_all_that_is_announced() -> None:
    told = announcements(TOPICS, "robbie", "Robbie")
    assert refusals(told) == [""] * len(told)


def test_it_would_refuse_what_is_wrong() -> None:
    topic = TOPICS.announcement("vacuum", "robbie")
    vacuum = announcements(TOPICS, "robbie", "Robbie")[topic]
    wrong = {**vacuum, "supported_features": ["fly"]}
    (refusal,) = refusals({topic: wrong})
    assert "fly" in refusal or "supported_features" in refusal
