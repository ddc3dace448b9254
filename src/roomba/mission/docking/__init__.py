"""Onto the charging station and off it."""
