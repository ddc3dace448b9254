"""Data for many viewers at once: messages that become text once, and events for programs."""
