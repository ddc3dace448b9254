"""Searches over the cells that fit: any-angle, and from cell to cell."""
