"""iRobot's Create 2 and Roomba 500 to 900: the binary Open Interface over a serial line."""
