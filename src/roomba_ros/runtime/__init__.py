"""The common parts of all nodes."""
