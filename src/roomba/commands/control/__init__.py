"""``roomba control --demo``: the menu over a robot that lives in a simulated home."""
