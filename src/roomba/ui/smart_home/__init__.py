"""The robot in a smart home: MQTT with Home Assistant's discovery, and a webhook."""
