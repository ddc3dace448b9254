"""Shortest paths over a map."""
