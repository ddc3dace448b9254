"""Scans beside the surfaces of a map."""
