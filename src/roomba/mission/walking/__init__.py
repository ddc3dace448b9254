"""Walking to a point."""
