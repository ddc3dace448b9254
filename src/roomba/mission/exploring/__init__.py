"""Looking at what the map does not show yet."""
