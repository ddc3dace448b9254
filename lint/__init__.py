"""Checks of the sources that lint tools do not include, and tools for documents and packages."""
