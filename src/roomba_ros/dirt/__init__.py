"""The dirt node."""
