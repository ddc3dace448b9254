"""Things: what the lidar sees and the map does not show."""
