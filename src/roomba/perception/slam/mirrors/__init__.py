"""Mirrors found while a map is made, by a touch and by what they show."""
