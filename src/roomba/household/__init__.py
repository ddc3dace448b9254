"""A robot in its household, live: its upkeep and its plans, kept on the disk."""
