"""Home Assistant's own check of what is announced to it, as a program of its own environment.

Reads lines of JSON, topic and payload; writes a line of JSON for each, why it is refused or "".
"""

from __future__ import annotations

import importlib
import json
import sys

for line in sys.stdin:
    topic, payload = json.loads(line)
    component = importlib.import_module(f"homeassistant.components.mqtt.{topic.split('/')[1]}")
    refusal = ""
    try:
        component.DISCOVERY_SCHEMA(payload)
    except Exception as error:
        refusal = f"{topic}: {error}"
    print(json.dumps(refusal), flush=True)
