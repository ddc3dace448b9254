"""Matchers of scans: to a map, or to the scans before."""
