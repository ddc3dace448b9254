"""Ways over the floor."""
