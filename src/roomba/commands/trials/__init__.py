"""One run of the robot in a home: what it is to be, and what came of it."""
