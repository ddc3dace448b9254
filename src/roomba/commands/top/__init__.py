"""`./roomba top`: the robot of `run` or `play` on a whole terminal."""
