"""A robot without a lidar: it bumps, turns away, and goes home by its station's beams."""
