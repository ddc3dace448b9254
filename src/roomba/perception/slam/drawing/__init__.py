"""Occupancy counts of the scans that are kept."""
