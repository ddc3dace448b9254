"""``roomba play``: a robot that lives in a simulated home, on a web page."""
