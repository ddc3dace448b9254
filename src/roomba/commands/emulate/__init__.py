"""``./roomba emulate``: a robot that people own, made up, at the end of a line."""
