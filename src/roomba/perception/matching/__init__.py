"""Matching of scans to the surfaces of a map."""
