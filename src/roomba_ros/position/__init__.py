"""The position node."""
