"""Reading a home from its files."""
