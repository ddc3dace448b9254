"""When the robot cleans by itself: plans, quiet hours, and a scheduler without a clock."""
