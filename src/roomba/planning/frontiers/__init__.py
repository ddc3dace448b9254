"""Where the known floor ends."""
