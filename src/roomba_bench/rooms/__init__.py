"""Rooms of maps, beside rooms that were drawn by hand."""
