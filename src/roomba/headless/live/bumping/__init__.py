"""A robot without a lidar that lives: its time passes, and a page sees and commands it."""
