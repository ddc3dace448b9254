"""User interfaces on a terminal."""
