"""Days of a household, headless: dirt falls, and the robot cleans by a plan."""
