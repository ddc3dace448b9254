"""Checks of the sources that the tools do not ship with."""
