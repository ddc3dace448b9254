"""The action server of walks."""
