"""Frontiers: where known floor borders on the unknown."""
