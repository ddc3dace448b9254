"""`./roomba top`: the robot on a whole terminal, by the server of its page."""
