"""Planners of paths over the cells of a grid, and how their paths are measured."""
