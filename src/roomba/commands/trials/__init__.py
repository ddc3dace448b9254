"""One run of the robot in a home: its specification, and its result."""
